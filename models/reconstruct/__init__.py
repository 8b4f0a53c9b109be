"""Reconstruction of images and light fields from the samples."""

from .demosaic import demosaic, edge_images
from .edges import EdgeOperator, Solver, image_from_edges
from .highlights import without_highlights
from .intensity import FULL, diode_noise, sum_image, sum_noise, white_sum
from .light_field import light_field_estimate
from .polarization import Polarization, demosaiced, polarization, specular_tags
from .psnr import psnr_db, psnr_without_mean_db
from .rebuild import Rebuilt, rebuild
from .refocus import all_in_focus, disparity_of, refocus

__all__ = [
    "FULL",
    "EdgeOperator",
    "Polarization",
    "Rebuilt",
    "Solver",
    "all_in_focus",
    "demosaic",
    "demosaiced",
    "diode_noise",
    "disparity_of",
    "edge_images",
    "image_from_edges",
    "light_field_estimate",
    "polarization",
    "psnr_db",
    "psnr_without_mean_db",
    "rebuild",
    "refocus",
    "specular_tags",
    "sum_image",
    "sum_noise",
    "white_sum",
    "without_highlights",
]
