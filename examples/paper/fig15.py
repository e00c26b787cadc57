"""Fig. 15: the mounts shifted across the shafts.

python examples/paper/fig15.py
"""

from gearpath.study.paper import fig15
from gearpath.study.paper.gallery import show

if __name__ == "__main__":
    show(fig15.study)
