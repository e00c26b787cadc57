"""Fig. 9: damping and stiffness of the bearings.

python examples/paper/fig09.py
"""

from gearpath.study.paper import fig09
from gearpath.study.paper.gallery import show

if __name__ == "__main__":
    show(fig09.study)
