"""Lens, gratings and angular sampling [Jayasuriya2017, Eq. 2.2, 3.1 and 3.3]."""

from dataclasses import dataclass

from talbot.models.parameters.camera import CameraParameters
from talbot.models.parameters.checks import check_int, check_real
from talbot.models.parameters.sources import sourced


@dataclass(frozen=True)
class OpticsParameters:
    """Optics between the scene and the photodiodes.

    Attributes
    ----------
    camera : CameraParameters
        The lens; it accepts |nu| <= camera.nu_max around the chief ray.
    m : float
        Modulation depth, 0..1.
    aperture_sigma : float
        Sigma of the Gaussian common-mode angular response A(theta), 0.01..10 rad.
    vignetting_power : float
        Exponent n of omega = cos(theta)**n, 0..8; 4 is the natural cos^4 law.
    diattenuation : float
        Diattenuation d of the gratings as a weak polarizer, 0..1 (extinction ratio 2 is d = 1/3).
    views : int
        Views along each axis of the light field, 1..31.
    subsamples : int
        Gauss-Legendre nodes along each axis of a view's angular cell, 1..64.

    References
    ----------
    [Jayasuriya2017], Sec. 3.5.1 (f/1.2), Eq. 3.1 and Ch. 4.
    """

    camera: CameraParameters = CameraParameters()
    m: float = sourced(0.7, "assumed")
    aperture_sigma: float = sourced(0.2, "assumed", "rad")
    vignetting_power: float = sourced(4.0, "the natural cos^4 law")
    diattenuation: float = sourced(1 / 3, "[Jayasuriya2017], Ch. 4: extinction ratio 2")
    views: int = sourced(5, "[Jayasuriya2017], Sec. 3.5.1")
    subsamples: int = sourced(8, "our choice")

    def __post_init__(self) -> None:
        check_real("m", self.m, 0, 1)
        check_real("aperture_sigma", self.aperture_sigma, 0.01, 10)
        check_real("vignetting_power", self.vignetting_power, 0, 8)
        check_real("diattenuation", self.diattenuation, 0, 1)
        check_int("views", self.views, 1, 31)
        check_int("subsamples", self.subsamples, 1, 64)

    @property
    def nu_max(self) -> float:
        """Largest accepted relative two-plane coordinate nu, the tangent against the chief ray."""
        return self.camera.nu_max
