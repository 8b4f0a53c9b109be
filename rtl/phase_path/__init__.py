"""PhasePath: four time-of-flight taps to phase and amplitude, between the converters and the encoder."""

from talbot.rtl.phase_path.phase_path_cl import PhasePathCL
from talbot.rtl.phase_path.phase_path_fl import PhasePathFL
from talbot.rtl.phase_path.phase_path_rtl import PhasePath

__all__ = ["PhasePath", "PhasePathCL", "PhasePathFL"]
