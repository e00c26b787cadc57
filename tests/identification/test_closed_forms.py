"""Two masses by hand, random machines in space with coupled joints, rigid parts, and what cannot be told."""

from pathlib import Path

import numpy as np
import pytest
from machines import assembled, noisy, worst

import gearpath as gp
from gearpath.identification import identify, with_noise
from gearpath.network.assemble import assemble

MODELS = Path(__file__).resolve().parents[2] / "models"
LINES = np.linspace(30.0, 900.0, 25)
M1, M2, K, C, GROUND, DRAG = 2.0, 5.0, 4.0e6, 150.0, 1.0e6, 80.0


def two_masses(f):
    """m1 on a spring-damper on m2 on a spring to the ground: Cramer's rule."""
    w = 2.0 * np.pi * f
    joint, mount = K / (1j * w) + C, GROUND / (1j * w) + DRAG
    a, b = 1j * w * M1 + joint, 1j * w * M2 + joint + mount
    determinant = a * b - joint**2
    return np.array([[b, joint], [joint, a]]).transpose(2, 0, 1) / determinant[:, None, None]


def test_two_masses():
    found = identify(LINES, two_masses(LINES), {"spring": ("uy",)})
    assert found.joints["spring"].stiffness[0, 0] == pytest.approx(K, rel=1e-9)
    assert found.joints["spring"].damping[0, 0] == pytest.approx(C, rel=1e-9)
    assert found.cross_talk is None


@pytest.mark.parametrize("mirrored", [False, True])
def test_two_masses_with_noise(mirrored):
    """The error of K and C over 200 trials is what each trial says; one half may mirror the other."""
    Y, rng, z = two_masses(LINES), np.random.default_rng(8), []
    for _ in range(200):
        measured = noisy(Y, 0.02, rng)
        if mirrored:
            measured = np.triu(measured) + np.triu(measured, 1).swapaxes(1, 2)
        found = identify(LINES, measured, {"spring": ("uy",)})
        joint = found.joints["spring"]
        assert (found.misfit is None) == mirrored
        apart = [(joint.stiffness - K) / joint.stiffness_error, (joint.damping - C) / joint.damping_error]
        z.append(np.ravel(apart))
    assert np.abs(np.mean(z, axis=0)).max() < 0.25
    np.testing.assert_allclose(np.std(z, axis=0), 1.0, atol=0.15)
    assert (np.sum(np.abs(z) < 1.96, axis=0) >= 180).all()


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("rank", [None, 2])
def test_random_machines_in_space(seed, rank):
    """Two joints with full matrices between parts of many modes; singular stiffness too."""
    Y, truth = assembled(np.random.default_rng(seed), (3, 4), LINES, rank=rank)
    found = identify(LINES, Y, {"one": ("ux", "uy", "rz"), "two": ("ux", "uy", "uz", "rx")})
    assert worst(found, truth) < 1e-8
    assert found.cross_talk.value < 1e-8


def test_random_machine_with_noise():
    Y, truth = assembled(np.random.default_rng(11), (2, 2), LINES)
    rng, z = np.random.default_rng(12), []
    for _ in range(25):
        found = identify(LINES, noisy(Y, 0.01, rng), {"one": ("ux", "uy"), "two": ("ux", "uy")})
        for joint, (stiffness, damping) in zip(found.joints.values(), truth):
            z.append(((joint.stiffness - stiffness) / joint.stiffness_error)[np.triu_indices(2)])
            z.append(((joint.damping - damping) / joint.damping_error)[np.triu_indices(2)])
    assert 0.85 < np.std(z) < 1.15
    assert np.mean(np.abs(z) < 1.96) > 0.92


def test_stiffness_between_two_joints_is_reported():
    """A single joint of four degrees of freedom, declared as two of two: the blocks between them do not vanish."""
    Y, ((stiffness, _),) = assembled(np.random.default_rng(13), (4,), LINES)
    found = identify(LINES, Y, {"one": ("ux", "uy"), "two": ("ux", "uy")})
    between = np.abs(stiffness[:2, 2:]) / np.sqrt(np.outer(np.diag(stiffness)[:2], np.diag(stiffness)[2:]))
    assert found.cross_talk.value > 0.2 * between.max()
    assert found.cross_talk.pair == ("one", "two")
    assert any("misses a connection" in note for note in found.notes)


def rigid_parts(places, f):
    """Two planar bodies (uy, rx, rz) joined at (x, z) places; the second on springs. Y by inverting their sum."""
    matrix, soft = np.array([[1e8, 1e6], [1e6, 5e4]]), np.array([[100.0, 1.0], [1.0, 0.05]])
    R = np.vstack([[[1.0, -z, x], [0.0, 1.0, 0.0]] for x, z in places])
    B = np.hstack([R, -R])
    ports = np.kron(np.eye(2), R)
    n = len(places)
    Y = []
    for w in 2.0 * np.pi * f:
        Z = np.kron(np.eye(n), matrix / (1j * w) + soft)
        own = 1j * w * np.diag([5.0, 0.05, 0.07, 12.0, 0.2, 0.3])
        own[3:, 3:] += np.diag([1e7, 1e5, 2e5]) * (1.0 / (1j * w) + 1e-5)
        Y.append(ports @ np.linalg.inv(own + B.T @ Z @ B) @ ports.T)
    return np.array(Y), [(matrix, soft)] * n


def test_what_rigid_parts_cannot_tell_is_named():
    """Two planar bodies feel of two joints only the sum of the tilting stiffness, for both tilt by the same angle."""
    f = np.linspace(50.0, 3000.0, 20)
    Y, truth = rigid_parts([(-0.05, -0.1), (0.06, 0.12)], f)
    found = identify(f, Y, {"one": ("uy", "rx"), "two": ("uy", "rx")})
    assert found.undetermined == (
        *("one.stiffness[2,2]", "two.stiffness[2,2]", "one.damping[2,2]", "two.damping[2,2]"),
    )
    for joint, (stiffness, _) in zip(found.joints.values(), truth):
        assert np.isinf(joint.stiffness_error[1, 1])
        np.testing.assert_allclose(joint.stiffness[0], stiffness[0], rtol=1e-6)
    total = sum(joint.stiffness[1, 1] for joint in found.joints.values())
    assert total == pytest.approx(2 * truth[0][0][1, 1], rel=1e-6)
    Y, truth = rigid_parts([(-0.05, -0.1)], f)
    assert worst(identify(f, Y, {"one": ("uy", "rx")}), truth) < 1e-8


def test_joints_of_six_degrees_of_freedom():
    """The helical gearbox, four bearings of six: 84 entries of K and as many of C; the casing is rigid."""
    model = gp.load(MODELS / "helical_gearbox.toml")
    f = np.array([180.0, 900.0, 2100.0, 3700.0])
    Y = gp.measure_joint(model, f)
    found = gp.identify_joint(Y)
    truth = [(j.stiffness, j.damping) for j in assemble(model.system).joints if j.name in found.joints]
    assert worst(found, truth) < 1e-6


def test_negative_estimates_have_passive_neighbours():
    """With much noise C comes out indefinite; the passive one is inside its uncertainty and fits a model."""
    model = gp.load(MODELS / "gearbox.toml")
    f = np.linspace(300.0, 5000.0, 10)
    found = gp.identify_joint(gp.measure_joint(model, f, noise=0.03, seed=1))
    indefinite = [j for j in found.joints.values() if np.linalg.eigvalsh(j.damping)[0] < 0.0]
    assert indefinite
    for joint in found.joints.values():
        assert np.linalg.eigvalsh(joint.passive_damping)[0] > -1e-9 * joint.passive_damping.max()
    for joint in indefinite:
        assert (np.abs(joint.passive_damping - joint.damping) < 4.0 * joint.damping_error).all()
    changed = model.replace(found.changes())
    assert gp.power_flow(changed, f).alpha.values.min() > 0.0


def test_noise_of_a_simulated_measurement():
    Y = np.full((2000, 2, 2), 3.0 - 4.0j)
    e = with_noise(Y, 0.1, 5) / Y - 1.0
    assert np.sqrt(np.mean(np.abs(e) ** 2)) == pytest.approx(0.1, rel=0.03)
    assert abs(np.mean(e**2)) < 0.05 * 0.1**2
