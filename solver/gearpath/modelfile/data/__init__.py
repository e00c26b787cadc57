"""Files of data beside a model file: matrices, modes and measured frequency responses."""
