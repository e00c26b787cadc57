"""The paper's test rig (Sec. 5) as solid bodies for CalculiX.

Plates of bricks, one through the thickness; shafts and joints as cylinders. A 12.7 mm square block of the plate, with
the end face of what is attached to its middle surface, is one rigid body; so are the end face of each shaft and that of
its joint.
"""

from dataclasses import dataclass

import numpy as np
from ccx_deck import Deck
from ccx_solids import plate, round_bar

YOUNG, POISSON, DENSITY = 2.07e11, 0.3, 7850.0
MASSLESS = 1e-3  # kg/m3: CalculiX wants a density
THICKNESS, FOOT = 6.35e-3, 12.7e-3
SMALL, LARGE = (0.127, 0.229), (0.330, 0.432)  # along x, y
SHAFTS = {"LOWER": -0.0762, "UPPER": 0.0762}  # y
SHAFT, JOINT = 12.7e-3, 9.525e-3  # diameters
SHAFT_LENGTH, JOINT_LENGTH = 0.381, 12.7e-3
_SAME = 1e-7


@dataclass(frozen=True)
class Grid:
    """Spacing, m: at the footprints and away from them; elements along a shaft and a joint."""

    fine: float = 6.35e-3
    coarse: float = 0.024
    shaft: int = 20
    joint: int = 2
    growth: float = 1.7

    def refined(self):
        """Half the spacing."""
        return Grid(self.fine / 2, self.coarse / 2, 2 * self.shaft, 2 * self.joint, self.growth**0.5)


def free_plate(lengths, rigid, grid):
    """One plate, plain or with its two rigid footprints."""
    deck = Deck(YOUNG, POISSON)
    footprints = _plate(deck, "PLATE", lengths, 0.0, grid)
    if rigid:
        for name, y in SHAFTS.items():
            deck.join((0.0, y, 0.0), footprints[name])
    return deck


def source(grid):
    """Small plate with both shafts."""
    deck = Deck(YOUNG, POISSON)
    _source(deck, grid)
    return deck


def assembly(grid):
    """Small plate, shafts, massless joints and large plate."""
    deck = Deck(YOUNG, POISSON)
    ends = _source(deck, grid)
    top = SHAFT_LENGTH + JOINT_LENGTH
    footprints = _plate(deck, "LARGE", LARGE, top, grid)
    for name, y in SHAFTS.items():
        faces = _bar(deck, f"{name}_JOINT", JOINT, (0.0, y, SHAFT_LENGTH), JOINT_LENGTH, grid.joint, MASSLESS)
        deck.join((0.0, y, SHAFT_LENGTH), ends[name], faces[0])
        deck.join((0.0, y, top), footprints[name], faces[1])
    return deck


def _source(deck, grid):
    footprints = _plate(deck, "SMALL", SMALL, 0.0, grid)
    ends = {}
    for name, y in SHAFTS.items():
        start, ends[name] = _bar(deck, name, SHAFT, (0.0, y, 0.0), SHAFT_LENGTH, grid.shaft, DENSITY)
        deck.join((0.0, y, 0.0), footprints[name], start)
    return ends


def _plate(deck, name, lengths, z, grid):
    """Add a plate centred on the z axis; the nodes of its footprints."""
    half = FOOT / 2 + _SAME
    lines = _lines(lengths[0], [0.0], grid), _lines(lengths[1], SHAFTS.values(), grid)
    part = deck.add(name, plate(*lines, z, THICKNESS), DENSITY)
    return {
        shaft: part.select(lambda x, y, _z, at=at: (abs(x) < half) & (abs(y - at) < half))
        for shaft, at in SHAFTS.items()
    }


def _bar(deck, name, diameter, start, length, elements, density):
    """Add a cylinder; the nodes of its two end faces."""
    part = deck.add(name, round_bar(diameter, start, length, elements), density)
    return [part.select(lambda _x, _y, z, at=at: abs(z - at) < _SAME) for at in (start[2], start[2] + length)]


def _lines(length, centres, grid):
    """Grid lines through the edges of the footprints; one element across each, and growing spacing away from them."""
    stops = [-length / 2, *(at + side * FOOT / 2 for at in centres for side in (-1, 1)), length / 2]
    lines = _towards(stops[1], stops[0], grid)[::-1]
    for low, high in zip(stops[2:-1:2], stops[3:-1:2]):
        middle = (low + high) / 2
        lines += [*_towards(low, middle, grid), *_towards(high, middle, grid)[-2::-1]]
    return np.array([*lines, *_towards(stops[-2], stops[-1], grid)])


def _towards(start, end, grid):
    """From a footprint's edge outwards: the first spacing is the finest."""
    steps = [grid.fine]
    while sum(steps) < abs(end - start):
        steps.append(min(steps[-1] * grid.growth, grid.coarse))
    return list(start + (end - start) * np.cumsum([0.0, *steps]) / sum(steps))
