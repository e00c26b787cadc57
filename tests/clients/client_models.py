"""Changes of the default gearbox: as edits of the model, and as values of the FMU's parameters."""

import numpy as np

STIFFNESS = np.array([[2.0e8, 1.5e6], [1.5e6, 9.0e4]])  # of the bearing that is put in the place of bearing_1
DAMPING = np.array([[300.0, 2.0], [2.0, 0.1]])
SCALARS = {"mount_1.stiffness": 2.0e7, "mount_1.damping": 600.0, "gear_train.modal_damping": 0.03}


def other_bearing(model):
    """The model with another bearing_1: all entries of both matrices differ."""
    matrices = {"stiffness": STIFFNESS, "damping": DAMPING}
    return model.replace({f"joints.bearing_1.{name}": matrix.tolist() for name, matrix in matrices.items()})


def other_scalars(model):
    """The model with what clients can set that know no arrays (FMI 3 has the bearings' matrices as arrays)."""
    places = {"mount_1": "joints.mount_1", "gear_train": "components.gear_train"}
    return model.replace({f"{places[name.split('.')[0]]}.{name.split('.')[1]}": v for name, v in SCALARS.items()})


def bearing_matrices(model=None):
    """FMI 3: the two arrays of bearing_1, of the other bearing or of `model`'s."""
    if model is None:
        return {"bearing_1.stiffness": STIFFNESS, "bearing_1.damping": DAMPING}
    joint = model.system.joints["bearing_1"]
    return {"bearing_1.stiffness": np.asarray(joint.stiffness), "bearing_1.damping": np.asarray(joint.damping)}


def bearing_entries(model=None):
    """FMI 2: the upper halves, entry by entry."""
    return {
        f"{name}[{i + 1},{j + 1}]": float(matrix[i, j])
        for name, matrix in bearing_matrices(model).items()
        for i, j in ((0, 0), (0, 1), (1, 1))
    }
