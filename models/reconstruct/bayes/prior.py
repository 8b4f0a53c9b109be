"""The prior of a light field: planes of random texture, each at one disparity."""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import ParameterError, check_int, check_real

Floats = npt.NDArray[np.float64]
NOISE_MAX = 10.0  # of white: with more the samples say nothing
CLEAR = 0.006  # of white: noise beyond which evidence is pooled more widely
LAG = 4  # px between pixels whose sums tell a frame's contrast
ABOVE = 2.0  # times it: a window may have more than the frame has on the average
STEPS = 4  # halves of an octave by which a frame's contrast may be below the prior's: estimators are kept by prior


@dataclass(frozen=True)
class FieldPrior:
    """Gaussian prior of a window of the light field, given its disparity, and the disparities that are tried.

    level: standard deviation of a window's mean radiance, 0.01..100.
    contrast: standard deviation of the radiance within, 0.001..100.
    length: distance at which its correlation falls to 1/e, 0.1..1000 px.
    fineness: exponent of the distance there, 0.1..2: the less, the more fine texture.
    noise: standard deviation of a sample, of white = 1: 1e-5..10.
    far, near: ends of the disparities in px per view step, -20..20.
    disparities: how many are tried from far to near, 1..500.
    between: more that the mixture tries between each two of these, 0..3.
    slants: slants of planes that the mixture tries at most, 0..32, in addition to planes that face the camera.
    margin: pixels around a block that its estimate uses, 0..16.
    trust: share of the evidence for a disparity that counts, 0.001..1: a scene is not the prior's texture.
    pool: standard deviation of the weights around a pixel with which its neighbours' evidence counts, 0.1..100 px, up
        to a noise of `CLEAR`.
    plain: windows that differ from a uniform one by less than this, times the noise's variance, take the linear
        estimate, 0..1000: no disparity shows in them.

    Source: [Levin2008].
    """

    level: float = 0.5
    contrast: float = 0.25
    length: float = 30.0
    fineness: float = 0.75
    noise: float = CLEAR
    far: float = -2.5
    near: float = 2.5
    disparities: int = 21
    between: int = 1
    slants: int = 8
    margin: int = 4
    trust: float = 0.25
    pool: float = 2.5
    plain: float = 1.25

    def __post_init__(self) -> None:
        check_real("level", self.level, 0.01, 100)
        check_real("contrast", self.contrast, 1e-3, 100)
        check_real("length", self.length, 0.1, 1000)
        check_real("fineness", self.fineness, 0.1, 2)
        check_real("noise", self.noise, 1e-5, NOISE_MAX)
        check_real("far", self.far, -20, 20)
        check_real("near", self.near, -20, 20)
        check_int("disparities", self.disparities, 1, 500)
        check_int("between", self.between, 0, 3)
        check_int("slants", self.slants, 0, 32)
        check_int("margin", self.margin, 0, 16)
        check_real("trust", self.trust, 1e-3, 1)
        check_real("pool", self.pool, 0.1, 100)
        check_real("plain", self.plain, 0, 1000)
        if self.far > self.near:
            raise ParameterError(f"near = {self.near:g}: must be in [{self.far:g}, 20], far and more")

    @property
    def grid(self) -> Floats:
        """The disparities that are tried, (disparities,), from far to near."""
        return np.linspace(self.far, self.near, self.disparities)

    @property
    def fine(self) -> Floats:
        """Disparities that the mixture tries: `grid` and points between."""
        return np.linspace(self.far, self.near, (self.disparities - 1) * (self.between + 1) + 1)

    @property
    def fine_step(self) -> float:
        """The step between two of these; 1 for a single one."""
        return (self.near - self.far) / (len(self.fine) - 1) if len(self.fine) > 1 else 1.0

    @property
    def width(self) -> float:
        """The pool's standard deviation in px at this noise: wider where a pixel tells less; by leaves and a room."""
        return self.pool * max(self.noise / CLEAR, 1) ** (2 / 3)

    def contrast_of(self, sums: npt.NDArray[np.floating], noise: float) -> float:
        """Contrast for a frame: this prior's, or less where the frame has little, in half octaves.

        sums: (rows, cols), mean of both diodes of every pixel, 1 = white. noise: standard deviation of a diode. Returns
        a quarter of `contrast` at the least: noise is then not taken for a texture's parallax.
        """
        squares = [np.square(part[LAG:] - part[:-LAG]).ravel() for part in (sums, sums.T) if len(part) > LAG]
        if not squares:
            return self.contrast
        variance = max(float(np.concatenate(squares).mean()) - noise**2, 0.0)
        same, away = self.covariance(np.zeros(2), np.array([0.0, LAG]))
        share = ABOVE * math.sqrt(variance / (2 * (same - away)))
        below = min(max(round(-2 * math.log2(share)), 0), STEPS) if share > 0 else STEPS
        return self.contrast * 2.0 ** (-below / 2)

    def covariance(self, dy: Floats, dx: Floats) -> Floats:
        """Covariance of two points of a plane.

        dy, dx: their distance in px; broadcastable. Returns float64 array: of the common shape.
        """
        return self.contrast**2 * np.exp(-((np.hypot(dy, dx) / self.length) ** self.fineness)) + self.level**2
