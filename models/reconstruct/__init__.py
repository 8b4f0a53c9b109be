"""Reconstruction of images and light fields from the samples."""

from .demosaic import demosaic, edge_images
from .edges import EdgeOperator, Solver, image_from_edges
from .intensity import sum_image, white_sum
from .light_field import light_field_estimate
from .psnr import psnr_db, psnr_without_mean_db
from .rebuild import Rebuilt, rebuild

__all__ = [
    "EdgeOperator",
    "Rebuilt",
    "Solver",
    "demosaic",
    "edge_images",
    "image_from_edges",
    "light_field_estimate",
    "psnr_db",
    "psnr_without_mean_db",
    "rebuild",
    "sum_image",
    "white_sum",
]
