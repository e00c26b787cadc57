"""The plate element with six coordinates a node: bending and in-plane motion, which do not couple in a flat plate."""

from __future__ import annotations

import numpy as np

from ..numerics.arrays import Real
from .material import Material
from .plate_bending import bending_elements
from .plate_membrane import membrane_elements

_COORDINATES = np.arange(24).reshape(4, 6)  # of each node
_MEMBRANE, _BENDING = _COORDINATES[:, [0, 1, 5]].ravel(), _COORDINATES[:, [2, 3, 4]].ravel()


def plate_elements(corners: Real, material: Material, thickness: float, shear_coefficient: float) -> tuple[Real, Real]:
    """Stiffness and mass (e, 24, 24) of flat quadrilaterals with the given corners (e, 4, 2), counter-clockwise, m.

    Coordinates: u_1 u_2 u_3 theta_1 theta_2 theta_3 of each node, in the plate's own axes.
    """
    K, M = (np.zeros((len(corners), 24, 24)) for _ in range(2))
    for part, (stiffness, mass) in (
        (_MEMBRANE, membrane_elements(corners, material, thickness)),
        (_BENDING, bending_elements(corners, material, thickness, shear_coefficient)),
    ):
        rows, columns = np.ix_(part, part)
        K[:, rows, columns], M[:, rows, columns] = stiffness, mass
    return K, M
