"""The clients' packages: tests skip where one is missing, and fail where that is not allowed."""

import importlib.util
import os

import pytest

REQUIRED = "GEARPATH_REQUIRE_CLIENTS"  # set in CI: a client that is missing is a failure there


def client(module):
    """The client's module, if it is installed; for clients that run in a process of their own see `installed`."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        missing(module, error)


def installed(module):
    """Make sure of a package without importing it."""
    if importlib.util.find_spec(module) is None:
        missing(module, "it is not installed")


def missing(module, reason):
    command = 'python -m pip install -e ".[clients]"'
    advice = f"no {module} here ({reason}); run: {command} (libcosimpy and ecospy: Linux on x86-64 only)"
    if os.environ.get(REQUIRED):
        pytest.fail(advice, pytrace=False)
    pytest.skip(advice, allow_module_level=True)
