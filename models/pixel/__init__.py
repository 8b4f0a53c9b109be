"""One pixel: angular response, weights of the views, flat-field trim, polarization, time of flight."""

from talbot.models.pixel.polarization import transmission
from talbot.models.pixel.quadrature import Ripple, SamplingError, exact, sampling_error
from talbot.models.pixel.response import aperture, response, vignetting
from talbot.models.pixel.table import TableResponse
from talbot.models.pixel.time_of_flight import demodulate, depth_of, phase_of
from talbot.models.pixel.trim import gains, measured_gains, optical_gains, residual
from talbot.models.pixel.weights import view_weights

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
