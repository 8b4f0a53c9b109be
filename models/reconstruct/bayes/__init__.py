"""Light fields with parallax, and depth, from the samples of a frame by Bayes' rule."""

from .estimator import Estimate, FieldEstimator
from .prior import FieldPrior

__all__ = ["Estimate", "FieldEstimator", "FieldPrior"]
