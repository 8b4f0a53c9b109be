"""The difference amplifier: gain, linearity, settling, ambient light, trim and energy at one corner; its faults.

It has its current from the `bias` of support.py, is off before the cycle in which it wakes, and drives a lane whose
array comes to the output, with what the sample before left on it, after the lane's last decision:

    cycle      | 0      | 1 wake   | 2 hold   | 3 ...
    wake       |________|__/‾‾‾‾‾‾‾|_/________|___        for its energy: reset, and so off, after the hold
    reset      |‾‾‾‾‾‾‾‾|‾‾‾‾‾‾‾‾‾‾|__________|___
    lane       | before            |___/ out  |           sampled at the end of the hold
"""

from dataclasses import dataclass, replace
from math import sqrt

import numpy as np

from talbot.cells.corner import Corner
from talbot.cells.spice.engine import Points, Simulator
from talbot.cells.spice.wave import Wave
from talbot.models.parameters.electrical import BOLTZMANN
from talbot.pixels.circuits.amplifier import PICK, PINS, TRIM_BITS, UNITS, AmplifierSizes, AmplifierSpec, amplifier
from talbot.pixels.circuits.dac import PARASITIC
from talbot.pixels.circuits.lane import LaneSizes
from talbot.pixels.circuits.netlist import Circuit, Instance
from talbot.pixels.circuits.support import bias
from talbot.pixels.datasheet.deck import EDGE, SETTINGS, Setup, deck, settling, simulator

INPUTS = (
    "column_a",
    "column_b",
    "wake",
    "reset",
    "before",
    "last",
    "keep",
    "track",
    *(f"g{k}" for k in range(TRIM_BITS)),
    *PICK,
)
DARK = 0.1  # of a full well, of both diodes
REACH = 0.75  # of +-128 LSB, of differences
AMBIENT = 100  # times the difference
WAKE, HOLD, END, LATER = 1, 2, 3, 5  # cycles: awake, hold, its end; when the output counts as settled
EXACT = replace(SETTINGS, reltol=1e-4)  # at 1e-3 an output is off by up to half an LSB
REST = 0.8  # cycles of rest before it wakes: the chip has six at the least
LANE_OHM = 100.0  # ohm of the lane's switches, all side by side
WAKEN = 1e-9  # s after the hold's begin at which `wake` ends
COLUMNS = 2e-9  # s after the reset's end at which the columns go to their signals
FILLS = 0.05, 0.35, 0.65, 0.95  # of a full well, of a diode that is read alone; the other has the first of them
WRONG_GAIN, WRONG_WEIGHT = 0.1, 0.25  # relative: of the gain, of the trim's least bit; a bit of n units by sqrt(n) less


@dataclass(frozen=True)
class RawResult:
    """A diode that is read alone, in LSB of the lane.

    gain: over the ideal one. inl: peak off a straight line. left: at the cycle's end. other: change by light of the
    other diode.
    """

    gain: float
    inl: float
    left: float
    other: float


@dataclass(frozen=True)
class AmplifierResult:
    """At one corner; LSB of the lane where nothing else is said; of what the lane samples at the end of the hold.

    gain: of the columns' difference, over the ideal one. offset: at no difference. inl: peak off a straight line.
    settling: s after the hold's begin, to half an LSB. left: at its end. ambient: change of a difference under ambient
    light. trim: peak error of three steps around the middle, in steps. energy: J of a sample, with what flows until
    the next and the bias's share. always: J of a sample of an amplifier that is never off. off: A while it is.
    points: (ideal, sampled) of differences. raw: of each diode that is read alone.
    """

    gain: float
    offset: float
    inl: float
    settling: float
    left: float
    ambient: float
    trim: float
    energy: float
    always: float
    off: float
    points: list[tuple[float, float]]
    raw: list[RawResult]
    runs: int
    repeated: int

    def most(self, field: str) -> float:
        """Return a figure of the worse diode in raw mode."""
        return max(getattr(one, field) for one in self.raw)


def measure(
    setup: Setup,
    spec: AmplifierSpec,
    sizes: AmplifierSizes,
    lane: LaneSizes,
    corner: Corner,
    circuit: Circuit | None = None,
) -> AmplifierResult:
    """Measure an amplifier that drives the input of ``lane``. circuit: instead of that of ``sizes``."""
    lsb, load = setup.spec.lsb, load_of(setup, lane, corner)
    most = REACH * 128 * lsb / sizes.gain  # V between the columns
    end = END * spec.hold
    with opened(setup, spec, circuit or amplifier(sizes), corner) as spice:

        def out(a: float, b: float, code: int = UNITS, before: float = 0.0) -> Wave:
            return sample(spice, spec, corner, load, a, b, code, spec.vref + before)

        def sampled(wave: Wave) -> float:
            return (wave.at("lane", end) - spec.vref) / lsb

        low = DARK * spec.swing
        wanted = np.linspace(-1, 1, 5) * most
        before = [-most * sizes.gain if v >= 0 else most * sizes.gain for v in wanted]
        waves = [out(low + max(v, 0.0), low + max(-v, 0.0), before=b) for v, b in zip(wanted, before, strict=True)]
        got = np.array([sampled(wave) for wave in waves])
        slope, offset = np.polyfit(wanted, got, 1)
        left = max(abs(w.at("lane", end) - w.at("lane", LATER * spec.hold)) for w in waves) / lsb
        small = 0.99 * spec.swing / AMBIENT
        bright, dim = (sampled(out(level + small, level)) for level in (0.98 * spec.swing, small))
        steps = [sampled(out(0.5 * spec.swing, 0.5 * spec.swing, UNITS + k)) for k in (-2, -1, 0, 1)]
        step = 0.5 * spec.swing * slope / UNITS
        energy, off = _energy(sample(spice, spec, corner, load, low + most, low, UNITS, spec.vref, True), spec, corner)
        running = waves[-1].charge("vdd", 4 * spec.hold, LATER * spec.hold) / spec.hold
        return AmplifierResult(
            gain=float(slope * lsb / sizes.gain),
            offset=float(offset),
            inl=float(np.abs(got - offset - slope * wanted).max()),
            settling=max(settling(wave, "lane", HOLD * spec.hold, LATER * spec.hold, lsb / 2) for wave in waves),
            left=left,
            ambient=abs(bright - dim),
            trim=float(np.abs(-np.diff(steps) / step - 1).max()),
            energy=energy,
            always=running * corner.supply * spec.sample,
            off=off,
            points=[(float(v * sizes.gain / lsb), float(x)) for v, x in zip(wanted, got, strict=True)],
            raw=[_raw(setup, spec, sizes, corner, load, spice, sub) for sub in (0, 1)],
            runs=spice.runs,
            repeated=spice.repeated,
        )


def _raw(
    setup: Setup, spec: AmplifierSpec, sizes: AmplifierSizes, corner: Corner, load: float, spice: Simulator, sub: int
) -> RawResult:
    """Measure a diode alone; its columns begin at half a full well, the middle of the converter's range."""
    lsb, end = setup.spec.lsb, END * spec.hold

    def sampled(fill: float, other: float = FILLS[0]) -> tuple[float, float]:
        pair = (other, fill) if sub else (fill, other)
        a, b = (one * spec.swing for one in pair)
        before = spec.vref + sizes.gain / 2 * spec.swing * (0.5 - fill)
        wave = sample(spice, spec, corner, load, a, b, UNITS, before, sub=sub)
        return wave.at("lane", end) / lsb, wave.at("lane", LATER * spec.hold) / lsb

    got = np.array([sampled(fill) for fill in FILLS])
    slope, offset = np.polyfit(FILLS, got[:, 0], 1)
    bright = sampled(FILLS[-2], FILLS[-1])[0]
    return RawResult(
        gain=float(slope * lsb / (sizes.gain / 2 * spec.swing)),
        inl=float(np.abs(got[:, 0] - offset - slope * np.array(FILLS)).max()),
        left=float(np.abs(got[:, 0] - got[:, 1]).max()),
        other=float(abs(bright - got[-2, 0])),
    )


def faults(
    setup: Setup,
    spec: AmplifierSpec,
    sizes: AmplifierSizes,
    lane: LaneSizes,
    corner: Corner,
    circuit: Circuit | None = None,
) -> list[str]:
    """Return the faults of an amplifier by part: columns, gain, the weight of every bit of the trim."""
    load, lsb = load_of(setup, lane, corner), setup.spec.lsb
    with opened(setup, spec, circuit or amplifier(sizes), corner) as spice:

        def out(a: float, b: float, code: int) -> float:
            return sample(spice, spec, corner, load, a, b, code, spec.vref).at("lane", END * spec.hold) - spec.vref

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


def load_of(setup: Setup, lane: LaneSizes, corner: Corner) -> float:
    """Return the capacitance of the lane's array, F."""
    return lane.dac.total * setup.scale(corner) * (1 + PARASITIC)


def biased(circuit: Circuit) -> Circuit:
    """Return an amplifier with its bias. Pins: the amplifier's without ibias, then vdd_bias."""
    return Circuit(
        "biased",
        (*(pin for pin in PINS if pin != "ibias"), "vdd_bias"),
        instances=(Instance("amplifier", circuit, PINS), Instance("bias", bias(), ("ibias", "vdd_bias", "vss"))),
    )


def opened(setup: Setup, spec: AmplifierSpec, circuit: Circuit, corner: Corner, seed: int | None = None) -> Simulator:
    """Return an ngspice process of an amplifier with its bias and a lane's array. seed: of the models' mismatch."""
    lines = [*deck(biased(circuit), setup, corner, seed=seed), *to_lane(corner)]
    rails = {"vref": spec.vref, "vdd_bias": corner.supply}
    return simulator(lines, INPUTS, ("out", "lane"), corner, rails, EXACT)


def to_lane(corner: Corner) -> tuple[str, ...]:
    """Lines of the switches of a lane's array."""
    return (
        f".model to_lane sw vt={corner.supply / 2:g} vh=0 ron={LANE_OHM:g} roff=1e12",
        "Strack out lane track 0 to_lane",
        "Skeep lane before keep 0 to_lane",
        "Slast out before last 0 to_lane",
    )


def sample(
    spice: Simulator,
    spec: AmplifierSpec,
    corner: Corner,
    load: float,
    a: float,
    b: float,
    code: int,
    before: float,
    ends: bool = False,
    until: int = LATER,
    sub: int | None = None,
) -> Wave:
    """A transient: a sample of a and b V below the columns' reset level. ends: off after the hold. until: cycles.

    before: V that the sample before left on the lane, and on the amplifier's output until it is off. sub: in raw mode,
    the sub-sample; the columns begin half a full well below their reset level.
    """
    begin = HOLD * spec.hold
    dark = spec.reset_level - (0.0 if sub is None else spec.swing / 2)
    stimulus: dict[str, Points] = {
        f"column_{name}": [(0.0, dark), (begin + COLUMNS, dark), (begin + COLUMNS + 1e-9, spec.reset_level - value)]
        for name, value in (("a", a), ("b", b))
    }
    stimulus |= clocked(spec, corner, begin, code, before, (END * spec.hold + COLUMNS,) if ends else ())
    if sub is not None:
        stimulus |= {"mode1": [(0.0, corner.supply)], "sub0": [(0.0, corner.supply * sub)]}
    return spice.transient(stimulus, {"lane": load}, until * spec.hold, spec.hold / 20)


def clocked(
    spec: AmplifierSpec, corner: Corner, begin: float, code: int, before: float, stop: tuple[float, ...] = ()
) -> dict[str, Points]:
    """All inputs but the columns, of a hold that begins at ``begin`` (s); stop: when it is off after that."""
    vdd, wake = corner.supply, begin - (HOLD - WAKE) * spec.hold

    def level(*changes: float, first: float = 0.0) -> Points:
        points, now = [(0.0, first)], first
        for when in changes:
            points += [(when, now), (when + EDGE, vdd - now)]
            now = vdd - now
        return points

    stimulus: dict[str, Points] = {
        "wake": level(wake + spec.wake, begin + WAKEN),
        "reset": level(begin, *stop, first=vdd),
        "last": level(wake - REST * spec.hold, first=vdd),
        "keep": level(begin + spec.wake, first=vdd),
        "track": level(begin + spec.track, *stop),
        "before": [(0.0, before)],
    }
    stimulus |= {name: [(0.0, 0.0)] for name in PICK}
    return stimulus | {f"g{k}": [(0.0, vdd * (code >> k & 1))] for k in range(TRIM_BITS)}


def _energy(wave: Wave, spec: AmplifierSpec, corner: Corner) -> tuple[float, float]:
    """Return the energy of a sample, J, and currents at rest, A: amplifier, bias, a lane's share of the bias."""
    start, until, last = WAKE * spec.hold, 4 * spec.hold, LATER * spec.hold
    off, rest = (wave.charge(rail, until, last) / (last - until) for rail in ("vdd", "vdd_bias"))
    on = wave.charge("vdd", start, until) + wave.charge("vdd_bias", start, until) - rest * (until - start)
    charge = on + off * (spec.sample - (until - start)) + rest * spec.sample / spec.lanes
    return charge * corner.supply, off
