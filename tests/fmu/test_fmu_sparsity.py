"""ModelStructure of both versions against which derivatives are zero: complete, and nothing too much."""

import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pytest
from fmu_driver import OK, Fmu
from fmu_helpers import ROOT, export, stale
from fmu_networks import gearbox
from fmu_piecewise import in_entries
from fmu_tangent import Tangent
from systems import random_gearbox

import gearpath as gp
from gearpath.api import modal_network
from gearpath.network.assemble import assemble
from gearpath.network.records import MeshSource, Tone


def declared(unpacked) -> dict[str, dict[str, set[str]]]:
    """ModelStructure of either version: kind of unknown -> unknown -> the names of what it depends on."""
    root = ET.parse(unpacked.folder / "modelDescription.xml").getroot()
    found: dict[str, dict[str, set[str]]] = {"over time": {}, "initial": {}}
    if unpacked.description.fmiVersion == "2.0":
        names = {str(i + 1): v.name for i, v in enumerate(unpacked.description.modelVariables)}
        entries = [
            (section.tag, unknown.get("index"), unknown)
            for section in root.find("ModelStructure")
            for unknown in section
        ]
    else:
        names = {str(v.valueReference): v.name for v in unpacked.description.modelVariables}
        entries = [(e.tag, e.get("valueReference"), e) for e in root.find("ModelStructure")]
    for tag, unknown, element in entries:
        when = "initial" if tag.startswith("Initial") else "over time"
        found[when][names[unknown]] = {names[i] for i in element.get("dependencies").split()}
    return found


def nonzero_pairs(it, unknowns, knowns) -> set[tuple[str, str]]:
    """Which of some variables change along which others, each element of them by itself."""
    pairs, ends = set(), np.cumsum([it.size([n]) for n in unknowns])
    for known in knowns:
        moved = np.zeros(ends[-1], dtype=bool)
        for direction in np.eye(it.size([known])):
            moved |= it.along(unknowns, [known], direction) != 0
        pairs |= {(n, known) for n, part in zip(unknowns, np.split(moved, ends[:-1])) if part.any()}
    return pairs


def pairs_of(dependencies) -> set[tuple[str, str]]:
    return {(unknown, known) for unknown, knowns in dependencies.items() for known in knowns}


def random_network(seed):
    return assemble(random_gearbox(seed, seed % 4 + 1)).modal()


def with_tones():
    tones = (Tone("mesh.one", 1.0, 0.0, 1e-6, 0.3), Tone("mesh.two", 2.0, -0.7, 2e-7, -1.0))
    return replace(gearbox(3), source=MeshSource("mesh.transmission_error", 2000.0, 31, tones))


CASES = {
    "moving": lambda: gearbox(4, mesh_moves_bearings=True),
    "still": lambda: gearbox(7, excitation="actuators.shaker"),
    "gearbox": lambda: modal_network(gp.load(ROOT / "models" / "gearbox.toml")),
    "source": with_tones,
    "random 1": lambda: random_network(1),
    "random 16": lambda: random_network(16),
    "random 23": lambda: random_network(23),
}


def full_joints(network, version, seed=1):
    """Matrices of full rank without a zero for every joint: what depends on what is no matter of their values."""
    rng, values = np.random.default_rng(seed), {}
    for joint in network.joints:
        scale = np.array([1.0 if dof[0] == "u" else 0.03 for dof in joint.dofs])
        for what, size in (("stiffness", 5e7), ("damping", 100.0)):
            F = scale[:, None] * rng.normal(size=(len(scale), len(scale) + 2))
            values[f"{joint.name}.{what}"] = size * F @ F.T
    return in_entries(values, version)


@pytest.mark.parametrize("version", [2, 3])
@pytest.mark.parametrize("case", CASES)
def test_declared_dependencies_are_the_true_ones(case, version, tmp_path):
    """Every derivative that is not zero is declared, and nothing else but of frequency outputs.

    Those are declared to depend on all that can change them, whatever the paths to them.
    """
    assert not stale(), stale()
    network = CASES[case]()
    path = export(network, tmp_path / "it.fmu", fmi=f"{version}.0", frequency=3000.0)
    it = Tangent(Fmu.unpack(path, tmp_path / "it"), exchange=True)
    structure = declared(it.fmu.unpacked)
    assert list(structure["over time"]) == [*it.outputs, *it.derivatives]
    it.moved()
    assert it.fmu.set(full_joints(network, version)) == OK
    assert it.fmu.set(dict.fromkeys([n for n in it.parameters if n.endswith("modal_damping")], 0.02)) == OK
    it.fmu.enter("initialization")
    knowns = [*it.inputs, "frequency", *it.states, *it.parameters]
    compare(it, structure["initial"], nonzero_pairs(it, list(structure["initial"]), knowns))
    assert it.fmu.call(f"fmi{version}ExitInitializationMode") == OK
    knowns = [*it.inputs, "frequency", *it.states]
    compare(it, structure["over time"], nonzero_pairs(it, list(structure["over time"]), knowns))
    it.fmu.free()


def compare(it, structure, found):
    said = pairs_of(structure)
    assert found <= said, sorted(found - said)
    idle = {pair for pair in said - found if pair[0] not in it.over_frequency}
    assert not idle, sorted(idle)
    for name in it.over_frequency:
        assert any(pair[0] == name for pair in found)
