"""The algebraic frequency outputs against a direct solve of the coupled system, without synthesis."""

import fmu_oracle as oracle
import numpy as np
import pytest
from fmu_driver import ERROR, OK, Fmu
from fmu_helpers import export
from fmu_networks import gearbox

HERTZ = [20.0, 80.0, 500.0, 1500.0, 2345.6, 5000.0, 20000.0]


def compare(fmu, network, hertz):
    """Every frequency output to 1e-9 of its own modulus (of the joint's total for the parts of alpha)."""
    wanted = oracle.frequency_response(network, hertz)
    assert fmu.set({"frequency": hertz}) == OK
    found = dict(zip(wanted, fmu.get(list(wanted))))
    for name, value in wanted.items():
        if name.startswith("frf."):
            stem = name[: name.rindex(".")]
            scale = np.hypot(wanted[f"{stem}.re"], wanted[f"{stem}.im"])
        else:
            scale = max(abs(wanted[n]) for n in wanted if n.endswith(".alpha") or n.startswith("alpha"))
        assert abs(found[name] - value) <= 1e-9 * scale, (name, hertz, found[name], value)
    return wanted


@pytest.mark.parametrize("hertz", HERTZ)
def test_transmission_error(fmu, network, hertz):
    wanted = compare(fmu, network, hertz)
    assert 0 < wanted["alpha"] < 1  # the case is not trivial


@pytest.mark.parametrize(
    "changes",
    [{"excitation": "mesh.force"}, {"excitation": "actuators.shaker"}, {"mesh_moves_bearings": True}],
)
def test_other_excitations(tmp_path, changes):
    network = gearbox(**changes)
    fmu = Fmu(Fmu.unpack(export(network, tmp_path / "other.fmu"), tmp_path / "other"))
    fmu.start()
    for hertz in HERTZ:
        compare(fmu, network, hertz)
    fmu.free()


def test_parts_of_alpha_add_up(fmu):
    total, force, moment, *joints = fmu.get(
        ["alpha", "alpha_force", "alpha_moment", *(f"bearing_{i}.alpha" for i in range(1, 5))]
    )
    assert total == pytest.approx(force + moment, rel=1e-12)
    assert total == pytest.approx(sum(joints), rel=1e-12)


def test_parameters_act_at_once(fmu, network):
    """Read, change, read: nothing stale is kept."""
    fmu.get(["alpha"])
    K, C = 0.5 * network.joints[1].stiffness, 3.0 * network.joints[1].damping
    changed = network.with_joint("bearing_2", K, C)
    values = {
        f"bearing_2.{what}[{i + 1},{k + 1}]": M[i, k]
        for what, M in (("stiffness", K), ("damping", C))
        for i in range(2)
        for k in range(i, 2)
    }
    assert fmu.set(values) == OK
    compare(fmu, changed, 700.0)
    assert fmu.set({"gear_train.modal_damping": 0.04}) == OK
    object.__setattr__(changed, "modal_damping", {"gear_train": 0.04})
    compare(fmu, changed, 700.0)


def test_time_twin_agrees(network):
    """The time equations' transfer function is the frequency equations' response."""
    A, B, C, D, names = oracle.time_system(network)
    for hertz in [f for f in HERTZ if f >= 500]:  # below, the plain solve is too badly conditioned
        s = 2j * np.pi * hertz
        H = C @ np.linalg.solve(s * np.eye(len(A)) - A, B[:, 0]) + D[:, 0]
        wanted = oracle.frequency_response(network, hertz)
        for name, value in zip(names, H):
            expected = complex(wanted[f"frf.{name}.re"], wanted[f"frf.{name}.im"])
            assert abs(value - expected) <= 1e-7 * abs(expected), (name, hertz)


def test_undamped_resonance_is_an_error_not_nan(tmp_path):
    network = gearbox()
    object.__setattr__(network, "modal_damping", {"gear_train": 0.0})
    resonance = float(np.sqrt(network.eigenvalues[4]) / (2 * np.pi))
    fmu = Fmu(Fmu.unpack(export(network, tmp_path / "u.fmu"), tmp_path / "u"))
    fmu.start()
    for hertz in [resonance, *(np.nextafter(resonance, d * np.inf) for d in (-1, 1))]:
        fmu.set({"frequency": hertz})
        values, status = fmu.try_get(["alpha", "frf.bearing_1.force_uy.re"])
        assert (status == OK and np.isfinite(values).all()) or (status == ERROR and "singular" in fmu.messages[-1])
    fmu.free()
