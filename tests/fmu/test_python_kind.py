"""The python FMU as a file and as an FMI slave: what it holds, what it refuses, what it keeps."""

import subprocess
import sys
import xml.etree.ElementTree as ET
import zipfile
from ctypes import byref, create_string_buffer
from pathlib import Path

import pytest

pytest.importorskip("fmpy")
pytest.importorskip("pythonfmu")

from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import fmi2FMUstate
from fmpy.validation import validate_fmu
from python_gearbox import STIFFNESS, Host, export, gearbox

from gearpath.errors import GearpathError, InputError
from gearpath.fmu import python_bundle
from gearpath.fmu.variables import variable_table
from gearpath.network.assemble import assemble

K11, K22 = "bearing_1.stiffness[1,1]", "bearing_1.stiffness[2,2]"
ALPHA = ("alpha", "alpha_force", "alpha_moment", "bearing_1.alpha")


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    return export(gearbox(), tmp_path_factory.mktemp("python") / "gearbox.fmu")


@pytest.fixture
def host(path):
    found = Host(path)
    yield found
    found.free()


@pytest.fixture
def root(path):
    with zipfile.ZipFile(path) as archive:
        return ET.fromstring(archive.read("modelDescription.xml"))


def test_passes_the_validator(path):
    assert validate_fmu(str(path)) == []


def test_same_model_same_bytes_and_nothing_left_behind(path, tmp_path):
    before, modules = list(sys.path), set(sys.modules)
    again = export(gearbox(), tmp_path / "again.fmu")
    assert again.read_bytes() == path.read_bytes()
    assert sys.path == before
    assert not [name for name in set(sys.modules) - modules if "stub" in name or "gearpath_" in name]


def test_other_model_has_other_names(path, tmp_path):
    other = export(gearbox(mass=13.0), tmp_path / "other.fmu")
    modules = []
    for file in (path, other):
        with zipfile.ZipFile(file) as archive:
            modules.append(archive.read("resources/slavemodule.txt").decode())
            assert b"class Gearpath" + modules[-1].split("_")[1].encode() in archive.read(f"resources/{modules[-1]}.py")
    assert modules[0] != modules[1]


def test_all_imports_inside_are_relative_or_of_numpy_scipy_and_the_standard_library(path):
    with zipfile.ZipFile(path) as archive:
        for name in archive.namelist():
            if name.endswith(".py") and name.count("/") > 1:
                assert "import gearpath" not in archive.read(name).decode()
                assert "from gearpath" not in archive.read(name).decode()


def test_has_the_variables_of_the_native_kind_first(root):
    table = variable_table(assemble(gearbox()).modal(), 500.0)
    found = root.find("ModelVariables")
    assert [element.get("name") for element in found][: len(table)] == [v.name for v in table]
    for element, variable in zip(found, table):
        assert element[0].get("unit") == variable.unit
        assert element[0].get("start") == (None if variable.start is None else repr(variable.start))
    designs = {element.get("name"): element for element in list(found)[len(table) :]}
    assert {e.get("variability") for e in designs.values()} == {"fixed"}
    assert {e.get("causality") for e in designs.values()} == {"parameter"}
    expected = {
        "casing.mass": "12.0",
        "casing.inertia_xx": "0.15",
        "casing.centre_of_gravity[1]": "0.0",
        "gear_train.input.length": "0.25",
        "gear_train.output.diameter": "0.03",
        "mesh.position": "0.0",
        "mount_4.position[3]": "0.12",
    }
    assert expected.items() <= {name: e[0].get("start") for name, e in designs.items()}.items()
    assert all(e[0].get("displayUnit") is None for e in designs.values())


def test_structure_is_complete_and_in_order(root):
    assert root.get("fmiVersion") == "2.0"
    assert root.get("generationDateAndTime") is None
    variables = list(root.find("ModelVariables"))
    outputs = [k for k, v in enumerate(variables, 1) if v.get("causality") == "output"]
    designs = {k for k, v in enumerate(variables, 1) if v.get("variability") == "fixed"}
    for section in ("Outputs", "InitialUnknowns"):
        unknowns = list(root.find(f"ModelStructure/{section}"))
        assert [int(u.get("index")) for u in unknowns] == outputs
    alpha = next(k for k, v in enumerate(variables, 1) if v.get("name") == "alpha")
    unknown = next(u for u in unknowns if u.get("index") == str(alpha))
    assert designs < set(map(int, unknown.get("dependencies").split()))


def test_start_values_are_those_of_a_fresh_instance(root, host):
    variables = [v for v in root.find("ModelVariables") if v[0].get("start") is not None]
    values = host.get(*(v.get("name") for v in variables))
    assert values == [float(v[0].get("start")) for v in variables]


def test_values_that_can_never_be_are_refused_and_the_old_ones_stay(host):
    host.start()
    before = host.get(K11, K22, *ALPHA)
    refused = {
        K11: (-1.0, "negative"),
        K22: (float("nan"), "finite"),
        "frequency": (float("inf"), "finite"),
        "gear_train.modal_damping": (1.0, "damping ratio"),
        "alpha": (1.0, "output"),
        "casing.mass": (13.0, "fixed"),
    }
    for name, (value, word) in refused.items():
        with pytest.raises(FMICallException):
            host.set({"mesh.force": 7.0, name: value})
        assert word in host.log[-1][1]
        assert name in host.log[-1][1]
        assert host.get("mesh.force") == [0.0]  # all or nothing
    assert host.get(K11, K22, *ALPHA) == before
    with pytest.raises(FMICallException):
        host.slave.getReal([100_000])
    with pytest.raises(FMICallException):
        host.slave.setInteger([0], [1])


def test_frequencies_at_and_below_zero(host):
    """As in the native kind: no response at 0, by its magnitude below."""
    found = []
    for frequency in (700.0, 0.0, -700.0):
        host.set({"frequency": frequency})
        found.append(host.get(*ALPHA))
    assert found == [found[0], [0.0] * len(ALPHA), found[0]]
    assert all(found[0])


def test_matrix_may_be_indefinite_while_its_entries_are_set(host):
    host.start()
    host.set({K11: 1.0})
    host.set({"bearing_1.stiffness[1,2]": 0.0})
    assert all(value != 0.0 for value in host.get(*ALPHA))


def test_indefinite_matrix_is_taken_back_when_it_is_used(host):
    host.start()
    before = host.get(*ALPHA)
    host.set({K11: 1.0})
    with pytest.raises(FMICallException):
        host.get(*ALPHA)
    assert "bearing_1" in host.log[-1][1]
    assert host.get(K11, *ALPHA) == [STIFFNESS[0][0], *before]
    host.set({K11: 1.0, "mount_1.damping": 500.0})
    with pytest.raises(FMICallException):
        host.slave.doStep(0.0, 1e-5)
    assert "semidefinite" in host.log[-1][1]
    assert host.get(K11, "mount_1.damping") == [STIFFNESS[0][0], 500.0]
    host.slave.doStep(0.0, 1e-5)


@pytest.mark.parametrize(
    ("values", "word"),
    [
        ({"mesh.position": 0.2}, "off the shaft"),
        ({"casing.inertia_xx": 1.0}, "principal moments"),
    ],
)
def test_design_that_cannot_be_built_is_taken_back(host, values, word):
    host.slave.setupExperiment(startTime=0.0)
    before = host.get(*values, *ALPHA)
    host.set(values)
    host.slave.enterInitializationMode()
    with pytest.raises(FMICallException):
        host.slave.exitInitializationMode()
    assert word in host.log[-1][1]
    host.slave.exitInitializationMode()
    assert host.get(*values, *ALPHA) == before


def test_design_parameters_refuse_what_no_design_has(host):
    for name, value in (("casing.mass", 0.0), ("gear_train.input.length", float("inf"))):
        with pytest.raises(FMICallException):
            host.set({name: value})
        assert name in host.log[-1][1]


def test_steps_that_cannot_be_are_refused(host):
    with pytest.raises(FMICallException):
        host.slave.doStep(0.0, 1e-5)
    host.start()
    for time, step in ((1.0, 1e-5), (0.0, 0.0), (0.0, -1e-5), (0.0, float("nan")), (float("nan"), 1e-5)):
        with pytest.raises(FMICallException):
            host.slave.doStep(time, step)
        assert "step" in host.log[-1][1].lower()
    host.slave.doStep(0.0, 1e-5)


def test_reset_repeats_itself(host):
    names = ("bearing_1.force_uy", "casing.velocity_uy", "bearing_2.power", "alpha")

    def run():
        found = []
        host.set({"mesh.force": 100.0, "mount_1.stiffness": 2e7})
        for k in range(20):
            host.slave.doStep(k * 1e-5, 1e-5)
            found.append(host.get(*names))
        return found

    host.start(**{"casing.mass": 15.0})
    first = run()
    host.slave.reset()
    assert host.get("casing.mass", "mesh.force", "casing.velocity_uy") == [12.0, 0.0, 0.0]
    host.start(**{"casing.mass": 15.0})
    assert run() == first


def test_state_is_saved_and_restored_to_the_last_bit(host):
    names = ("bearing_1.force_uy", "casing.velocity_uy", "bearing_2.power", "alpha", K11)

    def run():
        return [(host.slave.doStep((k + 5) * 1e-5, 1e-5), host.get(*names)) for k in range(10)]

    host.start(**{"casing.mass": 15.0})
    host.set({"mesh.force": 100.0, K11: 2e8, "frequency": 700.0})
    for k in range(5):
        host.slave.doStep(k * 1e-5, 1e-5)
    state = host.slave.getFMUstate()
    content = host.slave.serializeFMUstate(state)
    first = run()
    host.set({K11: 3e8, "mesh.force": 0.0, "frequency": 800.0})
    host.slave.setFMUstate(state)
    assert run() == first
    host.slave.freeFMUstate(state)
    host.slave.reset()
    host.slave.setFMUstate(deserialised(host, content))
    assert host.get("casing.mass") == [15.0]
    assert run() == first
    with pytest.raises(FMICallException):
        host.slave.setFMUstate(deserialised(host, content[:-1]))
    with pytest.raises(FMICallException):
        host.slave.setFMUstate(deserialised(host, content.replace(b"7", b"8", 1)))
    assert "altered" in host.log[-1][1]


def deserialised(host, content):
    state = fmi2FMUstate()
    buffer = create_string_buffer(content, len(content))
    host.slave.fmi2DeSerializeFMUstate(host.slave.component, buffer, len(content), byref(state))
    return state


def test_state_of_another_model_is_refused(host, tmp_path):
    host.start()
    other = Host(export(gearbox(mass=13.0), tmp_path / "other.fmu")).start()
    state = other.slave.getFMUstate()
    content = other.slave.serializeFMUstate(state)
    other.slave.freeFMUstate(state)
    other.free()
    with pytest.raises(FMICallException):
        host.slave.setFMUstate(deserialised(host, content))
    assert "another model" in host.log[-1][1]


@pytest.mark.slow
def test_many_instances_and_many_failures_leave_the_process_alive(path):
    """pythonfmu drops references that it does not own; without remedy this ends the process."""
    script = f"""
import gc, sys
sys.path.insert(0, {str(Path(__file__).parent)!r})
from python_gearbox import Host
folder = None
for _ in range(25):
    host = Host({str(path)!r}, folder).start()
    folder = host.folder
    for _ in range(3):
        try:
            host.set({{"alpha": 1.0}})
        except Exception:
            pass
    host.slave.reset()
    host.free()
    gc.collect()
print("alive", [p for p in sys.path if p.endswith("resources")])
"""
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert done.stdout.strip() == "alive []", done.stderr


FRESH = """
import sys
class Absent:
    def find_spec(self, name, *_):
        if name.split(".")[0] in {absent!r}:
            raise ImportError(f"No module named {{name!r}}")
sys.meta_path.insert(0, Absent())
import fmpy, json
values = fmpy.simulate_fmu({path!r}, stop_time=1e-3, output_interval=1e-4, debug_logging=True,
                           start_values={{"mesh.force": 100.0}}, output=["casing.velocity_uy", "alpha"])
print(json.dumps([float(x) for x in values[-1]]))
"""


def run_fresh(path, folder, absent):
    script = FRESH.format(path=str(path), absent=absent)
    environment = {"PATH": "/usr/bin:/bin", "HOME": str(folder)}
    return subprocess.run(
        [sys.executable, "-c", script],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )


def test_runs_without_gearpath_and_pythonfmu(path, tmp_path):
    done = run_fresh(path, tmp_path, ("gearpath", "pythonfmu", "pydantic", "xarray", "control"))
    assert done.returncode == 0, done.stderr
    time, velocity, alpha = (float(x) for x in done.stdout.strip().splitlines()[-1][1:-1].split(","))
    assert time == pytest.approx(1e-3)
    assert velocity != 0.0
    assert 0.0 < alpha < 1.0


def test_host_without_scipy_is_told_what_to_install(path, tmp_path):
    done = run_fresh(path, tmp_path, ("scipy",))
    assert done.returncode != 0
    assert "python -m pip install numpy scipy" in done.stdout  # the log, as fmpy prints it
    assert "python -m pip install numpy scipy" in done.stderr  # and where logging is off


def test_folder_with_spaces(path, tmp_path):
    folder = tmp_path / "with a space"
    with zipfile.ZipFile(path) as archive:
        archive.extractall(folder)
    host = Host(path, folder).start()
    assert host.get("casing.mass") == [12.0]
    host.free()


def test_documentation_says_what_is_needed(path, tmp_path):
    with zipfile.ZipFile(path) as archive:
        page = archive.read("documentation/index.html").decode()
        assert archive.read("documentation/licenses/pythonfmu.txt")
        assert b"scipy" in archive.read("resources/requirements.txt")
    for word in ("numpy", "scipy", "LD_PRELOAD", "linux64", "win64", "casing.mass"):
        assert word in page
    extra = {"documentation/index.html": b"<html></html>"}
    with zipfile.ZipFile(export(gearbox(), tmp_path / "x.fmu", extra_files=extra)) as archive:
        assert archive.read("documentation/index.html") == extra["documentation/index.html"]
        assert b"numpy" in archive.read("documentation/python.html")


def test_arguments_that_cannot_be_are_refused(tmp_path):
    for changes in ({"model_identifier": "1x"}, {"stop_time": 0.0}, {"extra_files": {"../x": b""}}):
        with pytest.raises(InputError):
            export(gearbox(), tmp_path / "x.fmu", **changes)
    assert not list(tmp_path.iterdir())


def test_model_that_is_no_plain_source_is_refused(tmp_path):
    with pytest.raises(InputError, match="Python source"):
        export(gearbox(mass=Pounds(12.0)), tmp_path / "x.fmu")


class Pounds(float):
    """A number whose repr is no Python."""

    def __repr__(self):
        return "12 lb"


def test_incomplete_installation_is_named(tmp_path, monkeypatch):
    monkeypatch.setattr(python_bundle, "_FOLDERS", (tmp_path / "nowhere",))
    with pytest.raises(GearpathError, match="not installed completely"):
        export(gearbox(), tmp_path / "x.fmu")


def test_templates_are_found_in_a_wheel(path, tmp_path, monkeypatch):
    checkout = python_bundle._FOLDERS[0]
    for name in ("entry.py", "slave.py"):
        (tmp_path / name).write_bytes((checkout / name).read_bytes())
    monkeypatch.setattr(python_bundle, "_FOLDERS", (tmp_path / "nowhere", tmp_path))
    assert export(gearbox(), tmp_path / "x.fmu").read_bytes() == path.read_bytes()
