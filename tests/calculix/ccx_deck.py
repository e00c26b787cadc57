"""Input decks of CalculiX for natural frequencies, its run and its answer."""

import re
import subprocess
from dataclasses import dataclass, field

import numpy as np

_RIGID = 6  # modes of a free structure without strain
_NEAR = 1e-8  # m: nodes of one part closer than this are one


@dataclass(frozen=True)
class Part:
    """One body of bricks; its nodes are numbered from `first` on."""

    name: str
    nodes: np.ndarray  # (n, 3), m
    bricks: np.ndarray  # (e, 20), rows of nodes
    density: float
    first: int

    def select(self, inside):
        """Numbers of the nodes for which inside(x, y, z) holds."""
        return self.first + np.flatnonzero(inside(*self.nodes.T))


@dataclass
class Deck:
    """Bodies of one elastic constant pair, free in space, and groups of nodes made rigid; SI units.

    Bricks are C3D20R: quadratic, with reduced integration against locking in thin plates.
    """

    youngs_modulus: float
    poisson_ratio: float
    parts: list = field(default_factory=list)
    rigid: list = field(default_factory=list)  # (node numbers, reference point)

    def add(self, name, bricks, density):
        """Add a body of bricks (e, 20, 3), m; nodes at the same place are one within a part, never between parts."""
        points = bricks.reshape(-1, 3)
        _, first, rows = np.unique(np.round(points / _NEAR), axis=0, return_index=True, return_inverse=True)
        part = Part(name, points[first], rows.reshape(-1, 20), density, 1 + self.size)
        self.parts.append(part)
        return part

    def join(self, place, *groups):
        """Make groups of nodes one rigid body that moves with a point at `place`."""
        self.rigid.append((np.concatenate(groups), place))

    @property
    def size(self):
        """Number of nodes, without the two of each rigid body."""
        return sum(len(part.nodes) for part in self.parts)

    @property
    def elements(self):
        """Number of bricks."""
        return sum(len(part.bricks) for part in self.parts)

    def text(self, count):
        """The deck that asks for the lowest `count` natural frequencies, rigid modes included."""
        lines, element = [], 1
        for part in self.parts:
            lines += ["*NODE", *(_node(part.first + k, point) for k, point in enumerate(part.nodes))]
            lines += [f"*ELEMENT, TYPE=C3D20R, ELSET={part.name}"]
            for number, brick in enumerate(part.first + part.bricks, element):
                lines += [_listed([number, *brick[:10]]) + ",", _listed(brick[10:])]
            element += len(part.bricks)
            lines += [f"*MATERIAL, NAME={part.name}", "*ELASTIC", f"{self.youngs_modulus!r}, {self.poisson_ratio!r}"]
            lines += ["*DENSITY", repr(part.density), f"*SOLID SECTION, ELSET={part.name}, MATERIAL={part.name}"]
        for k, (nodes, place) in enumerate(self.rigid):
            reference = 1 + self.size + 2 * k
            lines += ["*NODE", _node(reference, place), _node(reference + 1, place), f"*NSET, NSET=RIGID{k}"]
            lines += [f"{node}," for node in nodes]
            lines += [f"*RIGID BODY, NSET=RIGID{k}, REF NODE={reference}, ROT NODE={reference + 1}"]
        return "\n".join([*lines, "*STEP", "*FREQUENCY", str(count), "*END STEP", ""])

    def frequencies(self, calculix, folder, wanted):
        """Lowest `wanted` elastic natural frequencies, Hz, computed by CalculiX in an empty folder."""
        (folder / "free.inp").write_text(self.text(_RIGID + wanted))
        command = [calculix.program, "free"]
        done = subprocess.run(
            command, cwd=folder, env=calculix.environment(), capture_output=True, text=True, check=False
        )
        answer = folder / "free.dat"
        if done.returncode or "*ERROR" in done.stdout or not answer.exists():
            raise RuntimeError(f"CalculiX ended with code {done.returncode}:\n{done.stdout[-2000:]}{done.stderr}")
        found = read_frequencies(answer.read_text())
        rigid, elastic = found[:_RIGID], found[_RIGID : _RIGID + wanted]
        if len(elastic) < wanted or rigid.max() > 1e-2 * elastic[0]:
            raise RuntimeError(f"CalculiX found {found} Hz, not {_RIGID} rigid modes and {wanted} others")
        return elastic


def read_frequencies(text):
    """Natural frequencies, Hz, from the table of eigenvalues of a .dat file: mode, eigenvalue, rad/s, cycles/s, ..."""
    table = text.split("E I G E N V A L U E   O U T P U T", 1)[1].split("P A R T I C I P A T I O N", 1)[0]
    return np.array([float(row.split()[3]) for row in table.splitlines() if re.match(r"\s*\d+\s", row)])


def _node(number, point):
    return _listed([number, *(repr(round(float(x), 12)) for x in point)])


def _listed(values):
    return ", ".join(map(str, values))
