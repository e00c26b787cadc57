import pytest

from gearpath.components import modes


@pytest.fixture(scope="session")
def source(network):
    """The gear train of the default gearbox, 69 coordinates."""
    return network.structures["gear_train"]


@pytest.fixture(scope="session")
def complete(source):
    return modes(source)
