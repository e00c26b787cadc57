"""Fig. 6: the experimental set-up, its input mobility and the paths of its upper joint.

python examples/paper/fig06.py
"""

from gearpath.study.paper import fig06
from gearpath.study.paper.gallery import show

if __name__ == "__main__":
    show(fig06.study)
