"""What pythonfmu imports first: checks for numpy and scipy, then hands over to the slave.

`gearpath_bundle` and `GearpathFmu` are replaced by names that no other FMU has.
"""

import ctypes
import os
import sys

# OpenBLAS reads this once, when it is loaded. One thread is faster for the small systems here, and with several a
# process that loads scipy from within an FMU sometimes aborts when it exits ("corrupted double-linked list").
own_choice = os.environ.get("OPENBLAS_NUM_THREADS")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
try:
    import numpy  # noqa: F401
    import scipy.linalg  # noqa: F401
except ImportError as problem:
    message = (
        f"This FMU needs numpy and scipy in the Python {sys.version.split()[0]} that runs it "
        f"({sys.executable}): {problem}. Run: python -m pip install numpy scipy"
    )
    print(message, file=sys.stderr)  # pythonfmu passes nothing on where logging is off
    raise ImportError(message) from problem
finally:
    if own_choice is None:
        del os.environ["OPENBLAS_NUM_THREADS"]

from gearpath_bundle.fmu.slave import GearpathSlave  # noqa: E402


class GearpathFmu(GearpathSlave):
    """The class that pythonfmu looks for."""


# For every instance pythonfmu's native part runs this file once more and then drops a reference to the
# module's dictionary that it does not own; without this line the second instance ends the process.
if locals() is not globals():
    ctypes.pythonapi.Py_IncRef(ctypes.py_object(globals()))
