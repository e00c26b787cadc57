import os

import pytest
from ccx_fetch import ADVICE, REQUIRED, find


@pytest.fixture(scope="session")
def calculix():
    """CalculiX; without it tests skip, and fail where it is required."""
    found = find()
    if found is None:
        (pytest.fail if os.environ.get(REQUIRED) else pytest.skip)(ADVICE)
    return found
