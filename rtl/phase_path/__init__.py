"""PhasePath: four time-of-flight taps to phase and amplitude, between the converters and the encoder."""

from .phase_path_cl import PhasePathCL
from .phase_path_fl import PhasePathFL
from .phase_path_rtl import PhasePath

__all__ = ["PhasePath", "PhasePathCL", "PhasePathFL"]
