"""The catalogue, files of users, and damping as a method."""

import numpy as np
import pytest

import gearpath as gp

NAMES = sorted(gp.designations())
ROLLER = '[mine]\ntype = "roller"\nroller_length = 0.01\npitch_radius = 0.03\ncontact_angle = 0.0\n'


def test_about_ten_of_all_kinds_with_their_sources():
    assert len(NAMES) >= 10
    assert all(name.endswith("-like") and source for name, source in gp.designations().items())
    found = [gp.catalogue_bearing(name) for name in NAMES]
    assert {type(b).__name__ for b in found} == {"BallBearing", "RollerBearing"}
    assert {b.contact_angle > 0 for b in found if isinstance(b, gp.RollerBearing)} == {True, False}
    assert {b.contact_angle > 0 for b in found if isinstance(b, gp.BallBearing)} == {True, False}


@pytest.mark.parametrize("name", NAMES)
def test_every_entry_carries_a_load(name):
    """1 kN radially and, where it can, 0.5 kN along the axis: stiffness of the usual size, 10 to 3000 N/um."""
    bearing = gp.catalogue_bearing(name)
    axial = isinstance(bearing, gp.BallBearing) or bearing.contact_angle
    K = bearing.equilibrium({"uy": 1000.0, **({"uz": 500.0} if axial else {})}).stiffness
    assert 1e7 < K[1, 1] < 3e9
    assert np.linalg.eigvalsh(K[:5, :5]).min() > -1e-6 * K[1, 1]


def test_a_file_of_the_user_and_changes(tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text(ROLLER + "rollers = 12\n")
    assert list(gp.designations(file)) == ["mine"]
    assert gp.catalogue_bearing("mine", file) == gp.RollerBearing(12, 0.01, 0.03, 0.0)
    assert gp.catalogue_bearing("mine", file, rollers=13).rollers == 13


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[mine]\n", "type"),
        ('[mine]\ntype = "gear"\n', "none of ball, roller"),
        ('[mine]\ntype = "ball"\nballs = 9\n', "ball_diameter"),
        ('[mine]\ntype = "roller"\nrollers = 9\ncolour = 1\n', "colour"),
        (ROLLER + "rollers = 0\n", "rollers"),
        ("mine = 1\n", "not in a table"),
        ("[mine\n", "TOML"),
        ("[other]\n", "there are other"),
    ],
)
def test_wrong_files(tmp_path, text, words):
    file = tmp_path / "mine.toml"
    file.write_text(text)
    with pytest.raises(gp.InputError, match=r"mine\.toml") as caught:
        gp.catalogue_bearing("mine", file)
    assert words in str(caught.value)


def test_no_file():
    with pytest.raises(gp.InputError, match="cannot be read"):
        gp.catalogue_bearing("mine", "nowhere.toml")


def test_damping_goes_with_the_stiffness():
    bearing, q = gp.catalogue_bearing("6205-like"), np.array([0.0, 1e-5, 2e-6, 0.0, 0.0, 0.0])
    K = bearing.stiffness(q)
    np.testing.assert_array_equal(bearing.damping(q, time=2e-6), 2e-6 * K)
    found = bearing.damping(q, loss_factor=0.02, frequency=500.0)
    np.testing.assert_allclose(found, 0.02 / (1000 * np.pi) * K, rtol=1e-15)
    for wrong in ({}, {"time": 1e-6, "loss_factor": 0.1}, {"loss_factor": 0.1}):
        with pytest.raises(gp.InputError, match="give time"):
            bearing.damping(q, **wrong)
