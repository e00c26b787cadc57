"""The host and the runtime, compiled with the address and the undefined-behaviour sanitizer: no finding, no leak."""

import pytest
from platform_fetch import COMPILER, HEADERS
from platform_machines import gcc, need
from platform_scenarios import every_scenario
from platform_script import Script
from test_sources import listed

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("platform_sources")]
SANITIZE = ("-g", "-O1", "-fsanitize=address,undefined", "-fno-sanitize-recover=all")


@pytest.fixture(scope="module")
def host(tmp_path_factory):
    need(COMPILER, HEADERS)
    return gcc(None, tmp_path_factory.mktemp("sanitized") / "host", SANITIZE)


def test_sanitizers_find_nothing(fmu, linux, host, run, tmp_path):
    """In every scenario, and the numbers stay the same."""
    library = gcc(listed(fmu), tmp_path / "gearbox.so", SANITIZE)
    for name, scenario in every_scenario().items():
        sanitized, plain = Script(fmu, linux, library), Script(fmu, linux)
        scenario(sanitized)
        scenario(plain)
        assert linux.run(host, sanitized.text) == run(plain), name
