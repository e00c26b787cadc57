"""`with_joint` of a reduced model against `Model.replace` of the complete one: the same matrices, the same refusals."""

from pathlib import Path

import numpy as np
import pytest

import gearpath as gp

pytest.importorskip("control")
MODELS = Path(__file__).resolve().parents[2] / "models"
K = [[1.2e9, 1.8e6], [1.8e6, 6e4]]
C = [[300.0, 4.0], [4.0, 0.9]]


@pytest.fixture(scope="module")
def model():
    return gp.load(MODELS / "gearbox.toml")


@pytest.fixture(scope="module")
def small(model):
    return gp.reduce(model, order=30)


@pytest.fixture(scope="module")
def lossy(model):
    """A bearing with a loss factor beside its damping, another with one alone."""
    return model.replace(
        {
            "joints.bearing_1.damping": C,
            "joints.bearing_1.loss_factor": 0.08,
            "joints.bearing_2.damping_time": 0.0,
            "joints.bearing_2.loss_factor": 0.2,
        }
    )


def deviation(found, model):
    """From the complete state space of a model, relative to the largest gain of every pair that it has."""
    whole = gp.state_space(model)
    w = 2 * np.pi * np.geomspace(20.0, 5000.0, 3000)
    rows = [found.output_labels.index(name) for name in whole.output_labels]
    H, G = responses(whole, w), responses(found, w)[:, rows]
    gain = abs(H).max(axis=0)
    heard = gain > 1e-6 * gain.max(axis=0)
    return (abs(G - H).max(axis=0)[heard] / gain[heard]).max()


def responses(system, w):
    """C (i w - A)^-1 B + D by the poles, (F, outputs, inputs)."""
    poles, T = np.linalg.eig(system.A)
    return (system.C @ T / (1j * w[:, None, None] - poles)) @ np.linalg.solve(T, system.B) + system.D


@pytest.mark.parametrize(
    ("name", "stiffness", "damping"),
    [
        ("bearing_1", K, None),
        ("bearing_1", K, C),
        ("bearing_3", None, C),
        ("bearing_1", 1e8, None),
        ("mount_1", 1e6, 9),
    ],
)
def test_the_joint_of_the_model_file(model, small, name, stiffness, damping):
    """Damping follows by damping_time where it is left out; a number acts along uy alone."""
    values = {"stiffness": stiffness, "damping": damping}
    changes = {f"joints.{name}.{key}": value for key, value in values.items() if value is not None}
    exchanged = small.with_joint(name, stiffness, damping)
    assert deviation(exchanged, model.replace(changes)) <= exchanged.certificate.error < 1e-3
    assert deviation(small, model.replace(changes)) > 1e-2


@pytest.mark.parametrize("name", ["bearing_1", "bearing_2"])
@pytest.mark.parametrize("damping", [None, np.array(C) / 7])
def test_a_loss_factor_stays(lossy, name, damping):
    """eta K / w follows K, beside damping that is given, left, or not there."""
    changes = {f"joints.{name}.stiffness": K}
    if damping is not None:
        changes[f"joints.{name}.damping"] = damping.tolist()
    exchanged = gp.reduce(lossy, order=30).with_joint(name, K, damping)
    assert deviation(exchanged, lossy.replace(changes)) <= exchanged.certificate.error < 1e-3


def test_damping_that_was_given_follows_no_more(model, small):
    twice = small.with_joint("bearing_1", damping=C).with_joint("bearing_1", K)
    changes = {"joints.bearing_1.damping": C, "joints.bearing_1.stiffness": K}
    assert deviation(twice, model.replace(changes)) <= twice.certificate.error < 1e-3


@pytest.mark.parametrize(
    ("name", "values", "words"),
    [
        ("bearing_1", ([[1.0, 1e6], [1e6, 1.0]],), r"coupling of uy and rx, 1e\+06, exceeds 1"),
        ("bearing_1", (-1e8 * np.eye(2),), r"entry \[1,1\], -1e\+08, on uy is negative"),
        ("bearing_1", (None, -1e4 * np.eye(2)), r"bearing_1\.damping: entry \[1,1\]"),
        ("bearing_1", (np.eye(3),), "the matrix is 3 x 3, but dofs has 2: uy, rx"),
        ("bearing_1", ([[1.0, 2.0], [3.0, 4.0]],), "is not symmetric"),
    ],
)
def test_what_the_model_file_refuses_too(model, small, name, values, words):
    with pytest.raises(gp.InputError, match=words) as ours:
        small.with_joint(name, *values)
    part = "stiffness" if values[0] is not None else "damping"
    with pytest.raises(gp.ModelError) as theirs:
        model.replace({f"joints.{name}.{part}": np.asarray(values[-1]).tolist()})
    assert str(theirs.value).endswith(str(ours.value))


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("bearing_9", np.eye(2)), "there is no joint 'bearing_9'"),
        (("bearing_1", [[np.nan, 0.0], [0.0, 1.0]]), "is no matrix of finite real numbers; give one on uy, rx"),
        (("bearing_1", np.inf), "is no matrix of finite"),
        (("bearing_1", "abc"), "is no matrix of finite"),
        (("bearing_1", [[1.0], [2.0, 3.0]]), "is no matrix of finite"),
        (("bearing_1", [1.0, 2.0]), "is no matrix of finite"),
        (("bearing_1", 1j * np.eye(2)), "is no matrix of finite"),
        (("bearing_1", True), "is no matrix of finite"),
        (("mount_1", np.eye(2)), "the matrix is 2 x 2, but dofs has 1: uy"),
    ],
)
def test_what_is_no_matrix(small, arguments, words):
    with pytest.raises(gp.InputError, match=words):
        small.with_joint(*arguments)
