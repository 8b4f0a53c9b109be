"""The lens in front of the sensor: one object for disparity, angles, vignetting, chief rays and time of flight.

A thin lens with a stop whose image is the exit pupil. Distances to the scene are measured from the entrance pupil, the
centre of projection. With q = f**2 / focus, Newton's equations give the distance of the image beyond the rear focus

    x = 2 q / (1 + sqrt(1 - 4 q / exit_pupil))
    magnification = x / f          principal distance c = f / (1 - x / exit_pupil)

A pixel at X sees the field under the tangent X / c, and the pupil as the disc |nu| <= f / (2 N c) around its chief ray,
whose tangent is X / exit_pupil. At depth z the ray nu meets a surface where the chief ray of a pixel at
X + c**2 nu (1/z - 1/focus) does.

An exit pupil at infinity (telecentric: the stop is in the front focal plane) has c = f, |nu| <= 1 / (2 N) and no
chief-ray angle. An exit pupil at the lens itself is the textbook's thin lens with c = f focus / (focus - f).
"""

from dataclasses import dataclass
from math import sqrt

from talbot.models.parameters.checks import check_real
from talbot.models.parameters.sources import sourced

FOCUS_MAX = 1000.0  # m: represents infinity


@dataclass(frozen=True)
class CameraParameters:
    """A thin lens, focused, and the scale of the scene before it.

    Attributes
    ----------
    f_number : float
        Focal length over the diameter of the entrance pupil, 0.5..32.
    focal_length : float
        1e-4..1 m.
    focus : float
        Depth of the focal plane from the entrance pupil, focal_length..1000 m.
    scale : float
        The scene is a model at 1:scale, 0.001..1e4.
    exit_pupil : float or None
        Distance of the exit pupil from the sensor, 4 focal_length**2 / focus..1000 m; None is telecentric.

    References
    ----------
    [Jayasuriya2017], Sec. 3.5.1, has f/1.2; each field has its source.
    """

    f_number: float = sourced(1.2, "[Jayasuriya2017], Sec. 3.5.1")
    focal_length: float = sourced(7.96e-3, "our choice: 384 pixels see 480 of the motorcycle pair's", "m")
    focus: float = sourced(0.207, "our choice: 3 m of the scene", "m")
    scale: float = sourced(14.5, "our choice: the lens sees half the disparity of the pair's baseline")
    exit_pupil: float | None = sourced(None, "assumed: telecentric", "m")

    def __post_init__(self) -> None:
        check_real("f_number", self.f_number, 0.5, 32)
        check_real("focal_length", self.focal_length, 1e-4, 1)
        check_real("focus", self.focus, self.focal_length, FOCUS_MAX)
        check_real("scale", self.scale, 1e-3, 1e4)
        if self.exit_pupil is not None:
            check_real("exit_pupil", self.exit_pupil, 4 * self.focal_length**2 / self.focus, 1000)

    @property
    def pupil_power(self) -> float:
        """Inverse distance of the exit pupil from the sensor in 1/m; 0 is telecentric."""
        return 0.0 if self.exit_pupil is None else 1 / self.exit_pupil

    @property
    def extension(self) -> float:
        """Distance of the image beyond the rear focus in m."""
        q = self.focal_length**2 / self.focus
        # The checked range ends where the root is 0; rounding may pass it.
        return 2 * q / (1 + sqrt(max(1 - 4 * q * self.pupil_power, 0.0)))

    @property
    def magnification(self) -> float:
        """Size of the image over that of the model in focus."""
        return self.extension / self.focal_length

    @property
    def principal_distance(self) -> float:
        """Distance c from pixels to angles in the scene: metres on the sensor over the tangent."""
        return self.focal_length / (1 - self.extension * self.pupil_power)

    @property
    def aperture(self) -> float:
        """Diameter of the entrance pupil in m."""
        return self.focal_length / self.f_number

    @property
    def nu_max(self) -> float:
        """Largest accepted tangent nu against the chief ray."""
        return self.aperture / (2 * self.principal_distance)


# 25 mm at 3 m: disparities of more than a pixel from 2.2 to 4.6 m, for time of flight
LIFE_SIZE = CameraParameters(focal_length=25e-3, focus=3.0, scale=1.0)
