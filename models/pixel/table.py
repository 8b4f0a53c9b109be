"""A computed response instead of Eq. 3.1: a table over the angles to a pixel's lines."""

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import ParameterError

if TYPE_CHECKING:
    from scipy.interpolate import RectBivariateSpline

Floats = npt.NDArray[np.floating]


@dataclass(frozen=True, eq=False)
class TableResponse:
    """Response of both diodes of a type, for `PixelType.response`; cubic between angles, held beyond the last.

    along: (n,), angles in rad between the normal and the ray's projection on the plane across the lines, ascending.
    across: (k,), the same in the plane along the lines, ascending from 0; those below 0 have the response of those
        above.
    values: (2, n, k), response of both diodes, 0 or more; 1 is as sensitive as a plain diode on the axis.
    gamma: orientation of the grating in rad.
    source: what made it, as the command line names it.
    """

    along: Floats
    across: Floats
    values: Floats
    gamma: float
    source: str

    def __post_init__(self) -> None:
        shape = (2, self.along.size, self.across.size)
        if self.values.shape != shape:
            raise ParameterError(f"values = array of shape {self.values.shape}: must be {shape}")
        if min(shape[1:]) < 4 or not all((np.diff(axis) > 0).all() for axis in (self.along, self.across)):
            raise ParameterError("along, across = must be at least 4 ascending angles each")
        if not (np.isfinite(self.values).all() and self.values.min() >= 0):
            raise ParameterError("values = must be finite and 0 or more")

    def __call__(self, theta_x: npt.NDArray[np.floating], theta_y: npt.NDArray[np.floating]) -> Floats:
        """Response to rays.

        theta_x, theta_y: (n,), incidence angles in rad, |theta| <= pi/2. Returns (2, n), of both diodes.
        """
        limit = np.pi / 2 - 1e-6  # the tangent of a right angle times a cosine of 0
        x, y = (np.tan(np.clip(theta, -limit, limit)) for theta in (theta_x, theta_y))
        along = np.arctan(x * np.cos(self.gamma) + y * np.sin(self.gamma))
        across = np.abs(np.arctan(y * np.cos(self.gamma) - x * np.sin(self.gamma)))
        along = np.clip(along, self.along[0], self.along[-1])
        across = np.clip(across, self.across[0], self.across[-1])
        return np.maximum([spline.ev(along, across) for spline in self._splines], 0)

    @cached_property
    def _splines(self) -> "list[RectBivariateSpline]":
        from scipy.interpolate import RectBivariateSpline  # imported where it is needed: it is slow

        return [RectBivariateSpline(self.along, self.across, diode) for diode in self.values]
