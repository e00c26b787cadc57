"""FMUs of a nonlinear model written for these tests, in both versions, with and without directional derivatives."""

import sys
from pathlib import Path

import pytest

pytest.importorskip("control")
sys.path.insert(0, str(Path(__file__).parent))

from pendulum import build


@pytest.fixture(scope="session")
def pendulums(tmp_path_factory):
    """By version and kind of derivatives, built when they are first asked for."""
    folder, built = tmp_path_factory.mktemp("pendulums"), {}

    def path(fmi=2, derivatives=0):
        key = (fmi, derivatives)
        if key not in built:
            built[key] = build(folder / f"pendulum_{fmi}_{derivatives}.fmu", fmi, derivatives)
        return built[key]

    return path
