"""Where the modulated light of a scene has been before it comes back: straight from a surface, and by other ways."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import ParameterError, check_real

Floats = npt.NDArray[np.floating]
Correlation = Callable[[Floats], Floats]  # from depths in m to what a tap, or a wave, makes of light from there
# From depth in m and disparity of what a view shows, and its offset in steps (dv, du), to the same of all its light
Returned = Callable[[Floats, Floats, float, float], Floats]


@dataclass(frozen=True, eq=False)
class Echo:
    """Transients of a scene.

    A ray's light is its share that comes straight from the surface that the ray meets, and the rest, as a histogram of
    half the path. The histograms are of the middle view, some px apart, and go with the surfaces: what a matt surface
    scatters is the same in all views of a lens.

    Attributes
    ----------
    share : array (views, views, rows, cols)
        Of every ray's light, 0..1: what comes straight.
    late : array (rows', cols', bins)
        Histograms of the rest, 0 or more; each of sum 1, or 0 where there is none: the rest is straight, too.
    start, width : float
        Middle of the first bin, and distance of the bins, 0.0001..1000 m.

    Raises
    ------
    ParameterError
        For a wrong shape or a value out of range.
    """

    share: Floats
    late: Floats
    start: float
    width: float

    def __post_init__(self) -> None:
        if self.share.ndim != 4 or self.late.ndim != 3 or 0 in self.late.shape:
            raise ParameterError(f"echo shapes = {self.share.shape}, {self.late.shape}: must be 4-D and 3-D")
        if not (self.share.min() >= 0 and self.share.max() <= 1 and self.late.min() >= 0 and self.late.max() < np.inf):
            raise ParameterError("echo = out of range: must be shares of 0..1 and histograms of 0 or more")
        check_real("echo start", self.start, 1e-4, 1e3)
        check_real("echo width", self.width, 1e-4, 1e3)
        total = self.late.sum(-1, keepdims=True, dtype=float)
        object.__setattr__(self, "late", np.where(total > 0, self.late / np.where(total > 0, total, 1), 0))

    @property
    def bins(self) -> npt.NDArray[np.float64]:
        """Middle of every bin in m, (bins,)."""
        return self.start + self.width * np.arange(self.late.shape[-1])

    def cropped(self, top: int, left: int, rows: int, cols: int) -> "Echo":
        """Part of the picture.

        top, left, rows, cols: in px, multiples of a histogram's but for the end. Returns Echo: of this size.
        """
        high, wide = self._fine
        near = slice(top // high, -(-(top + rows) // high)), slice(left // wide, -(-(left + cols) // wide))
        return Echo(self.share[:, :, top : top + rows, left : left + cols], self.late[near], self.start, self.width)

    @property
    def _fine(self) -> tuple[int, int]:
        """Px of a histogram along both sides."""
        (rows, cols), (high, wide) = self.share.shape[2:], self.late.shape[:2]
        return -(-rows // high), -(-cols // wide)

    def returned(self, correlation: Correlation) -> Returned:
        """Return the correlation of all light of a view.

        correlation: of depths, whatever their shape. Returns callable: from depth (rows, cols), disparity (rows, cols)
        and offset (dv, du) of a view to the mean of the correlation over its light, (rows, cols).
        """
        other, some = self.late @ np.asarray(correlation(self.bins)), self.late.sum(-1) > 0
        (rows, cols), (high, wide) = self.share.shape[2:], self._fine
        middle = (len(self.share) - 1) / 2

        def _seen(depth: Floats, disparity: Floats, dv: float, du: float) -> Floats:
            straight = correlation(depth)
            y = np.clip(
                np.rint((np.arange(rows)[:, None] + dv * disparity - (high - 1) / 2) / high), 0, self.late.shape[0] - 1
            )
            x = np.clip(np.rint((np.arange(cols) + du * disparity - (wide - 1) / 2) / wide), 0, self.late.shape[1] - 1)
            at = y.astype(int), x.astype(int)
            share = np.where(some[at], self.share[round(dv + middle), round(du + middle)], 1)
            return share * straight + (1 - share) * other[at]

        return _seen
