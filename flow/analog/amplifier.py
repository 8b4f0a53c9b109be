"""The difference amplifier: gain, linearity, settling, ambient light, trim and energy at one corner; its faults."""

from dataclasses import dataclass
from math import sqrt

import numpy as np

from talbot.cells.corner import Corner
from talbot.cells.spice.engine import Points, Simulator
from talbot.cells.spice.wave import Wave
from talbot.models.parameters.electrical import BOLTZMANN
from talbot.pixels.circuits.amplifier import BIAS, TRIM_BITS, UNITS, AmplifierSizes, AmplifierSpec, amplifier
from talbot.pixels.circuits.dac import PARASITIC
from talbot.pixels.circuits.lane import LaneSizes
from talbot.pixels.circuits.netlist import Circuit

from .deck import EDGE, Setup, deck, simulator

INPUTS = ("column_a", "column_b", "reset", *(f"g{k}" for k in range(TRIM_BITS)))
DARK = 0.1  # of a full well, of both diodes
REACH = 0.75  # of +-128 LSB, of differences
AMBIENT = 100  # times the difference
RESET, LATER = 1, 4  # cycles of reset, and when the output counts as settled
COLUMNS = 2e-9  # s after the reset's end at which the columns go to their signals
WRONG_GAIN, WRONG_WEIGHT = 0.1, 0.25  # relative: of the gain, of the trim's least bit; a bit of n units by sqrt(n) less


@dataclass(frozen=True)
class AmplifierResult:
    """At one corner; LSB of the lane where nothing else is said.

    gain: of the columns' difference, over the ideal one. offset: at no difference. inl: peak off a straight line.
    settling: s after the columns have their signals, to half an LSB. left: at the end of the hold's cycle. ambient:
    change of a difference under ambient light. trim: peak error of three steps around the middle, in steps. energy: J
    of two cycles.
    """

    gain: float
    offset: float
    inl: float
    settling: float
    left: float
    ambient: float
    trim: float
    energy: float
    runs: int
    repeated: int


def measure(
    setup: Setup,
    spec: AmplifierSpec,
    sizes: AmplifierSizes,
    lane: LaneSizes,
    corner: Corner,
    circuit: Circuit | None = None,
) -> AmplifierResult:
    """Everything of an amplifier that drives the input of ``lane``. circuit: in place of that of ``sizes``."""
    lsb, load = setup.spec.lsb, _load(setup, lane, corner)
    most = REACH * 128 * lsb / sizes.gain  # V between the columns
    with _open(setup, spec, circuit or amplifier(sizes), corner) as spice:

        def out(a: float, b: float, code: int = UNITS) -> Wave:
            return _run(spice, spec, corner, load, a, b, code)

        def settled(wave: Wave) -> float:
            return (wave.at("out", LATER * spec.hold) - spec.vref) / lsb

        low = DARK * spec.swing
        wanted = np.linspace(-1, 1, 5) * most
        waves = [out(low + max(v, 0.0), low + max(-v, 0.0)) for v in wanted]
        got = np.array([settled(wave) for wave in waves])
        slope, offset = np.polyfit(wanted, got, 1)
        left = max(abs(w.at("out", 2 * spec.hold) - w.at("out", LATER * spec.hold)) for w in waves) / lsb
        small = 0.99 * spec.swing / AMBIENT
        bright, dim = (settled(out(level + small, level)) for level in (0.98 * spec.swing, small))
        steps = [settled(out(0.5 * spec.swing, 0.5 * spec.swing, UNITS + k)) for k in (-2, -1, 0, 1)]
        step = 0.5 * spec.swing * slope / UNITS
        return AmplifierResult(
            gain=float(slope * lsb / sizes.gain),
            offset=float(offset),
            inl=float(np.abs(got - offset - slope * wanted).max()),
            settling=max(_settling(wave, spec, lsb / 2) for wave in waves),
            left=left,
            ambient=abs(bright - dim),
            trim=float(np.abs(-np.diff(steps) / step - 1).max()),
            energy=_energy(waves[0], spec, corner.supply),
            runs=spice.runs,
            repeated=spice.repeated,
        )


def faults(
    setup: Setup,
    spec: AmplifierSpec,
    sizes: AmplifierSizes,
    lane: LaneSizes,
    corner: Corner,
    circuit: Circuit | None = None,
) -> list[str]:
    """What is wrong with an amplifier, by the name of the part: columns, gain, the weight of every bit of the trim."""
    load, lsb = _load(setup, lane, corner), setup.spec.lsb
    with _open(setup, spec, circuit or amplifier(sizes), corner) as spice:

        def out(a: float, b: float, code: int) -> float:
            return _run(spice, spec, corner, load, a, b, code).at("out", LATER * spec.hold) - spec.vref

        most = REACH * 128 * lsb / sizes.gain
        zero = out(0.0, 0.0, 0)
        gain = (out(most, 0.0, 0) - zero) / (most * sizes.gain)
        if abs(gain) < WRONG_GAIN:
            return ["amplifier: column_a and column_b: must not be swapped"]
        if abs(gain - 1) > WRONG_GAIN:
            return [f"amplifier: gain of column_a = {gain:.2f} of capacitors a over f: must be 1"]
        ratio = []
        for k in range(TRIM_BITS):
            level = min(spec.swing, most * UNITS / (1 << k))
            ratio.append((zero - out(0.0, level, 1 << k)) / (level * sizes.gain * (1 << k) / UNITS))
    return [
        f"amplifier: capacitor b{k} = {one / np.median(ratio):.2f} of its weight: must be 1"
        for k, one in enumerate(ratio)
        if abs(one / np.median(ratio) - 1) > max(WRONG_WEIGHT / (1 << k) ** 0.5, 0.02)
    ]


def ktc(setup: Setup, sizes: AmplifierSizes, corner: Corner) -> float:
    """Rms of what the reset's end leaves on both inputs, LSB at the output: sqrt(2 k T C) / Cf. C: of one input."""
    unit = sizes.unit * setup.scale(corner)
    total = (2 * UNITS + sizes.feedback) * unit
    kelvin = corner.temperature + 273.15
    return sqrt(2 * BOLTZMANN * kelvin * total) / (sizes.feedback * unit) / setup.spec.lsb


def _open(setup: Setup, spec: AmplifierSpec, circuit: Circuit, corner: Corner) -> Simulator:
    lines = [*deck(circuit, setup, corner), f"Ibias vdd ibias {BIAS:g}"]
    return simulator(lines, INPUTS, ("out",), corner, {"vref": spec.vref})


def _load(setup: Setup, lane: LaneSizes, corner: Corner) -> float:
    """F of the lane's array."""
    return lane.dac.total * setup.scale(corner) * (1 + PARASITIC)


def _run(spice: Simulator, spec: AmplifierSpec, corner: Corner, load: float, a: float, b: float, code: int) -> Wave:
    """A reset and a signal of a and b V below the columns' reset level."""
    start = RESET * spec.hold
    stimulus: dict[str, Points] = {
        f"column_{name}": [
            (0.0, spec.reset_level),
            (start + COLUMNS, spec.reset_level),
            (start + COLUMNS + 1e-9, spec.reset_level - value),
        ]
        for name, value in (("a", a), ("b", b))
    }
    stimulus["reset"] = [(0.0, corner.supply), (start, corner.supply), (start + EDGE, 0.0)]
    stimulus |= {f"g{k}": [(0.0, corner.supply * (code >> k & 1))] for k in range(TRIM_BITS)}
    return spice.transient(stimulus, {"out": load}, LATER * spec.hold, spec.hold / 20)


def _settling(wave: Wave, spec: AmplifierSpec, within: float) -> float:
    """S after the columns' change from which the output stays within so many V of its last value."""
    start = RESET * spec.hold + COLUMNS
    inside = wave.time > start
    out = np.abs(wave.voltage["out"][inside] - wave.at("out", LATER * spec.hold)) > within
    return float(wave.time[inside][out].max(initial=start) - start)


def _energy(wave: Wave, spec: AmplifierSpec, volts: float) -> float:
    """J of a sample: a cycle of reset and one of signal."""
    return wave.charge("vdd", 0.0, 2 * spec.hold) * volts
