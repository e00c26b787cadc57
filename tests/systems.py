"""Machines for the tests, built from the dataclasses directly: the default gearbox and random gearboxes."""

from dataclasses import replace

import numpy as np

from gearpath.components import Disk, GearTrain, Material, Mesh, RigidBody, Section, Shaft
from gearpath.joints import Joint, Port
from gearpath.network.system import MeshExcitation, PointExcitation, System

STEEL = Material(2.07e11, 0.3, 7850.0)
BEARING = ((1.2e8, 1.8e6), (1.8e6, 6.0e4))
PLANAR = ("uy", "rx")


def scaled(matrix, factor):
    return tuple(tuple(factor * float(x) for x in row) for row in matrix)


def default_gear_train(elements=(8, 8), mesh_z=0.125):
    def shaft(x, disk):
        return Shaft(STEEL, (x, 0.0, -0.125), (Section(0.25, 0.03),), 0.886, elements, (disk,))

    pinion = Disk("pinion", mesh_z, 1.526, 1.0237e-3, 1.8884e-3)
    wheel = Disk("wheel", mesh_z, 1.5568, 1.0638e-3, 1.9655e-3)
    return GearTrain(
        {"input": shaft(-0.04975, pinion), "output": shaft(0.05025, wheel)},
        {"mesh": Mesh((("input", "pinion"), ("output", "wheel")), 1.5e8, (0.04975, 0.05025))},
        0.015,
    )


def default_gearbox(bearing=BEARING, damping=None, **overrides) -> System:
    """The gearbox of EQUATIONS with the default parameters."""
    joints = {}
    stations = [("input", 0.0), ("input", 0.25), ("output", 0.0), ("output", 0.25)]
    for k, (shaft, z) in enumerate(stations, 1):
        joints[f"bearing_{k}"] = Joint(
            "bearing",
            (Port("gear_train", shaft, z), Port("casing")),
            PLANAR,
            bearing,
            scaled(bearing, 1e-6) if damping is None else damping,
        )
    for k, (x, z) in enumerate([(-0.09, -0.12), (0.09, -0.12), (-0.09, 0.12), (0.09, 0.12)], 1):
        joints[f"mount_{k}"] = Joint(
            "mount", (Port("casing"), Port("ground")), ("uy",), ((1e7,),), ((440.0,),), (x, 0.0, z), True
        )
    parts = {
        "name": "gearbox",
        "dofs": PLANAR,
        "components": {
            "gear_train": default_gear_train(),
            "casing": RigidBody(12.0, {"xx": 0.15, "yy": 0.2, "zz": 0.17}),
        },
        "joints": joints,
        "excitation": MeshExcitation("gear_train", "mesh"),
    }
    return System(**{**parts, **overrides})


_DOF_SETS = [
    ("uy", "rx"),
    ("uy",),
    ("ux", "uy", "rx", "ry"),
    ("ux", "uy", "uz", "rx", "ry"),
    ("ux", "uy", "uz", "rx", "ry", "rz"),
]


def random_matrix(rng, dofs, rank, size, lever):
    """Positive semidefinite matrix of the given rank, N/m and N m/rad in proportion to `size` and `lever`."""
    scale = np.array([1.0 if dof[0] == "u" else lever for dof in dofs])
    factor = rng.normal(size=(len(dofs), rank)) * scale[:, None]
    return size * factor @ factor.T / max(rank, 1)


def random_gearbox(seed: int, bearings: int, helical: bool = False) -> System:
    """1 to 3 shafts with disks and meshes, bearings of any rank, a rigid casing on damped mounts.

    helical: axes anywhere across z, pressure and helix angles, tapered shafts, on at least all but rz.
    """
    rng = np.random.default_rng(seed)
    dofs = _DOF_SETS[rng.integers(3 if helical else 0, len(_DOF_SETS))]
    count = int(rng.integers(1, 4))
    shafts, meshes = {}, {}
    for s in range(count):
        length = _station(rng.uniform(0.15, 0.4))
        disks = tuple(
            Disk(f"gear_{d}", _station(z), *_disk(rng))
            for d, z in enumerate(np.sort(rng.uniform(0.1, 0.9, rng.integers(1, 3))) * length)
        )
        diameter = rng.uniform(0.02, 0.06)
        split = _station(rng.uniform(0.3, 0.7) * length)
        sections = (Section(split, diameter), Section(length - split, 0.8 * diameter, 0.2 * diameter))
        shafts[f"shaft_{s}"] = Shaft(
            STEEL, (0.1 * s, 0.0, -length / 2), sections, 0.886, (int(rng.integers(1, 4)),), disks
        )
    for s in range(count - 1):
        pair = ((f"shaft_{s}", "gear_0"), (f"shaft_{s + 1}", "gear_0"))
        meshes[f"mesh_{s}"] = Mesh(pair, 10 ** rng.uniform(7, 9), tuple(rng.uniform(0.03, 0.06, 2).tolist()))
    if helical:
        shafts, meshes = _in_space(rng, shafts, meshes)
    train = GearTrain(shafts, meshes, 10 ** rng.uniform(-3, -1.5))
    joints = {}
    for k in range(bearings):
        name = f"shaft_{int(rng.integers(count))}"
        K = random_matrix(rng, dofs, int(rng.integers(1, len(dofs) + 1)), 10 ** rng.uniform(7, 8.5), 0.02)
        C = 10 ** rng.uniform(-6.5, -5) * K
        z = _station(float(rng.choice([0.0, 1.0, rng.uniform(0.05, 0.95)])) * shafts[name].length)
        joints[f"bearing_{k}"] = Joint(
            "bearing",
            (Port("train", name, z), Port("casing")),
            dofs,
            tuple(map(tuple, K.tolist())),
            tuple(map(tuple, C.tolist())),
        )
    for k in range(int(rng.integers(3, 5))):
        K = random_matrix(rng, dofs, len(dofs), 10 ** rng.uniform(6, 7.5), 0.05)
        joints[f"mount_{k}"] = Joint(
            "mount",
            (Port("casing"), Port("ground")),
            dofs,
            tuple(map(tuple, K.tolist())),
            tuple(map(tuple, (4e-5 * K).tolist())),
            tuple(rng.uniform(-0.15, 0.15, 3).tolist()),
        )
    casing = RigidBody(
        float(rng.uniform(5, 40)),
        dict(zip(("xx", "yy", "zz"), rng.uniform(0.15, 0.25, 3).tolist())),
        tuple(rng.uniform(-0.05, 0.05, 3).tolist()),
    )
    excitation = (
        MeshExcitation("train", "mesh_0")
        if meshes and rng.random() < 0.7
        else PointExcitation(Port("train", "shaft_0", _station(0.4 * shafts["shaft_0"].length)), "uy")
    )
    return System(f"random_{seed}", dofs, {"train": train, "casing": casing}, joints, excitation)


def _in_space(rng, shafts, meshes):
    """The gears of each mesh in one plane, their axes a = (r1 + r2) / cos(alpha) apart in any direction."""
    tapered = {}
    for name, shaft in shafts.items():
        first, second = shaft.sections
        cone = replace(second, outer_end=second.outer * float(rng.uniform(0.5, 1.5)), inner_end=0.0)
        tapered[name] = replace(shaft, sections=(first, cone))
    for name, mesh in meshes.items():
        pressure, helix, direction = rng.uniform([0.0, -0.6, -np.pi], [0.6, 0.6, np.pi]).tolist()
        meshes[name] = replace(
            mesh,
            pressure_angle=pressure,
            helix_angle=helix,
            driving_torque=str(rng.choice(["", "+z", "-z"])),
            contact_offset=float(rng.uniform(-0.02, 0.02)),
        )
        (one, gear), (other, wheel) = mesh.between
        x, y, z = tapered[one].position(tapered[one].disk(gear).z)
        apart = sum(mesh.base_radii) / np.cos(pressure)
        place = (x + apart * np.cos(direction), y + apart * np.sin(direction), z - tapered[other].disk(wheel).z)
        tapered[other] = replace(tapered[other], origin=tuple(map(float, place)))
    return tapered, meshes


def _station(z):
    """On a grid of 0.1 mm (m): spans of micrometres, whose modes are above 1 GHz, are refused, and rightly."""
    return round(float(z), 4)


def _disk(rng):
    mass = rng.uniform(0.3, 3.0)
    polar = mass * rng.uniform(0.03, 0.06) ** 2 / 2
    return float(mass), float(0.55 * polar), float(polar)
