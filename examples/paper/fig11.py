"""Fig. 11: the centre of gravity shifted along the shafts.

python examples/paper/fig11.py
"""

from gearpath.study.paper import fig11
from gearpath.study.paper.gallery import show

if __name__ == "__main__":
    show(fig11.study)
