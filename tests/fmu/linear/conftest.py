"""Linear systems as FMUs."""

import sys
from pathlib import Path

import pytest

pytest.importorskip("control")

sys.path.insert(0, str(Path(__file__).parent))

from fmu_helpers import stale


@pytest.fixture(scope="session", autouse=True)
def _compiled():
    if stale():
        pytest.fail(stale(), pytrace=False)
