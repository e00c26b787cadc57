"""Fig. 12: the centre of gravity shifted across the shafts.

python examples/paper/fig12.py
"""

from gearpath.study.paper import fig12
from gearpath.study.paper.gallery import show

if __name__ == "__main__":
    show(fig12.study)
