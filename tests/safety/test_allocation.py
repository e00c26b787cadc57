"""No allocation after initialisation, and nothing left behind: a C host in which every allocation is counted."""

import re
import subprocess

import pytest
import safety_build

WRAPPED = ("malloc", "calloc", "realloc", "free")
# What the runtime may use of the C library. Files are read and memory is got at instantiation only.
ALLOWED = {
    *WRAPPED,
    *("fopen", "fread", "fclose"),
    *("memcmp", "memcpy", "memmove", "memset", "strcat", "strcmp", "strcpy", "strlen"),
    "_GLOBAL_OFFSET_TABLE_",
}


pytestmark = pytest.mark.xdist_group("allocation")


@pytest.fixture(scope="module")
def runtime(gcc, tmp_path_factory):
    """The runtime's objects, compiled as an importer would."""
    return safety_build.objects(gcc, tmp_path_factory.mktemp("runtime"), ["-O2", "-fPIC", "-std=c99"])


@pytest.fixture(scope="module")
def hosts(gcc, runtime, tmp_path_factory):
    """By FMI version: the host, linked with the runtime."""
    folder, found = tmp_path_factory.mktemp("hosts"), {}
    for fmi in ("2.0", "3.0"):
        found[fmi] = folder / f"counting_fmi{fmi[0]}"
        source = safety_build.HERE / "host" / f"{found[fmi].name}.c"
        flags = ["-std=gnu11", "-O2", "-Wall", "-Wextra", "-Werror", *safety_build.include()]
        wraps = [f"-Wl,--wrap={name}" for name in WRAPPED]
        safety_build.compiled([gcc, *flags, source, *runtime, *wraps, "-lm", "-o", found[fmi]])
    return found


def test_no_allocation_after_initialisation(hosts, small_fmus):
    """Steps, sets, gets, parameter changes, derivatives, restored states and model exchange: not one; all is freed.

    Getting a state into a new handle, and deserialising into one, may allocate: FMI wants the handle to own its memory.
    """
    driven = [fmu for fmu in small_fmus if any(v.causality == "input" for v in fmu.variables)]  # the hosts set one
    assert len(driven) == len(small_fmus) - 2
    for fmu in driven:
        done = subprocess.run([hosts[fmu.fmi], *fmu.host_arguments()], capture_output=True, text=True, check=False)
        assert done.returncode == 0, f"{fmu.name} {fmu.fmi}: {done.stdout}"
        calls, allocations, frees, faults = map(int, re.findall(r"\d+", done.stdout))
        assert calls > 400
        assert allocations == frees > 400  # 104 instances of several blocks each
        assert faults == 0


def test_host_notices_an_allocation(gcc, runtime, small_fmus, tmp_path):
    """The same host with a step that allocates: it must say so."""
    spoilt = tmp_path / "spoilt.c"
    original = (safety_build.ROOT / "fmu_src" / "gp_instance.c").read_text()
    begin = "int gp_step(GpInstance *p, double time, double h) {\n"
    assert begin in original
    spoilt.write_text(original.replace(begin, begin + "    free(malloc(8 + p->model.modes));\n"))
    flags = ["-std=gnu11", "-O0", *safety_build.include(), *(f"-Wl,--wrap={name}" for name in WRAPPED)]
    rest = [part for part in runtime if part.stem != "gp_instance"]
    host = safety_build.HERE / "host" / "counting_fmi2.c"
    safety_build.compiled([gcc, *flags, host, spoilt, *rest, "-lm", "-o", tmp_path / "host"])
    command = [tmp_path / "host", *small_fmus[0].host_arguments()]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert "malloc in fmi2DoStep" in done.stdout


def test_imports(runtime):
    """The runtime uses a closed list of functions: nothing that allocates, prints or ends the process on its own."""
    done = subprocess.run(["nm", *map(str, runtime)], capture_output=True, text=True, check=True)
    symbols = re.findall(r"^\s*[0-9a-f]* ([A-Za-z]) (\S+)$", done.stdout, re.MULTILINE)
    own = {name for kind, name in symbols if kind in "TRDBd"}
    used = {name for kind, name in symbols if kind == "U"} - own
    assert {"malloc", "fopen"} <= used  # the list was read at all
    assert used <= ALLOWED


def test_no_globals(runtime):
    """No data that can change: instances share nothing, so that threads and forks are harmless."""
    done = subprocess.run(["nm", *map(str, runtime)], capture_output=True, text=True, check=True)
    changeable = re.findall(r"^[0-9a-f]+ [BbCDdG] (\S+)$", done.stdout, re.MULTILINE)
    # tables of function pointers are constant, and only written while the library is relocated
    assert [name for name in changeable if not name.startswith("kernels_")] == []
