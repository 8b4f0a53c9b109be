"""Images and light fields back from the samples."""

from .demosaic import demosaic, edge_images
from .edges import EdgeOperator, Solver, image_from_edges
from .intensity import image_from_sums
from .linear import linear_light_field
from .psnr import psnr_db, psnr_without_mean_db

__all__ = ["EdgeOperator", "Solver", "demosaic", "edge_images", "image_from_edges", "image_from_sums",
           "linear_light_field", "psnr_db", "psnr_without_mean_db"]
