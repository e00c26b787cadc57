"""Linear algebra across frequency lines: arrays are (..., F), the line last, so that one operation serves all lines."""

import math
from collections.abc import Iterator

import numpy as np

from ..errors import AccuracyError
from ..numerics.arrays import Complex, Real

_BACKWARD_ERROR = 100 * np.finfo(float).eps  # componentwise; lines above it are solved again with pivoting
_CHUNK_BYTES = 12 << 20  # working set of one chunk: large enough that Python's own share is small
_MOST_LINES = 4096


def chunks(lines: int, bytes_per_line: int) -> Iterator[slice]:
    """Slices that cover `lines` frequency lines in pieces whose working set stays bounded."""
    step = int(np.clip(_CHUNK_BYTES // max(bytes_per_line, 1), 8, _MOST_LINES))
    for start in range(0, lines, step):
        yield slice(start, min(start + step, lines))


def real_times_complex(A: Real, x: Complex) -> Complex:
    """A @ x for a real matrix (m, n) and complex lines (n, ...): one real product instead of a complex one."""
    flat = np.ascontiguousarray(x).reshape(x.shape[0], math.prod(x.shape[1:]))
    product = A @ flat.view(np.float64)
    return product.view(np.complex128).reshape(A.shape[0], *x.shape[1:])


def solve_lines(A: Complex, b: Complex) -> Complex:
    """Solve A x = b on every line: A (n, n, F), b (n, m, F), x (n, m, F).

    Elimination without pivoting, vectorised over the lines, then the componentwise backward error
    |b - A x| / (|A| |x| + |b|) of every line; a line that misses it is solved again with pivoting. Raises
    AccuracyError where a line is singular.
    """
    n = len(A)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        # the right-hand sides ride along as columns; one scratch array for every rank-one update
        U = np.concatenate([A, b], axis=1)
        scratch = np.empty_like(U)
        for k in range(n - 1):
            U[k + 1 :, k] /= U[k, k]
            update = np.multiply(U[k + 1 :, k, None], U[k, k + 1 :], out=scratch[k + 1 :, k + 1 :])
            U[k + 1 :, k + 1 :] -= update
        y = U[:, n:].copy()
        for k in reversed(range(n)):
            y[k] /= U[k, k]
            if k:
                y[:k] -= U[:k, k, None] * y[k]
        doubtful = np.flatnonzero(~(_backward_error(A, b, y) < _BACKWARD_ERROR))
    if len(doubtful):
        try:
            pivoted = np.linalg.solve(np.moveaxis(A[..., doubtful], -1, 0), np.moveaxis(b[..., doubtful], -1, 0))
        except np.linalg.LinAlgError as error:
            raise AccuracyError("the coupled system is singular at one of the frequencies") from error
        y[..., doubtful] = np.moveaxis(pivoted, 0, -1)
    return y


def _modulus(x: Complex) -> Real:
    """|re| + |im|: as good as the modulus for a bound, and much cheaper."""
    return np.abs(x.real) + np.abs(x.imag)


def _backward_error(A: Complex, b: Complex, x: Complex) -> Real:
    """Largest componentwise backward error of each line, (F,)."""
    size_A, size_x = _modulus(A), _modulus(x)
    residual, bound = b.copy(), _modulus(b)
    for k in range(len(A)):
        residual -= A[:, k, None] * x[k]
        bound += size_A[:, k, None] * size_x[k]
    error = _modulus(residual)
    return np.asarray(np.max(np.where(error == 0.0, 0.0, error / bound), axis=(0, 1)))
