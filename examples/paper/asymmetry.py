"""Fig. 11 to 15 together: the same shift across and along the shafts.

python examples/paper/asymmetry.py
"""

from gearpath.study.paper import asymmetry
from gearpath.study.paper.gallery import show

if __name__ == "__main__":
    show(asymmetry.study)
