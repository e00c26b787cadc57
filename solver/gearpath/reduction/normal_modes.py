"""The lowest normal modes of a sparse structure, by inverse iteration with a factor that is there already."""

from collections.abc import Callable
from typing import Any

import numpy as np
import scipy.linalg
import scipy.sparse
import scipy.sparse.linalg

from ..errors import InputError
from ..numerics.arrays import Real

_DENSE = 400  # below so many coordinates all modes cost less than an iteration for some


def lowest_modes(stiffness: Any, mass: Any, flexibility: Callable[[Real], Real], count: int, rigid: int = 0) -> Real:
    """Shapes of the `count` lowest elastic modes, M-orthonormal, (n, count).

    flexibility(F) is the (elastic) flexibility times forces (n, m); `rigid` modes of zero frequency come before.
    Deterministic: fixed starting vector, and the largest entry of every shape is positive. Raises InputError where
    there are not so many modes.
    """
    n = int(mass.shape[0])
    if not 0 <= count <= n - rigid:
        raise InputError(f"{count} normal modes are wanted of a structure that has {n - rigid}; give at most so many")
    if count == 0:
        return np.zeros((n, 0))
    if n <= _DENSE or 3 * count > n:
        K, M = (np.asarray(scipy.sparse.csc_array(matrix).toarray()) for matrix in (stiffness, mass))
        shapes = scipy.linalg.eigh(K, M, subset_by_index=[rigid, rigid + count - 1])[1]
    else:
        inverse = scipy.sparse.linalg.LinearOperator((n, n), matvec=lambda f: flexibility(f.reshape(-1, 1))[:, 0])
        values, shapes = scipy.sparse.linalg.eigsh(
            scipy.sparse.csc_array(stiffness),
            count,
            M=scipy.sparse.csc_array(mass),
            sigma=0.0,
            OPinv=inverse,
            v0=np.cos(1.0 + np.arange(n) ** 2 % 7919),
            tol=1e-10,
        )
        shapes = shapes[:, np.argsort(values)]
    largest = shapes[np.argmax(abs(shapes), axis=0), np.arange(count)]
    return np.asarray(shapes * np.sign(largest))
