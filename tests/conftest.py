import os

# many small solves are several times slower with BLAS threads, more so with two test processes on two cores
for _name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_name, "1")

import pytest  # noqa: E402
from systems import default_gearbox  # noqa: E402

from gearpath.network.assemble import assemble  # noqa: E402


def pytest_collection_modifyitems(items):
    """Fast tests first, then slow ones, of these the longest first: at the end no process waits for another."""

    def order(item):
        slow = item.get_closest_marker("slow") is not None
        return slow, not (slow and "test_sanitized.py" in item.nodeid)

    items.sort(key=order)


@pytest.fixture(scope="session")
def system():
    return default_gearbox()


@pytest.fixture(scope="session")
def network(system):
    return assemble(system)


@pytest.fixture(scope="session")
def modal(network):
    return network.modal()
