"""What white light costs: pixels of Eq. 3.1 and infinite gratings of SKY130 in light with a spectrum, through a filter
(width in nm) or none. m: of each beta, fitted to the response in this light; d: diattenuation, of Eq. 3.1 the
parameter, of gratings the mean of the three betas. Electrons: of white at 500 lux on a diode, in millions a second.
Light field: `linear` on the motorcycle, with the response of this light and with that of one wavelength (unaware), and
the sum image in every view; psi: mean error on `specular` with this d, and the share of its polarized pixels where it
is reliable (seen)."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from talbot.base.charts import curves
from talbot.imaging.frame.job import golden_result
from talbot.imaging.frame.light_field import estimate
from talbot.imaging.frame.quality import clear_psnr_db
from talbot.imaging.frame.request import FrameRequest, request
from talbot.imaging.polar.measure import POLARIZED, angle_error, estimated
from talbot.models.capture import cells
from talbot.models.parameters import STANDARD, SensorParameters, SpectralParameters, Spectrum, light
from talbot.models.pixel.polarization import angle
from talbot.pixels.designs import IDEAL, gratings
from talbot.pixels.lit import in_light, response_in_light
from talbot.pixels.optics.fit import Fit, fit
from talbot.pixels.tabled import tabled

ENDLESS = "sky130-endless"
WIDTHS = 0, 100, 40  # nm, of the filter in daylight; 0 is none
LAMPS = "led", "d65", "a", "laser:500", "laser:650"
Point = tuple[str, str, int, int]


def points(quick: bool) -> list[Point]:
    """Pixel, light, width of the filter in nm, rows of the array. Lasers are at the pixels' own wavelength."""
    if quick:
        return [(IDEAL, "laser:550", 0, 24), (IDEAL, "d65", 0, 24)]
    lasers = {IDEAL: "laser:550", ENDLESS: "laser:575"}
    each = [(name, 0) for name in LAMPS] + [("d65", width) for width in WIDTHS if width]
    return [(pixel, name, width, 96) for pixel in lasers for name, width in [(lasers[pixel], 0), *each]]


def measure(point: Point) -> dict[str, Any]:
    """Response, light and pictures."""
    pixel, name, width, size = point
    lamp, wavelength = light(name), {IDEAL: 550e-9, ENDLESS: 1e-6 * gratings(ENDLESS).wavelength_um}[pixel]
    spectral = SpectralParameters(filter_wavelength=wavelength, filter_width=1e-9 * width)
    sensor = tabled(replace(STANDARD, spectral=spectral), pixel)
    fits = _fits(lamp, spectral) if pixel == ENDLESS else {}
    types = {kind.beta: kind for kind in in_light(sensor, lamp).tile.types}
    row: dict[str, Any] = {"pixel": pixel, "light": f"{name}, {width} nm" if width else name}
    for beta in (12.0, 18.0, 24.0):
        row[f"m_{beta:g}"] = fits[beta].m if fits else types[beta].m
    d = float(np.mean([one.diattenuation for one in fits.values()])) if fits else sensor.optics.diattenuation
    polar = replace(sensor, optics=replace(sensor.optics, diattenuation=abs(d)))
    settings = {"rows": size, "cols": size, "mode": "raw", "light": name}
    frame = request(**settings, sensor=sensor)
    white = frame.room.white(sensor.array.pitch, sensor.optics.nu_max, spectral=spectral)
    row |= {"d": d, "electrons": 1e-6 * white.electrons} | _field(frame, sensor)
    return row | _polar(request(**settings, sensor=polar, scene="specular"))


def _fits(lamp: Spectrum, spectral: SpectralParameters) -> dict[float, Fit]:
    """Return Eq. 3.1 fitted to the gratings for each beta in this light."""
    chosen = gratings(ENDLESS)
    fits = {}
    for beta, geometry in chosen.geometries.items():
        fits[beta] = fit(response_in_light(geometry, chosen.wavelength_um, lamp, spectral))
    return fits


def _field(frame: FrameRequest, plain: SensorParameters) -> dict[str, float | None]:
    """Return the PSNR of a raw frame's light field, with the response of ``plain``, too, and of its copied sum."""
    result = golden_result(frame)
    seen = cells(result.exposed.scene.views)
    truth = np.asarray(result.exposed.scene.full_light_field, float)[seen]
    known = replace(frame.sensor, tile=plain.tile)
    unaware = replace(result, request=replace(frame, sensor=known))
    fields = {
        "light_field_db": estimate(result, "linear").light_field[seen],
        "unaware_db": estimate(unaware, "linear").light_field[seen],
        "copied_db": np.broadcast_to(result.image, truth.shape),
    }
    return {name: clear_psnr_db(field, truth, result.counted) for name, field in fields.items()}


def _polar(frame: FrameRequest) -> dict[str, float | str]:
    """Return the mean error of psi in degrees where it is reliable, and the share of the polarized pixels that is."""
    result = golden_result(frame)
    polarized, _, over = estimated(result, result.decoded.samples.astype(float))
    s1, s2 = result.exposed.scene.seen_polarization
    shown = (np.hypot(s1, s2) > POLARIZED) & ~over
    seen = shown & (polarized.confidence > 0)
    error = angle_error(polarized.psi, angle(s1, s2), seen)
    return {"psi_deg": "none" if error is None else error, "seen": float(seen.sum() / shown.sum())}


def plot(rows: Sequence[dict[str, Any]]) -> Figure:
    """PSNR of the light field over the mean modulation depth."""
    series: dict[str, list[tuple[float, float, str]]] = {}
    for r in rows:
        depth = float(np.mean([float(r[f"m_{beta}"]) for beta in (12, 18, 24)]))
        series.setdefault(r["pixel"], []).append((depth, float(r["light_field_db"]), r["light"]))
    return curves(series, "mean modulation depth", "PSNR of the light field (dB)", "Light: what its spectrum costs")
