"""Reconstruction of images and light fields from the samples."""

from talbot.models.reconstruct.demosaic import demosaic, edge_images
from talbot.models.reconstruct.edges import EdgeOperator, Solver, image_from_edges
from talbot.models.reconstruct.highlights import without_highlights
from talbot.models.reconstruct.intensity import FULL, diode_noise, sum_image, sum_noise, white_sum
from talbot.models.reconstruct.light_field import light_field_estimate
from talbot.models.reconstruct.polarization import Polarization, demosaiced, polarization, specular_tags
from talbot.models.reconstruct.psnr import psnr_db, psnr_without_mean_db
from talbot.models.reconstruct.rebuild import Rebuilt, rebuild
from talbot.models.reconstruct.refocus import all_in_focus, disparity_of, refocus

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
