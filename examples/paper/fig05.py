"""Fig. 5: the synthesis against the direct solution, complete and after a Guyan reduction.

python examples/paper/fig05.py
"""

from gearpath.study.paper import fig05
from gearpath.study.paper.gallery import show

if __name__ == "__main__":
    show(fig05.study)
