"""Capture: the light field becomes the samples that the analog front end converts."""

from .expose import Exposure, expose
from .frame import capture, currents, exposed
from .moving import instants, moving_currents
from .operator import CaptureOperator
from .pupil import Region, cells, integrate
from .ratio import capture_ratio
from .views import Views, captured, choose_views

__all__ = [
    "CaptureOperator",
    "Exposure",
    "Region",
    "Views",
    "capture",
    "capture_ratio",
    "captured",
    "cells",
    "choose_views",
    "currents",
    "expose",
    "exposed",
    "instants",
    "integrate",
    "moving_currents",
]
