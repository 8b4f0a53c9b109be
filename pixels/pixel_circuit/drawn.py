"""The measurements as calls of a process's name, for jobs: the pixel is drawn again in each."""

from dataclasses import replace
from functools import lru_cache

from talbot.cells.corner import Corner
from talbot.models.parameters import TileParameters
from talbot.pixels.designs import gratings
from talbot.pixels.layout.pixel import PixelLayout, pixel_layout
from talbot.pixels.layout.write import fitted
from talbot.pixels.pixel_circuit.deck import Bench
from talbot.pixels.pixel_circuit.measure import PixelFound, Spread, measure, spread
from talbot.platforms.pixel import pixel_process


@lru_cache(maxsize=4)
def drawn(pdk: str, pitch_um: float) -> PixelLayout:
    """Return a pixel of the tile: the circuit is the same in all. Raises ParameterError."""
    pixel_process(pdk)
    chosen, kind = gratings(pdk), TileParameters().types[0]
    geometry = chosen.geometries[kind.beta]
    return pixel_layout(replace(geometry, pitch_um=pitch_um), kind, fitted(geometry, chosen.wavelength_um))


def measured(pdk: str, corner: Corner, bench: Bench) -> PixelFound:
    """`measure` of the drawn pixel."""
    return measure(drawn(pdk, bench.pitch_um), corner, bench)


def spread_of(pdk: str, corner: Corner, bench: Bench, levels: tuple[float, float], count: int) -> Spread:
    """`spread` of the drawn pixel."""
    return spread(drawn(pdk, bench.pitch_um), corner, bench, levels, count)
