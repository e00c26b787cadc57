"""The default gearbox in a frame as its casing, and that frame as matrices and modes in files of every format."""

from pathlib import Path

import numpy as np
import scipy.io
import scipy.sparse

import gearpath as gp
from gearpath.components import DOFS

MODEL = Path(__file__).resolve().parents[2] / "models" / "gearbox.toml"
_ENDS = [(-0.04975, -0.125), (-0.04975, 0.125), (0.05025, -0.125), (0.05025, 0.125)]  # x, z of the shafts' ends
_FEET = [(-0.12, -0.12), (0.12, -0.12), (-0.12, 0.12), (0.12, 0.12)]
SEATS = {
    f"{kind}_{k}": place for kind, places in (("bearing", _ENDS), ("mount", _FEET)) for k, place in enumerate(places, 1)
}


def frame_model(loss_factor=0.02):
    """The gearbox whose bearings and mounts sit on a frame of round steel beams."""
    data = gp.load(MODEL).to_dict()
    data["frequency"] = {"start": 50.0, "stop": 2000.0, "points": 40}
    pairs = [
        ("bearing_1", "bearing_2"),
        ("bearing_3", "bearing_4"),
        ("bearing_1", "bearing_3"),
        ("bearing_2", "bearing_4"),
    ]
    pairs += [(f"bearing_{k}", f"mount_{m}") for k, m in ((1, 1), (2, 3), (3, 2), (4, 4), (1, 4))]
    data["components"]["casing"] = {
        "kind": "frame",
        "loss_factor": loss_factor,
        "nodes": {name: [x, 0.0, z] for name, (x, z) in SEATS.items()},
        "beams": {
            f"beam_{k}": {"between": list(pair), "material": "steel", "diameter": 0.03, "elements": 2}
            for k, pair in enumerate(pairs, 1)
        },
    }
    for name, joint in data["joints"].items():
        joint["between"] = [text.replace("casing", f"casing.{name}") for text in joint["between"]]
        joint.pop("at", None)
    return gp.Model.from_dict(data)


def with_casing(model, table, folder):
    """The model with another casing whose files are in `folder`."""
    data = model.to_dict()
    data["components"]["casing"] = table
    return gp.Model.from_dict(data, str(folder / "model.toml"))


def matrices_of(model):
    """Dense K, M and coordinate by port and degree of freedom of the frame."""
    frame = model.system.components["casing"]
    structure = frame.structure(DOFS, {name: name for name in SEATS})
    ports = {}
    for name, rows in structure.ports.items():
        full = np.asarray(rows.toarray() if scipy.sparse.issparse(rows) else rows)
        places = abs(full).argmax(axis=1)
        assert np.allclose(full[np.arange(6), places], 1.0)
        assert np.count_nonzero(full) == 6
        ports[name] = [int(place) for place in places]
    return structure.stiffness.toarray(), structure.mass.toarray(), ports


def written(form, K, M, ports, folder):
    """A table of kind matrices whose file has this form."""
    table = {"kind": "matrices", "loss_factor": 0.02, "ports": ports}
    if form == "npz":
        np.savez(folder / "casing.npz", stiffness=K, mass=M)
        return table | {"file": "casing.npz"}
    if form == "sparse npz":
        parts = {}
        for name, matrix in (("stiffness", K), ("mass", M)):
            upper = scipy.sparse.triu(scipy.sparse.coo_array(matrix)).tocoo()
            parts |= {f"{name}_row": upper.row, f"{name}_column": upper.col, f"{name}_value": upper.data}
        np.savez(folder / "casing.npz", **parts)
        return table | {"file": "casing.npz"}
    if form == "mtx":
        scipy.io.mmwrite(folder / "k.mtx", scipy.sparse.coo_array(K), precision=17, symmetry="symmetric")
        scipy.io.mmwrite(folder / "m.mtx", scipy.sparse.coo_array(M), precision=17, symmetry="symmetric")
        return table | {"file": "k.mtx", "mass_file": "m.mtx"}
    if form == "op4":
        from pyyeti.nastran import op4

        op4.write(str(folder / "casing.op4"), {"KAA": K, "MAA": M})
        return table | {"file": "casing.op4"}
    lines = {".sti": K, ".mas": M}
    for suffix, matrix in lines.items():
        upper = scipy.sparse.triu(scipy.sparse.coo_array(matrix)).tocoo()
        text = "".join(f"{i + 1} {k + 1} {v:.17e}\n" for i, k, v in zip(upper.row, upper.col, upper.data))
        (folder / f"job{suffix}").write_text(text)
    (folder / "job.dof").write_text("".join(f"{i // 6 + 1}.{i % 6 + 1}\n" for i in range(len(K))))
    nodes = {name: {"node": places[0] // 6 + 1, "rotations": True} for name, places in ports.items()}
    return table | {"file": "job.sti", "ports": nodes}
