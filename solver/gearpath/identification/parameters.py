"""The unknowns of an identification: upper triangles of K and C of every joint, as coefficients of basis matrices.

    Z(w) = K / (i w) + C,   K = sum_q theta_q E_q,   C = sum_q theta_(m+q) E_q

E_q (n, n) has ones at one entry of one joint's block and its mirror image, so K and C are symmetric and no joint
acts on another.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..numerics.arrays import Complex, Real

_SPARE = 20  # equations more than unknowns: Student's 95 % interval is then 6 % wider than the normal one


@dataclass(frozen=True)
class Unknowns:
    """The entries sought of J joints with n degrees of freedom in all: m of K, then the same m of C."""

    joints: Mapping[str, tuple[str, ...]]  # name -> degrees of freedom
    rows: NDArray[np.intp]  # (m,)
    columns: NDArray[np.intp]  # (m,), not below the row

    @classmethod
    def of(cls, joints: Mapping[str, Sequence[str]]) -> Unknowns:
        """Those of joints by their degrees of freedom, stacked in this order."""
        rows, columns, start = [], [], 0
        for dofs in joints.values():
            i, j = np.triu_indices(len(dofs))
            rows.append(i + start)
            columns.append(j + start)
            start += len(dofs)
        names = {name: tuple(dofs) for name, dofs in joints.items()}
        return cls(names, np.concatenate(rows), np.concatenate(columns))

    @property
    def size(self) -> int:
        """n: degrees of freedom of all joints."""
        return sum(len(dofs) for dofs in self.joints.values())

    @property
    def count(self) -> int:
        """2 m: how many numbers are sought."""
        return 2 * len(self.rows)

    @property
    def least_lines(self) -> int:
        """Lines with enough equations, 2 n^2 real ones each, for the unknowns and for judging the noise."""
        return math.ceil((self.count + _SPARE) / (2 * self.size**2))

    def basis(self) -> Real:
        """E, (m, n, n)."""
        return _basis(self.rows, self.columns, self.size)

    def strangers(self) -> tuple[Real, NDArray[np.intp], NDArray[np.intp]]:
        """Basis matrices of the entries between different joints, (x, n, n), their rows and their columns."""
        owner = np.repeat(np.arange(len(self.joints)), [len(dofs) for dofs in self.joints.values()])
        i, j = np.triu_indices(self.size)
        apart = owner[i] != owner[j]
        return _basis(i[apart], j[apart], self.size), i[apart], j[apart]

    def impedance(self, theta: Real, omega: Real) -> Complex:
        """Z, (F, n, n)."""
        E, m = self.basis(), len(self.rows)
        K, C = np.einsum("q,qab->ab", theta[:m], E), np.einsum("q,qab->ab", theta[m:], E)
        return np.asarray(K / (1j * omega)[:, None, None] + C)

    def split(self, values: Real) -> dict[str, tuple[Real, Real]]:
        """Values of all entries (2 m,) as symmetric matrices of K and of C by joint."""
        full = np.zeros((2, self.size, self.size))
        for half, part in zip(full, values.reshape(2, -1)):
            half[self.rows, self.columns] = half[self.columns, self.rows] = part
        out, start = {}, 0
        for name, dofs in self.joints.items():
            at = slice(start, start + len(dofs))
            out[name] = (full[0, at, at], full[1, at, at])
            start = at.stop
        return out


def _basis(rows: NDArray[np.intp], columns: NDArray[np.intp], size: int) -> Real:
    E = np.zeros((len(rows), size, size))
    q = np.arange(len(rows))
    E[q, rows, columns] = E[q, columns, rows] = 1.0
    return E
