"""Reconstruction of images and light fields from the samples."""

from .demosaic import demosaic, edge_images
from .edges import EdgeOperator, Solver, image_from_edges
from .highlights import without_highlights
from .intensity import FULL, diode_noise, sum_image, sum_noise, white_sum
from .light_field import light_field_estimate
from .polarization import Polarization, demosaiced, polarization, specular_tags
from .psnr import psnr_db, psnr_without_mean_db
from .rebuild import Rebuilt, rebuild

__all__ = [
    "FULL",
    "EdgeOperator",
    "Polarization",
    "Rebuilt",
    "Solver",
    "demosaic",
    "demosaiced",
    "diode_noise",
    "edge_images",
    "image_from_edges",
    "light_field_estimate",
    "polarization",
    "psnr_db",
    "psnr_without_mean_db",
    "rebuild",
    "specular_tags",
    "sum_image",
    "sum_noise",
    "white_sum",
    "without_highlights",
]
