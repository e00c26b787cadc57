"""Assembly of a frame: all parts side by side, then whatever is joined follows one node rigidly."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import coo_array, csc_array
from scipy.sparse.csgraph import connected_components

from ..errors import InputError
from .dofs import rigid_motion
from .node_mesh import NodeMesh, Nodes, Place, follow, scatter, side_by_side

if TYPE_CHECKING:
    from .frame import Frame


def mesh_frame(frame: Frame) -> NodeMesh:
    """Assemble all parts and join them at their places.

    Raises InputError for unknown places, for damping given on a plate and for parts that nothing joins.
    """
    if not frame.beams and not frame.plates:
        raise InputError("the frame has neither beams nor plates; give it at least one")
    fixed, starts = side_by_side([*_frame_nodes(frame), *_plates(frame)])
    spans = [
        [fixed.places[frame_place(frame, f"beam {name!r}", place)] for place in beam.between]
        for name, beam in frame.beams.items()
    ]
    beams = [
        beam.mesh(name, start.position, end.position) for (name, beam), (start, end) in zip(frame.beams.items(), spans)
    ]
    loose, (_, *firsts) = side_by_side([fixed, *beams])
    joints = [
        (place.node, first + end)
        for ends, beam, first in zip(spans, beams, firsts)
        for place, end in zip(ends, (0, len(beam.positions) - 1))
    ]
    for link in frame.links:
        one, two = (fixed.places[frame_place(frame, f"link {link}", place)].node for place in link)
        joints.append((one, two))
    leaders = _leaders(joints, len(loose.positions))
    joined, _ = follow(loose, leaders)
    at = np.unique(leaders).searchsorted(leaders[[*starts, *firsts]])  # where each part begins after joining
    named = {"node": frame.nodes, "plate": frame.plates, "beam": frame.beams}
    _check_whole(joined, dict(zip([f"{kind} {name!r}" for kind, part in named.items() for name in part], at)))
    return replace(joined, mass=joined.mass + _bodies(frame, joined))


def frame_place(frame: Frame, what: str, place: str) -> str:
    """The place itself; raises InputError where the frame has none of that name."""
    known = [*frame.nodes, *(f"{name}.{patch}" for name, plate in frame.plates.items() for patch in plate.footprints)]
    if place not in known:
        raise InputError(f"{what}: the frame has no place {place!r}; it has {', '.join(known) or 'none'}")
    return place


def _frame_nodes(frame: Frame) -> list[NodeMesh]:
    """The named nodes of the frame, without any matrix entries."""
    empty = csc_array((6, 6))
    return [
        NodeMesh(np.array([position], float), empty, empty, {name: Place(0, np.array(position, float))})
        for name, position in frame.nodes.items()
    ]


def _plates(frame: Frame) -> list[NodeMesh]:
    meshes = []
    for name, plate in frame.plates.items():
        if plate.modal_damping or plate.loss_factor:
            raise InputError(
                f"plate {name!r} of the frame has a damping of its own; give the damping of the whole frame"
            )
        mesh = plate.mesh().nodes
        meshes.append(replace(mesh, places={f"{name}.{patch}": place for patch, place in mesh.places.items()}))
    return meshes


def _leaders(joints: list[tuple[int, int]], count: int) -> Nodes:
    """The first of all nodes that joints hold together leads them."""
    ends = np.array(joints, int).reshape(-1, 2).T
    graph = coo_array((np.ones(len(joints)), (ends[0], ends[1])), shape=(count, count))
    labels = connected_components(graph, directed=False)[1]
    return np.asarray(np.unique(labels, return_index=True)[1][labels])


def _bodies(frame: Frame, mesh: NodeMesh) -> csc_array:
    """Mass matrix of the rigid bodies at the nodes that carry them: T^T M T, T to the centre of gravity."""
    nodes, blocks = [], np.zeros((len(frame.bodies), 6, 6))
    for block, (name, body) in zip(blocks, frame.bodies.items()):
        node = mesh.places[frame_place(frame, "body", name)].node
        T = rigid_motion(np.array(body.centre_of_gravity) - mesh.positions[node])
        block += T.T @ body.inertia_matrix() @ T
        nodes.append(node)
    return scatter(blocks, np.array(nodes, int).reshape(-1, 1), len(mesh.positions))


def _check_whole(mesh: NodeMesh, parts: Mapping[str, int]) -> None:
    """Refuse a frame that falls into pieces; parts are its nodes, plates and beams with one node of each."""
    entries = coo_array(mesh.stiffness)
    graph = coo_array((np.ones(entries.nnz), (entries.row // 6, entries.col // 6)), shape=(len(mesh.positions),) * 2)
    labels = connected_components(graph, directed=False)[1]
    first, *others = parts
    apart = [part for part in others if labels[parts[part]] != labels[parts[first]]]
    if apart:
        raise InputError(f"the frame is in pieces: nothing joins {first} to {', '.join(apart)}; add beams or links")
