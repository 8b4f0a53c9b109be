"""Light fields with parallax, and depth, from the samples of a frame by Bayes' rule."""

from talbot.models.reconstruct.bayes.estimator import Estimate, FieldEstimator
from talbot.models.reconstruct.bayes.prior import FieldPrior

__all__ = ["Estimate", "FieldEstimator", "FieldPrior"]
