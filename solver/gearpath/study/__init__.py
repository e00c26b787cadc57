"""Studies of a model: frequency sweeps."""
