"""Fig. 14: the mounts shifted along the shafts.

python examples/paper/fig14.py
"""

from gearpath.study.paper import fig14
from gearpath.study.paper.gallery import show

if __name__ == "__main__":
    show(fig14.study)
