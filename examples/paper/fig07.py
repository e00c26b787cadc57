"""Fig. 7: Timoshenko, Euler and Mindlin elements for the shafts.

python examples/paper/fig07.py
"""

from gearpath.study.paper import fig07
from gearpath.study.paper.gallery import show

if __name__ == "__main__":
    show(fig07.study)
