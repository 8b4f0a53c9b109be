"""Lens, gratings and angular sampling [Jayasuriya2017, Eq. 2.2, 3.1 and 3.3]."""

from dataclasses import dataclass

from .checks import check_int, check_real


@dataclass(frozen=True)
class OpticsParameters:
    """What light meets before the photodiodes.

    f_number: 0.5..32; the lens accepts |nu| <= 1 / (2 f_number) (Sec. 3.5.1: f/1.2).
    m: modulation depth, 0..1.
    aperture_sigma: sigma of the Gaussian common-mode angular response A(theta), 0.01..10 rad.
    vignetting_power: exponent n of omega = cos(theta)**n, 0..8; 4 is the natural cos^4 law.
    diattenuation: d of the gratings as a weak polarizer, 0..1 (extinction ratio 2, Ch. 4).
    views: views along each axis of the light field, 1..31.
    subsamples: Gauss-Legendre nodes along each axis of a view's angular cell, 1..64.
    """

    f_number: float = 1.2
    m: float = 0.7
    aperture_sigma: float = 0.2
    vignetting_power: float = 4.0
    diattenuation: float = 1 / 3
    views: int = 5
    subsamples: int = 8

    def __post_init__(self):
        check_real("f_number", self.f_number, 0.5, 32)
        check_real("m", self.m, 0, 1)
        check_real("aperture_sigma", self.aperture_sigma, 0.01, 10)
        check_real("vignetting_power", self.vignetting_power, 0, 8)
        check_real("diattenuation", self.diattenuation, 0, 1)
        check_int("views", self.views, 1, 31)
        check_int("subsamples", self.subsamples, 1, 64)

    @property
    def nu_max(self):
        """Largest accepted relative two-plane coordinate nu = tan(theta)."""
        return 1 / (2 * self.f_number)
