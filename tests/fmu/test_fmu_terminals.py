"""Terminals: valid by the schema, every member a variable, and signs as they are described."""

import zipfile
from collections import Counter
from dataclasses import replace
from pathlib import Path

import fmpy
import numpy as np
import pytest
from fmpy.validation import validate_fmu
from fmu_driver import OK, Fmu
from fmu_helpers import export
from lxml import etree

import gearpath as gp
from gearpath.api import modal_network
from gearpath.fmu.conformance import check_conformance
from gearpath.fmu.native_table import native_table
from gearpath.fmu.supplements import supplements
from gearpath.fmu.terminals import terminals_and_icons

MODELS = Path(__file__).resolve().parents[2] / "models"
XSD = Path(fmpy.__file__).parent / "schema" / "fmi3" / "fmi3TerminalsAndIcons.xsd"


@pytest.fixture(scope="module")
def networks(network):
    files = {path.stem: gp.load(path) for path in sorted(MODELS.glob("*.toml"))}
    return {"hand-made": network} | {name: modal_network(model).viscous() for name, model in files.items()}


def terminals(network, fmi="2.0"):
    variables = native_table(network, 500.0, fmi)
    root = etree.fromstring(terminals_and_icons(network, variables))
    return root, {t.get("name"): t for t in root.iter("Terminal")}, {v.name: v for v in variables}


def members(terminal):
    found = terminal.findall("TerminalMemberVariable")
    return {m.get("memberName"): (m.get("variableName"), m.get("variableKind")) for m in found}


@pytest.mark.parametrize("fmi", ["2.0", "3.0"])
def test_valid_by_the_schema_and_complete(networks, fmi):
    schema = etree.XMLSchema(etree.parse(str(XSD)))
    for network in networks.values():
        root, found, variables = terminals(network, fmi)
        schema.assertValid(root)
        assert root.get("fmiVersion") == "3.0"
        assert len(found) == len(list(root.iter("Terminal")))
        listed = [m.get("variableName") for m in root.iter("TerminalMemberVariable")]
        assert max(Counter(listed).values()) == 1
        assert {variables[name].causality for name in listed} <= {"input", "output"}
        for joint in network.joints:
            parts = ("force",) if joint.grounded else ("force", "velocity")
            own = {f"{part}_{dof}" for part in parts for dof in joint.dofs}
            if all(f"{joint.name}.{member}" in variables for member in own):
                assert set(members(found[joint.name])) == own
            assert found[joint.name].get("matchingRule") == "plug"
            for member, (name, kind) in members(found[joint.name]).items():
                assert name == f"{joint.name}.{member}"
                assert kind == ("outflow" if member.startswith("force") else "signal")
        assert {load.name for load in network.loads} <= set(listed)


def test_pictures_do_not_lie_on_each_other(networks):
    for network in networks.values():
        _, found, _ = terminals(network)
        boxes = []
        for terminal in found.values():
            drawn = terminal.find("TerminalGraphicalRepresentation")
            x1, y1, x2, y2 = (float(drawn.get(name)) for name in ("x1", "y1", "x2", "y2"))
            assert x1 < x2
            assert y1 < y2
            assert not [b for b in boxes if x1 < b[2] and b[0] < x2 and y1 < b[3] and b[1] < y2]
            boxes.append((x1, y1, x2, y2))


def test_a_joint_and_a_mesh_of_one_name_stay_apart(network):
    joints = (replace(network.joints[0], name="mesh"), *network.joints[1:])
    outputs = tuple(
        replace(o, name=o.name.replace("bearing_1", "mesh"), joint="mesh" if o.joint == "bearing_1" else o.joint)
        for o in network.outputs
    )
    paths = tuple("mesh" if path == "bearing_1" else path for path in network.paths)
    _, found, _ = terminals(replace(network, joints=joints, outputs=outputs, paths=paths))
    assert set(members(found["mesh"])) == {"force_uy", "force_rx", "velocity_uy"}
    assert set(members(found["mesh_excitation"])) == {"transmission_error", "force"}


def test_inputs_have_their_sense(network):
    _, found, _ = terminals(network)
    assert members(found["mesh"]) == {
        "transmission_error": ("mesh.transmission_error", "signal"),
        "force": ("mesh.force", "inflow"),
    }
    assert members(found["actuators.shaker"]) == {"force": ("actuators.shaker", "inflow")}


@pytest.fixture(scope="module")
def gearbox_fmu(networks, tmp_path_factory):
    folder, network = tmp_path_factory.mktemp("terminals"), networks["gearbox"]
    return Fmu.unpack(export(network, folder / "gearbox.fmu"), folder / "it")


def test_outflow_times_velocity_is_the_power_into_the_receiver(networks, gearbox_fmu):
    """The sense of the members, by numbers out of the FMU itself."""
    _, found, variables = terminals(networks["gearbox"])
    fmu, step = Fmu(gearbox_fmu), 2e-5
    fmu.start()
    for k in range(100):
        assert fmu.set({"mesh.transmission_error": 1e-6 * np.sin(2 * np.pi * 700 * k * step)}) == OK
        assert fmu.step(k * step, step) == OK
    for bearing in ("bearing_1", "bearing_4"):
        port = {name: fmu.get([variable])[0] for name, (variable, _) in members(found[bearing]).items()}
        power = fmu.get([f"{bearing}.power"])[0]
        assert sum(port[f"force_{dof}"] * port[f"velocity_{dof}"] for dof in ("uy", "rx")) == pytest.approx(power)
        assert power != 0
        assert variables[f"{bearing}.power"].description.endswith("into the receiver, over time")
    fmu.free()


@pytest.mark.parametrize("fmi", ["2.0", "3.0"])
def test_fmu_with_all_supplements_is_valid(network, fmi, tmp_path):
    extra = supplements(network, native_table(network, 500.0, fmi), fmi)
    path = export(network, tmp_path / "it.fmu", fmi=fmi, extra_files=extra)
    assert validate_fmu(str(path)) == []
    assert check_conformance(path, run=False) == ()
    with zipfile.ZipFile(path) as archive:
        names = set(archive.namelist())
        root = etree.fromstring(archive.read("terminalsAndIcons/terminalsAndIcons.xml"))
    assert "terminalsAndIcons/icon.png" in names
    assert ("model.png" in names) == (fmi == "2.0")
    for drawn in root.iter("TerminalGraphicalRepresentation"):
        assert f"terminalsAndIcons/{drawn.get('iconBaseName')}.png" in names
