"""Fig. 13: the gear mesh shifted along the shafts.

python examples/paper/fig13.py
"""

from gearpath.study.paper import fig13
from gearpath.study.paper.gallery import show

if __name__ == "__main__":
    show(fig13.study)
