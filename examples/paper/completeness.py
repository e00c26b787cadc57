"""Sec. 4: static completeness of the source's basis.

python examples/paper/completeness.py
"""

from gearpath.study.paper import completeness
from gearpath.study.paper.gallery import show

if __name__ == "__main__":
    show(completeness.study)
