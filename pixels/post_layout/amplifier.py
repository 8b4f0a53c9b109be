"""The drawn amplifier and the drawn bias measured as their schematics, and the banks' capacitances by the rays."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from talbot.cells.corner import Corner
from talbot.pixels.analog_layout.cells import Cell
from talbot.pixels.circuits.amplifier import BIAS, TRIM_BITS, AmplifierSizes, AmplifierSpec
from talbot.pixels.circuits.lane import LaneSizes
from talbot.pixels.circuits.netlist import Circuit
from talbot.pixels.circuits.support import SupportSpec, bias
from talbot.pixels.datasheet.amplifier import AmplifierResult
from talbot.pixels.datasheet.amplifier import measure as measure_amplifier
from talbot.pixels.datasheet.deck import Setup
from talbot.pixels.datasheet.support import BiasResult, bias_measured
from talbot.pixels.post_layout.extract import Nets, unit_farad
from talbot.pixels.post_layout.pairs import Pair
from talbot.pixels.post_layout.row import Row
from talbot.platforms.analog import AnalogMasks

UNIT_OFF = 3.0  # %, most, of the drawn unit


@dataclass(frozen=True)
class Amplified:
    """Amplifier and bias at one corner."""

    amplifier: AmplifierResult
    bias: BiasResult


def measure(
    setup: Setup,
    spec: AmplifierSpec,
    sizes: AmplifierSizes,
    lane: LaneSizes,
    corner: Corner,
    amplifier: Circuit | None = None,
    biased: Circuit | None = None,
) -> Amplified:
    """Both at a corner; without circuits the schematics. The amplifier has its current from the bias's schematic."""
    return Amplified(
        measure_amplifier(setup, spec, sizes, lane, corner, amplifier),
        bias_measured(setup, corner, biased or bias(spec.lanes))[0],
    )


def rows(spec: AmplifierSpec, found: Pair[Amplified]) -> Iterator[Row]:
    """Return figures of layout and schematic, with the limits of `make analog`."""
    amplifier, pair = found.of(lambda one: one.amplifier), found.of(lambda one: one.bias).row

    def row(name: str, unit: str, field: str, most: float | None = None, scale: float = 1.0) -> Row:
        return amplifier.row(f"amplifier: {name}", unit, lambda one: scale * getattr(one, field), most)

    yield amplifier.row("amplifier: gain, off by", "%", lambda one: 100 * (one.gain - 1), 100 * spec.gain)
    yield row("offset, systematic", "LSB", "offset")
    yield row("INL", "LSB", "inl", spec.inl)
    yield row("settling to half an LSB", "ns", "settling", 1e9 * spec.hold, 1e9)
    yield row("left after one cycle", "LSB", "left", spec.settling)
    yield row("change under 100 times ambient", "LSB", "ambient", spec.ambient)
    yield row("steps of the trim, off by", "steps", "trim", spec.trim)
    yield row("energy of a sample", "pJ", "energy", 1e12 * spec.energy, 1e12)
    yield row("current while off", "uA", "off", None, 1e6)
    limits = SupportSpec()
    yield pair("bias: current, off by", "%", lambda one: 100 * (one.current / BIAS - 1), 100 * limits.bias)
    yield pair("bias: start", "us", lambda one: 1e6 * one.start, 1e6 * limits.start)
    yield pair("bias: current of the whole", "uA", lambda one: 1e6 * one.idle)


def capacitors(made: Cell, nets: Nets, masks: AnalogMasks, spec: AmplifierSpec) -> Iterator[Row]:
    """Yield the banks' capacitances by the rays: unit, steps of the trim, both inputs."""
    unit = unit_farad(made, nets)
    off = 100 * (unit * masks.fringe_share / made.unit - 1)
    yield Row("amplifier: unit capacitor, off by", "%", 0.0, off, "capacitances", UNIT_OFF)
    weights = np.array([nets.couplings[f"bottom{k}", "xp"] for k in range(TRIM_BITS)]) / unit
    codes = np.arange(1 << TRIM_BITS)
    steps = np.diff((codes[:, None] >> np.arange(TRIM_BITS) & 1) @ weights) - 1
    yield Row(
        "amplifier: DNL of all steps of the trim", "steps", 0.0, float(np.abs(steps).max()), "capacitances", spec.trim
    )
    apart = 1e15 * (nets.totals["xp"] - nets.totals["xm"])
    yield Row("amplifier: input p over input m", "fF", 0.0, apart, "capacitances")
