"""Capture: the light field becomes the samples that the analog front end converts."""

from talbot.models.capture.expose import Exposure, expose
from talbot.models.capture.frame import capture, currents, exposed, full_pixels
from talbot.models.capture.moving import instants, moving_currents
from talbot.models.capture.operator import CaptureOperator
from talbot.models.capture.pupil import Region, cells, integrate
from talbot.models.capture.views import Views, captured, choose_views

__all__ = [
    "CaptureOperator",
    "Exposure",
    "Region",
    "Views",
    "capture",
    "captured",
    "cells",
    "choose_views",
    "currents",
    "expose",
    "exposed",
    "full_pixels",
    "instants",
    "integrate",
    "moving_currents",
]
