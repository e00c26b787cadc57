"""What cannot be mobilities on both sides of joints is refused with a sentence."""

from pathlib import Path

import numpy as np
import pytest
from machines import assembled

import gearpath as gp
from gearpath.errors import InputError
from gearpath.identification import identify

MODELS = Path(__file__).resolve().parents[2] / "models"
LINES = np.linspace(30.0, 900.0, 12)
JOINTS = {"one": ("ux", "uy"), "two": ("ux",)}


@pytest.fixture(scope="module")
def mobility():
    return assembled(np.random.default_rng(1), (2, 1), LINES)[0]


def refused(match, *arguments, **options):
    with pytest.raises(InputError, match=match):
        identify(*arguments, **options)


def test_shapes_and_numbers(mobility):
    refused("shape .12, 5, 6. does not fit 12 frequencies and 3 degrees", LINES, mobility[:, :5], JOINTS)
    refused("shape", LINES[:5], mobility, JOINTS)
    broken = mobility.copy()
    broken[3, 1, 2] = np.nan
    refused(r"entry \(1, 2\) of line 3 is", LINES, broken, JOINTS)
    refused("finite, positive", -LINES, mobility, JOINTS)
    refused("finite, positive", [[1.0]], mobility, JOINTS)
    refused("not numbers", ["a"], mobility, JOINTS)
    refused("occurs twice", np.full(12, 50.0), mobility, JOINTS)
    refused("not an array of complex numbers", LINES, [["x"]], JOINTS)
    refused("degree of freedom twice", LINES, mobility, {"one": ("ux", "ux")})
    refused("give every joint", LINES, mobility, {})
    refused("give every joint", LINES, mobility, {"one": ()})


def test_too_few_lines(mobility):
    Y = mobility[:1][:, [0, 3]][:, :, [0, 3]]
    refused("1 lines are too few for 2 unknown", LINES[:1], Y, {"one": ("ux",)})


def test_other_quantities(mobility):
    iw = 2j * np.pi * LINES[:, None, None]
    refused("accelerances: divide by i w", LINES, mobility * iw, JOINTS)
    refused("receptances: multiply by i w", LINES, mobility / iw, JOINTS)
    flipped = mobility * np.array([1, 1, 1, -1, 1, 1])
    refused("check the directions|equal by reciprocity", LINES, flipped, JOINTS)
    swapped = mobility[:, :, [0, 1, 2, 4, 3, 5]]
    refused("check the directions|equal by reciprocity", LINES, swapped, JOINTS)


def test_other_convention_is_pointed_out(mobility):
    """Conjugated mobilities are passive too, but all springs come out negative."""
    found = identify(LINES, mobility.conj(), JOINTS)
    assert any("e^(-i w t)" in note for note in found.notes)


def test_ground_and_free_directions(mobility):
    still = mobility.copy()
    still[:, 5] = still[:, :, 5] = 0.0
    refused("two.receiver.ux does not move under its own force", LINES, still, JOINTS)


def test_noise(mobility):
    refused("positive, finite", LINES, mobility, JOINTS, noise=0.0)
    refused("positive, finite", LINES, mobility, JOINTS, noise=-0.01)
    refused("neither a number", LINES, mobility, JOINTS, noise=[0.1, 0.2])
    refused("not a number", LINES, mobility, JOINTS, noise="little")


def test_known_deviations_are_used(mobility):
    """Deviations of every FRF in its own unit: the same as 1 % where they are 1 % of each."""
    rng = np.random.default_rng(2)
    Y = mobility * (1 + 0.01 * np.sqrt(0.5) * (rng.normal(size=mobility.shape) + 1j * rng.normal(size=mobility.shape)))
    relative = identify(LINES, Y, JOINTS, noise=0.01)
    absolute = identify(LINES, Y, JOINTS, noise=0.01 * np.abs(mobility))
    for name in JOINTS:
        np.testing.assert_allclose(
            absolute.joints[name].stiffness_error, relative.joints[name].stiffness_error, rtol=0.15
        )
        apart = np.abs(absolute.joints[name].stiffness - relative.joints[name].stiffness)
        assert (apart < 0.5 * relative.joints[name].stiffness_error).all()
    assert absolute.misfit == pytest.approx(1.0, abs=0.2)


def test_names():
    model = gp.load(MODELS / "gearbox.toml")
    f = np.linspace(500.0, 3000.0, 4)
    for joints, match in ((["bearing_9"], "no joint 'bearing_9'"), (["mount_1"], "ground"), ([], "at least one")):
        with pytest.raises(InputError, match=match):
            gp.measure_joint(model, f, joints)
    with pytest.raises(InputError, match="named twice"):
        gp.measure_joint(model, f, ["bearing_1", "bearing_1"])
    with pytest.raises(InputError, match="noise"):
        gp.measure_joint(model, f, noise=-1.0)
    Y = gp.measure_joint(model, f)
    assert list(Y.motion.values[:2]) == ["bearing_1.source.uy", "bearing_1.source.rx"]
    assert str(Y.motion_unit.values[1]) == "rad/s"
    mixed = Y.isel(motion=np.random.default_rng(1).permutation(16)).transpose("force", "frequency", "motion")
    straight, found = gp.identify_joint(Y).joints, gp.identify_joint(mixed).joints
    for name, joint in straight.items():
        order = [found[name].dofs.index(dof) for dof in joint.dofs]
        np.testing.assert_allclose(joint.stiffness, found[name].stiffness[np.ix_(order, order)], rtol=1e-6)
    with pytest.raises(InputError, match=r"motion has no bearing_1.receiver.uy"):
        gp.identify_joint(Y.isel(motion=slice(0, 8)))
    with pytest.raises(InputError, match="does not name a port"):
        gp.identify_joint(Y.assign_coords(motion=[f"p{k}" for k in range(16)]))
    with pytest.raises(InputError, match="bare numbers need"):
        gp.identify_joint(Y.values)
    with pytest.raises(InputError, match="rename"):
        gp.identify_joint(Y.rename(motion="output"))


def test_readable_text():
    model = gp.load(MODELS / "gearbox.toml")
    text = str(gp.identify_joint(gp.measure_joint(model, np.linspace(500.0, 3000.0, 6), noise=0.01, seed=1)))
    assert text.count("\nbearing_") == 12
    assert "6 lines from 500 to 3000 Hz" in text
