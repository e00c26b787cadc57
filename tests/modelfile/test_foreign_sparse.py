"""Sparse matrices in an archive: the last coordinates may have no mass; entries that do not fit are refused."""

import numpy as np
import pytest

import gearpath as gp
from gearpath.errors import InputError
from gearpath.modelfile.data.npz import read_npz

THREE = 1e7 * np.array([[1.0, 0.0, -1.0], [0.0, 1.0, -1.0], [-1.0, -1.0, 2.0]])


def entries(name, matrix):
    row, column = np.nonzero(np.triu(matrix))
    return {f"{name}_row": row, f"{name}_column": column, f"{name}_value": matrix[row, column]}


@pytest.mark.parametrize("sparse", [("mass",), ("stiffness", "mass")])
def test_the_last_coordinate_may_have_no_mass(tmp_path, sparse):
    mass = np.diag([2.0, 3.0, 0.0])
    arrays = {}
    for name, matrix in (("stiffness", THREE), ("mass", mass)):
        arrays |= entries(name, matrix) if name in sparse else {name: matrix}
    np.savez(tmp_path / "body.npz", **arrays)
    found = read_npz(tmp_path / "body.npz")
    np.testing.assert_array_equal(found.mass.toarray(), mass)
    stiffness = found.stiffness.toarray() if "stiffness" in sparse else found.stiffness
    np.testing.assert_array_equal(stiffness, THREE)


@pytest.mark.parametrize(
    ("part", "value"),
    [
        ("row", np.array([0, 0, -1, 1, 2])),
        ("row", np.array([0.0, 0.0, 1.0, 1.0, 2.0])),
        ("column", np.array([0, 1])),
        ("value", np.array(["a", "b", "c", "d", "e"])),
    ],
)
def test_entries_that_do_not_fit(tmp_path, part, value):
    arrays = entries("stiffness", THREE) | {"mass": np.eye(3)}
    assert len(arrays["stiffness_row"]) == 5
    np.savez(tmp_path / "body.npz", **arrays | {f"stiffness_{part}": value})
    with pytest.raises(InputError, match=r"body\.npz: stiffness_row, stiffness_column and stiffness_value do not fit"):
        read_npz(tmp_path / "body.npz")


def test_a_component_is_built_once_for_the_same_files(tmp_path):
    """Neither joints nor sweeps build it again; another damping or a file that was written again does."""
    np.savez(tmp_path / "body.npz", stiffness=THREE, mass=np.diag([2.0, 3.0, 1.0]))
    table = {"kind": "matrices", "file": "body.npz", "ports": {"a": [0], "b": {"uy": 1}}, "loss_factor": 0.01}
    spring = {"kind": "mount", "between": ["body.b", "ground"], "stiffness": 1e6}
    data = {
        "name": "small",
        "dofs": ["uy"],
        "components": {"body": table},
        "joints": {"spring": spring},
        "excitation": {"point": "body.a", "dof": "uy"},
    }
    model = gp.Model.from_dict(data, str(tmp_path / "model.toml"))
    first = model.system.components["body"]
    assert model.replace({"joints.spring.stiffness": 2e6}).system.components["body"] is first
    assert model.replace({"components.body.loss_factor": 0.02}).system.components["body"] != first
    np.savez(tmp_path / "body.npz", stiffness=THREE, mass=np.diag([2.0, 3.0, 1.5]))
    again = gp.Model.from_dict(data, str(tmp_path / "model.toml")).system.components["body"]
    assert again != first
    assert again.mass[2, 2] == pytest.approx(1.5)
