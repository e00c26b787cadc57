"""Machines with rigid joints, built from the dataclasses, for the tests of rigid joints."""

from dataclasses import replace

import numpy as np
from systems import PLANAR, STEEL, default_gearbox

from gearpath.components import GearTrain, RigidBody, Section, Shaft
from gearpath.joints import Joint, Port
from gearpath.network.system import PointExcitation, System

SIX = ("ux", "uy", "uz", "rx", "ry", "rz")


def rigid(first, second, at=None, dofs=()):
    return Joint("rigid", (first, second), dofs, (), (), at)


def spring(first, second, K, dofs=SIX, at=None, time=0.0, kind="mount"):
    """A joint with a matrix, or a number for a diagonal one, and C = time K."""
    K = np.diag(np.broadcast_to(K, len(dofs))) if np.ndim(K) < 2 else np.array(K)
    stiffness, damping = (tuple(map(tuple, matrix.tolist())) for matrix in (K, time * K))
    return Joint(kind, (first, second), dofs, stiffness, damping, at)


def ground():
    return Port("ground")


def beam(*lengths, z=0.0, zeta=0.0, beam="timoshenko", elements=(4,), diameter=0.03):
    """A round bar along z in sections, without disks."""
    sections = tuple(Section(length, diameter) for length in lengths)
    return GearTrain({"s": Shaft(STEEL, (0.0, 0.0, z), sections, 0.886, elements, (), beam)}, {}, zeta)


def on(component, z):
    return Port(component, "s", z)


def machine(components, joints, port, dof="uy", dofs=SIX, **more):
    return System("machine", dofs, components, joints, PointExcitation(port, dof), **more)


def gearbox_on_beam(zeta=0.03, damped=True):
    """The default gearbox, its casing bolted to a beam at two places, the beam on mounts at its ends."""
    gearbox = default_gearbox()
    joints = {name: joint for name, joint in gearbox.joints.items() if joint.kind == "bearing"}
    joints["bolt_1"] = rigid(on("base", 0.08), Port("casing"))
    joints["bolt_2"] = rigid(on("base", 0.32), Port("casing"))
    for k, z in enumerate((0.0, 0.4), 1):
        joints[f"mount_{k}"] = spring(on("base", z), ground(), [1e7, 1e4], PLANAR, time=4e-5 * damped)
    parts = {**gearbox.components, "base": beam(0.4, z=-0.2, zeta=zeta, elements=(3,), diameter=0.05)}
    return replace(gearbox, components=parts, joints=joints)


def spatial_gearbox(**rigid_joints):
    """The default gearbox in six degrees of freedom, its shafts twisting; some joints exchanged or added."""
    gearbox = default_gearbox()
    bearing = np.diag([1e8, 1.2e8, 1e7, 6e4, 6e4, 0.0])
    bearing[1, 3] = bearing[3, 1] = 1.8e6
    joints = {}
    for name, joint in gearbox.joints.items():
        K, time = (bearing, 1e-6) if joint.kind == "bearing" else (np.diag([1e7] * 3 + [1e3] * 3), 4e-5)
        joints[name] = spring(*joint.between, K, SIX, joint.at, time, joint.kind)
    return replace(gearbox, dofs=SIX, joints={**joints, **rigid_joints})


def with_more_bodies(system, seed):
    """A machine with beams and bodies rigidly joined to its casing and to each other at random, some to the ground."""
    rng = np.random.default_rng(seed)
    parts, joints = dict(system.components), dict(system.joints)
    held = ["casing"]
    for k in range(int(rng.integers(1, 4))):
        name = f"part_{k}"
        if rng.random() < 0.5:
            zeta, elements = float(rng.choice([0.0, 10 ** rng.uniform(-3, -1.5)])), (int(rng.integers(1, 3)),)
            parts[name] = beam(float(rng.uniform(0.2, 0.5)), z=-0.2, zeta=zeta, elements=elements)
        else:
            inertia = dict(zip(("xx", "yy", "zz"), rng.uniform(0.05, 0.08, 3).tolist()))
            parts[name] = RigidBody(float(rng.uniform(1, 9)), inertia, tuple(rng.uniform(-0.1, 0.1, 3).tolist()))
        for _ in range(int(rng.integers(1, 3))):
            other = str(rng.choice(held))
            dofs = tuple(d for d in system.dofs if rng.random() < 0.7) if rng.random() < 0.4 else ()
            z = float(rng.uniform(0.0, 0.2))
            placed = [isinstance(parts[n], GearTrain) for n in (name, other)]
            at = None if any(placed) else tuple(rng.uniform(-0.2, 0.2, 3).tolist())
            ends = [on(n, z) if train else Port(n) for n, train in zip((name, other), placed)]
            joints[f"joint_{len(joints)}"] = rigid(*ends, at, dofs)
        held.append(name)
    return replace(system, components=parts, joints=joints)
