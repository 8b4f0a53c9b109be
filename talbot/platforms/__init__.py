"""The processes: layers, coefficients, device models and paths into a PDK are described here and nowhere else."""
