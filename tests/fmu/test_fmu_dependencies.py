"""The declared dependencies against what the runtime does: complete, and none too many."""

import xml.etree.ElementTree as ET

import numpy as np
import pytest
from fmu_driver import OK, Fmu, reals
from fmu_helpers import export
from fmu_networks import gearbox


def dependencies(unpacked, section):
    names = [v.name for v in unpacked.description.modelVariables]
    root = ET.parse(unpacked.folder / "modelDescription.xml").getroot()
    return {
        names[int(e.get("index")) - 1]: {names[int(i) - 1] for i in e.get("dependencies").split()}
        for e in root.findall(f"ModelStructure/{section}/Unknown")
    }


INPUTS = {"mesh.transmission_error": 1e-6, "mesh.force": 10.0, "actuators.shaker": 10.0}


def is_state(variable):
    return variable.causality == "local" and variable.derivative is None


def moved_state(fmu):
    """Every state at about its nominal value, none of them 0."""
    names = [v.name for v in fmu.unpacked.description.modelVariables if is_state(v)]
    nominals = [float(v.nominal) for v in fmu.unpacked.description.modelVariables if is_state(v)]
    return dict(zip(names, np.random.default_rng(5).uniform(0.5, 1.5, len(names)) * nominals))


@pytest.mark.parametrize("moved", [False, True])
def test_dependencies_on_inputs_and_states(tmp_path, moved):
    """Change one input and one state after another: outputs and derivatives change where, and only where, declared."""
    network = gearbox(mesh_moves_bearings=moved)
    path = export(network, tmp_path / "d.fmu", frequency=3000.0)  # where the input power is positive in both cases
    unpacked = Fmu.unpack(path, tmp_path / "d")
    fmu = Fmu(unpacked, kind=0)
    assert fmu.set(INPUTS) == OK
    fmu.enter("continuous")
    states = moved_state(fmu)
    assert fmu.call("fmi2SetContinuousStates", reals(states.values()), len(states)) == OK
    declared = dependencies(unpacked, "Outputs") | dependencies(unpacked, "Derivatives")
    names = list(declared)
    before = fmu.get(names)
    found = {name: set() for name in names}
    for name in [*INPUTS, "frequency", *states]:
        old = fmu.get([name])[0]
        assert fmu.set({name: 1.7 * old}) == OK
        for output, a, b in zip(names, before, fmu.get(names)):
            if a != b:
                found[output].add(name)
        assert fmu.set({name: old}) == OK
    assert found == declared
    fmu.free()


def test_dependencies_at_the_start(unpacked):
    """Likewise in initialisation mode, on inputs, states and parameters; nothing that matters may be undeclared.

    The states are set, so that the parameters matter, and so that all is computed in one form, to the last bit.
    """
    fmu = Fmu(unpacked)
    assert fmu.set(INPUTS | moved_state(fmu)) == OK
    fmu.enter("initialization")
    declared = dependencies(unpacked, "InitialUnknowns")
    names = list(declared)
    before, found = fmu.get(names), set()
    for v in unpacked.description.modelVariables:
        if v.causality not in ("input", "parameter") and not is_state(v):
            continue
        old = fmu.get([v.name])[0]
        assert fmu.set({v.name: 1.01 * old + (0.1 if v.unit == "1" else 0)}) == OK
        for output, a, b in zip(names, before, fmu.get(names)):
            assert a == b or v.name in declared[output], (output, v.name)
            found |= {(output, v.name)} if a != b else set()
        assert fmu.set({v.name: old}) == OK
        assert np.array_equal(fmu.get(names), before)
    declared_pairs = {(output, name) for output, knowns in declared.items() for name in knowns}
    assert found == declared_pairs
    fmu.free()
