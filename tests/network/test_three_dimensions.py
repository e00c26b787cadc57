"""The planar model within the three-dimensional one: equal where the geometry decouples, and what couples it.

Planar: uy and rx of shafts and bearings; uy, rx and rz of the casing. In space these stay among themselves where

- the line of action is y (no pressure or helix angle) and the gears lie in one plane,
- no bearing or mount couples (uy, rx) with the rest, and none resists rz,
- the casing's products of inertia xy and yz vanish (they tie rx and rz to ry; xz may stay),
- bearings, mounts and the casing's centre of gravity lie in one plane y = const: of a joint at the height h above it
  rx moves the uz by h, and rz the ux.

The planar model's gears spin freely on their shafts. The shafts of a model with rz twist, and their polar inertia turns
with the gears, so the planar model is compared with the one without rz; with rz, with the one of uy, rx, rz.
"""

from dataclasses import replace

import numpy as np
import pytest
from systems import BEARING, STEEL, default_gearbox, scaled

from gearpath.components import DOFS, RigidBody
from gearpath.joints import Joint
from gearpath.network.assemble import assemble
from gearpath.network.power import power_flow

OMEGA = 2 * np.pi * np.geomspace(20.0, 5000.0, 60)
OTHER = ((0.9e8, -1.1e6), (-1.1e6, 5.0e4))  # ux, ry


def embedded(dofs, blocks):
    """A matrix on dofs from blocks {dofs of the block: matrix}."""
    K = np.zeros((6, 6))
    for names, block in blocks.items():
        at = [DOFS.index(name) for name in names]
        K[np.ix_(at, at)] = block
    keep = [DOFS.index(dof) for dof in dofs]
    return tuple(map(tuple, K[np.ix_(keep, keep)].tolist()))


def spatial(dofs, height=0.0, inertia=None):
    """The default gearbox on more degrees of freedom; mounts on all three axes, `height` below the bearings."""
    planar, joints = default_gearbox(), {}
    for name, joint in planar.joints.items():
        blocks = {("uy", "rx"): BEARING, ("ux", "ry"): OTHER, ("uz",): 7e7}
        if joint.kind == "mount":
            blocks = {("ux",): 3e6, ("uy",): 1e7, ("uz",): 2e6}
            joint = replace(joint, at=(joint.at[0], -height, joint.at[2]), scalar=False)
        K = embedded(dofs, blocks)
        time = 4.4e-5 if joint.kind == "mount" else 1e-6
        joints[name] = Joint(joint.kind, joint.between, dofs, K, scaled(K, time), joint.at)
    casing = RigidBody(12.0, {"xx": 0.15, "yy": 0.2, "zz": 0.17} | (inertia or {}))
    return replace(planar, dofs=dofs, joints=joints, components={**planar.components, "casing": casing})


def flow(system):
    return power_flow(assemble(system).modal(), OMEGA)


def deviation(found, expected):
    """Largest relative deviation of alpha, and of the forces of every kind; other paths carry nothing."""
    worst = [np.max(abs(found.share() / expected.share() - 1.0))]
    for kind in "ur":
        rows = [path for path in expected.paths if path.rsplit(".", 1)[1][0] == kind]
        one, other = (np.array([f.force[f.paths.index(path)] for path in rows]) for f in (found, expected))
        size = abs(other).max(axis=0)
        worst.append(np.max(abs(one - other).max(axis=0) / size))
        rest = [k for k, path in enumerate(found.paths) if path not in rows and path.rsplit(".", 1)[1][0] == kind]
        worst.append(np.max(abs(found.force[rest]) / size, initial=0.0))
    return max(worst)


@pytest.mark.parametrize(
    ("dofs", "plane"), [(DOFS[:5], ("uy", "rx")), (DOFS, ("uy", "rx", "rz"))], ids=["free spin", "torsion"]
)
def test_planar_model_is_recovered_where_the_geometry_decouples(dofs, plane):
    assert deviation(flow(spatial(dofs)), flow(spatial(plane))) < 1e-9


def test_planar_model_is_that_of_the_paper():
    assert deviation(flow(spatial(DOFS[:5])), flow(default_gearbox())) < 1e-9


def test_torsion_tends_to_free_spin_far_below_its_frequencies():
    """With rz the polar inertia of the shafts turns with the gears; it is taken out of the disks here.

    What remains is their twist, as the square of the frequency: (f / 6.4 kHz)^2, a quarter wave on either half shaft.
    """
    planar, space = spatial(DOFS[:5]), spatial(DOFS)
    train = space.components["gear_train"]
    own = STEEL.density * np.pi * 0.03**4 / 32 * 0.25
    shafts = {
        name: replace(shaft, disks=tuple(replace(d, polar_inertia=d.polar_inertia - own) for d in shaft.disks))
        for name, shaft in train.shafts.items()
    }
    light = replace(space, components={**space.components, "gear_train": replace(train, shafts=shafts)})
    one, other = (power_flow(assemble(s).modal(), 2 * np.pi * np.array([10.0, 20.0])) for s in (light, planar))
    force = one.force[one.paths.index("bearing_1.uy")] / other.force[other.paths.index("bearing_1.uy")]
    errors = abs(force - 1.0)
    assert errors[0] < (10.0 / 6370) ** 2
    assert errors[1] / errors[0] == pytest.approx(4.0, rel=0.01)


@pytest.mark.parametrize("change", [{"height": 0.05}, {"inertia": {"xy": 0.01}}, {"inertia": {"yz": 0.01}}])
def test_heights_and_products_of_inertia_couple_the_planes(change):
    """The motion leaves the plane, and alpha with it."""
    found, planar = flow(spatial(DOFS[:5], **change)), flow(default_gearbox())
    outside = [k for k, path in enumerate(found.paths) if path[-2:] in ("ux", "uz")]
    assert np.max(abs(found.force[outside])) > 1e-3 * np.max(abs(planar.force))
    assert np.max(abs(found.share() / planar.share() - 1.0)) > 1e-3


def test_a_product_of_inertia_of_the_planar_rotations_stays_in_the_plane():
    """xz ties rx and rz of the casing, which the planar model has: both models change alike."""
    system, inertia = default_gearbox(), {"xx": 0.15, "yy": 0.2, "zz": 0.17, "xz": 0.01}
    planar = replace(system, components={**system.components, "casing": RigidBody(12.0, inertia)})
    assert deviation(flow(spatial(DOFS[:5], inertia={"xz": 0.01})), flow(planar)) < 1e-9
    assert deviation(flow(planar), flow(system)) > 1e-4


@pytest.mark.parametrize("angles", [(0.35, 0.0), (0.0, 0.3), (0.35, 0.3)], ids=["pressure", "helix", "both"])
def test_pressure_and_helix_angle_couple_the_planes(angles):
    """The mesh presses across the line of centres and along the shafts."""
    system = spatial(DOFS)
    train = system.components["gear_train"]
    radii = tuple(r * np.cos(angles[0]) for r in (0.04975, 0.05025))
    mesh = replace(train.meshes["mesh"], base_radii=radii, pressure_angle=angles[0], helix_angle=angles[1])
    changed = replace(train, meshes={"mesh": mesh})
    found = flow(replace(system, components={**system.components, "gear_train": changed}))

    def largest(dof):
        return np.max([abs(found.force[found.paths.index(f"bearing_{k}.{dof}")]) for k in (1, 2, 3, 4)])

    for dof, angle in zip(("ux", "uz"), angles):
        if angle:
            assert largest(dof) > 0.01 * largest("uy")
