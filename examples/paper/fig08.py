"""Fig. 8: bearings with full, diagonal and radial stiffness.

python examples/paper/fig08.py
"""

from gearpath.study.paper import fig08
from gearpath.study.paper.gallery import show

if __name__ == "__main__":
    show(fig08.study)
