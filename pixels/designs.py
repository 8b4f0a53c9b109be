"""Gratings of each process for the tile's types: amplitude pixels that `make pixel` finds, at one wavelength each.

Its tests measure them again.
"""

from dataclasses import dataclass
from functools import partial

from talbot.models.parameters import check_choice
from talbot.pixels.optics.geometry import PixelGeometry


@dataclass(frozen=True)
class Gratings:
    """A process's gratings: by the beta that they are for. wavelength_um: of the light."""

    wavelength_um: float
    geometries: dict[float, PixelGeometry]


_sky = partial(PixelGeometry, process="sky130", diffraction="met4")
_ihp = partial(PixelGeometry, process="ihp-sg13g2", diffraction="Metal5")
DESIGNS = {
    "sky130": Gratings(
        0.575,
        {
            12.0: _sky(analyzer="met2", period_um=0.8, shift=0.5),
            18.0: _sky(analyzer="met1", period_um=0.7, fill=0.43, analyzer_fill=0.535),
            24.0: _sky(analyzer="met1", period_um=0.6, analyzer_fill=0.395, shift=0.5),
        },
    ),
    "ihp-sg13g2": Gratings(
        0.65,
        {
            12.0: _ihp(diffraction="Metal4", analyzer="Metal1", period_um=1.16, fill=0.465, shift=0.5),
            18.0: _ihp(analyzer="Metal2", period_um=0.8, analyzer_fill=0.465),
            24.0: _ihp(analyzer="Metal1", period_um=0.8, fill=0.43, analyzer_fill=0.535, shift=0.5),
        },
    ),
}
IDEAL, ENDLESS, RAISED = "ideal", "-endless", "-raised"
DRAWN = ("sky130",)  # whose pixels are drawn and solved as drawn: `models.parameters.drawn_curves`
PIXELS = IDEAL, *DESIGNS, *(name + end for end in (ENDLESS, RAISED) for name in DRAWN)


def gratings(process: str) -> Gratings:
    """Gratings of ``process``, or of a pixel with endless ones or other heights. Raises ParameterError."""
    process = process.removesuffix(ENDLESS).removesuffix(RAISED)
    check_choice("pixel", process, DESIGNS)
    return DESIGNS[process]
