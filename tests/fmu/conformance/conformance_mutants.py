"""All faults put into good FMUs: each of these modules adds its own to the list."""

import mutants_of_files  # noqa: F401
import mutants_of_structure  # noqa: F401
import mutants_of_variables  # noqa: F401
from conformance_faults import ALL

__all__ = ["ALL"]
