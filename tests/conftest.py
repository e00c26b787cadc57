import pytest
from systems import default_gearbox

from gearpath.network.assemble import assemble


def pytest_collection_modifyitems(items):
    """Fast tests first; slow ones still run."""
    items.sort(key=lambda item: item.get_closest_marker("slow") is not None)


@pytest.fixture(scope="session")
def system():
    return default_gearbox()


@pytest.fixture(scope="session")
def network(system):
    return assemble(system)


@pytest.fixture(scope="session")
def modal(network):
    return network.modal()
