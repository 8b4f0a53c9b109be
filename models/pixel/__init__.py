"""One pixel: angular response, weights of the views, flat-field trim, polarization, time of flight."""

from .polarization import transmission
from .quadrature import Ripple, SamplingError, exact, sampling_error
from .response import aperture, response, vignetting
from .table import TableResponse
from .time_of_flight import demodulate, depth_of, phase_of
from .trim import gains, measured_gains, optical_gains, residual
from .weights import view_weights

__all__ = [
    "Ripple",
    "SamplingError",
    "TableResponse",
    "aperture",
    "demodulate",
    "depth_of",
    "exact",
    "gains",
    "measured_gains",
    "optical_gains",
    "phase_of",
    "residual",
    "response",
    "sampling_error",
    "transmission",
    "view_weights",
    "vignetting",
]
