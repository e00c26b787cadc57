"""Sec. 7: the design criteria as computed tables.

python examples/paper/design.py
"""

from gearpath.study.paper import design
from gearpath.study.paper.gallery import show

if __name__ == "__main__":
    show(design.study)
