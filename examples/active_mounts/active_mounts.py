"""Active mounts: predicted with python-control, co-simulated with FMUs of machine and controller, compared.

    python examples/active_mounts/active_mounts.py [--folder build/active_mounts]

Prints the tables of README.md, draws active_mounts.svg into the folder, and leaves the FMUs there.
"""

import argparse
from collections.abc import Sequence
from pathlib import Path

from comparison import MASTERS, Comparison, compared
from picture import draw
from wording import text


def main(arguments: Sequence[str] | None = None) -> Comparison:
    """Compute, print and draw."""
    parser = argparse.ArgumentParser(description="Closed loops around the gearbox: predicted and co-simulated.")
    parser.add_argument("--folder", type=Path, default=Path("build") / "active_mounts", help="for picture and FMUs")
    folder = parser.parse_args(arguments).folder
    found = compared(folder)
    print(text(found))
    if "libcosim" not in MASTERS:
        print("\nlibcosimpy is not installed: the second master is left out (python -m pip install libcosimpy)")
    draw(folder / "active_mounts.svg", found)
    return found


if __name__ == "__main__":
    main()
