"""The array types of floors 1 to 4."""

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]
Sparse = csc_array  # of float64
