"""Measurements of the pixel at a corner: charge against voltage, whole frames, noise, dark current, mismatch."""

from dataclasses import dataclass
from math import sqrt

import numpy as np

from talbot.base.tools import ToolError
from talbot.cells.corner import Corner
from talbot.models.parameters import ELEMENTARY_CHARGE, AmpTiming, ParameterError
from talbot.models.parameters.electrical import BOLTZMANN
from talbot.pixels.layout.pixel import PixelLayout
from talbot.pixels.pixel_circuit.deck import LINEAR, OPTIONS, Bench, Floats, analyse, pixel_deck, pulses

F_CLK = 10e6  # Hz, of the chip
LEVELS = 0.25, 0.5, 0.75, 0.95  # of the full well, a frame each; a dark one follows the last
RAMP = 1e3  # V/s: slow for all capacitances
NOISE_FROM, NOISE_TO = 30.0, 1e9  # Hz, of the follower's: a frame's rate, beyond the column's band
MIDDLE = 0.05, 0.95  # of the full well, between which linearity counts
DIED = 1e-3  # of the greatest power in an e-fold of the frequency
SETTLED = 1 / 512  # of the full well's swing: half an LSB


@dataclass(frozen=True)
class Characteristic:
    """The read pixel over its whole range: node (V, descending), column (V), charge from the first on (C)."""

    node: Floats
    column: Floats
    charge: Floats

    def at(self, volts: float, of: str) -> float:
        """Value of ``of`` where the node has these volts."""
        return float(np.interp(-volts, -self.node, getattr(self, of)))

    def farads(self, volts: float) -> float:
        """Capacitance of the node."""
        return (self.at(volts - 0.05, "charge") - self.at(volts + 0.05, "charge")) / 0.1


@dataclass(frozen=True)
class PixelFound:
    """A corner. Charges are in electrons, gain in uV an electron at the column.

    reset_v: of the node after a reset, as it is read. full_well: from there to the least voltage of the column.
    capacitance_ff, well_ff: of the node after a reset, and mean over the full well. linearity: greatest deviation from
    a line between 5 and 95 % of the full well, of it. frames: greatest deviation of transients from the characteristic,
    of the full well. lag, lag_soft: what a frame near the full well leaves in the next, of it; with the reset line at
    the supply. reset_noise, reset_closed: simulated, and sqrt(kTC). settling_ns: of the column after `read`.
    C is the node's while the reset line is active. SkyWater's transistors (tnoimod 1) have less noise in a channel
    without a current than 4 k T g, hence less than sqrt(kTC), which counts.
    dark_current: A, at half the full well. gates_ff: of a pixel on its reset line, or on its select line, while active.
    """

    corner: str
    reset_v: float
    full_well: float
    capacitance_ff: float
    well_ff: float
    gain_uv: float
    linearity: float
    frames: float
    lag: float
    lag_soft: float
    reset_noise: float
    reset_closed: float
    read_noise: float
    settling_ns: float
    dark_current: float
    gates_ff: float
    curve: list[list[float]]

    @property
    def dark_noise(self) -> float:
        """Noise of a read against the next reset: both have reset noise, by the closed form, and the follower's."""
        return sqrt(2) * float(np.hypot(self.reset_closed, self.read_noise))


def measure(made: PixelLayout, corner: Corner, bench: Bench) -> PixelFound:
    """Measure the pixel at a corner. Raises ToolError, ParameterError for a pixel without a range."""
    deck = pixel_deck(made, corner, bench)
    found = characteristic(deck, corner, made.process.gate_v)
    reset = float(_frames(deck, corner, made, bench.gate_v, (0.0,))[0][0])
    start, end = found.at(reset, "charge"), float(np.interp(-bench.low_v, -found.column, found.charge))
    if not end > start:
        raise ParameterError(f"low_v = {bench.low_v:g}: must be below the column's {found.at(reset, 'column'):.3f} V")
    full = (end - start) / ELEMENTARY_CHARGE
    charge = np.linspace(start, end, 101)
    column = np.interp(charge, found.charge, found.column)
    inside = slice(*(round(100 * share) for share in MIDDLE))
    slope, offset = np.polyfit(charge[inside], column[inside], 1)
    straight = slope * charge + offset
    electrons = (charge - start) / ELEMENTARY_CHARGE
    middle = float(np.interp(start + (end - start) / 2, found.charge, found.node))
    farads = found.farads(reset - 0.05)
    gain = -slope * ELEMENTARY_CHARGE
    exact, lag, settling = _light(deck, corner, made, bench.gate_v, found, (start, end), LEVELS)
    _, soft, _ = _light(deck, corner, made, corner.supply, found, (start, end), LEVELS[-1:])
    noise, held = _reset_noise(deck, corner, bench.gate_v)
    return PixelFound(
        corner.name,
        reset,
        full,
        1e15 * farads,
        1e15 * (end - start) / (reset - float(np.interp(end, found.charge, found.node))),
        float(1e6 * gain),
        float(np.abs(column - straight)[inside].max() / (column[0] - column[-1])),
        exact,
        lag,
        soft,
        noise * held / ELEMENTARY_CHARGE,
        sqrt(BOLTZMANN * (corner.temperature + 273.15) * held) / ELEMENTARY_CHARGE,
        float(_read_noise(deck, made.process.gate_v, middle) / gain),
        1e9 * settling,
        _dark_current(deck, middle),
        1e15 * _gates(deck, made.process.gate_v, bench.gate_v, reset),
        [[float(a), float(b)] for a, b in zip(electrons[::5], column[::5], strict=True)],
    )


def characteristic(deck: list[str], corner: Corner, gate_v: float) -> Characteristic:
    """Column and charge of a pixel that is read, over its node's voltage, from a slow ramp."""
    top = corner.supply + 0.1
    sources = ["Vrst pixel_reset 0 0", f"Vread read 0 {gate_v:g}", f"Vnode photo_a 0 PWL(0 {top} {top / RAMP:g} 0)"]
    run = f"tran {top / RAMP / 400:g} {top / RAMP:g}"
    time, node, column, current = analyse(
        [*deck, *sources, "Vb photo_b 0 2"], [run], ["time", "v(photo_a)", "v(column_a)", "i(vnode)"]
    )
    current = current + _dark_current(deck, corner.supply / 2)  # the source feeds it all the while
    steps = np.diff(time) * (current[1:] + current[:-1]) / 2
    kept = np.concatenate([[True], np.diff(node) < 0])
    return Characteristic(node[kept], column[kept], np.concatenate([[0.0], np.cumsum(steps)])[kept])


def _frames(
    deck: list[str], corner: Corner, made: PixelLayout, gate_v: float, amperes: tuple[float, ...]
) -> tuple[Floats, Floats, Floats]:
    """Frames one after another, each with its photocurrent: node and column at the samples (V), and settling (s)."""
    t = AmpTiming()
    reset, integrate, read = ((cycles / F_CLK) for cycles in (t.t_reset, t.t_int, t.t_settle + t.t_read))
    period = reset + integrate + read + t.t_guard / F_CLK
    resets, reads, lights = [], [], []
    for k, current in enumerate(amperes):
        begin = k * period
        resets += [(begin, gate_v), (begin + reset, 0.0)]
        reads += [(begin + reset + integrate, made.process.gate_v), (begin + reset + integrate + read, 0.0)]
        lights.append((begin, current))
    lines = [f"Vrst pixel_reset 0 {pulses(resets[1:], gate_v)}", f"Vread read 0 {pulses(reads, 0.0)}"]
    light = pulses(lights[1:], lights[0][1]) if len(lights) > 1 else f"{amperes[0]:g}"
    lines += [f"Ilight photo_a 0 {light}", "Vb photo_b 0 2"]
    end = len(amperes) * period
    time, node, column = analyse(
        [*deck, *lines], [f"tran 0.2u {end:.9g} 0 0.4u"], ["time", "v(photo_a)", "v(column_a)"]
    )
    samples = np.arange(len(amperes)) * period + reset + integrate + read
    values = [np.interp(samples, time, of) for of in (node, column)]
    settling = []
    for sample, value in zip(samples, values[1], strict=True):
        inside = (time > sample - read) & (time < sample)
        late = np.abs(column[inside] - value) > SETTLED * np.ptp(values[1])
        settling.append(float(time[inside][late].max(initial=sample - read) - (sample - read)))
    return values[0], values[1], np.array(settling)


def _light(
    deck: list[str],
    corner: Corner,
    made: PixelLayout,
    gate_v: float,
    found: Characteristic,
    well: tuple[float, float],
    levels: tuple[float, ...],
) -> tuple[float, float, float]:
    """Frames of ``levels`` between dark ones: off the characteristic, of the full well; lag, of the last; settling, s.

    The settling is a dark frame's: in the others light goes on changing the column while it is read.
    """
    t = AmpTiming()
    seconds = (t.t_int + t.t_settle + t.t_read) / F_CLK
    full = well[1] - well[0]
    amperes = (0.0, 0.0, *(share * full / seconds for share in levels), 0.0)
    _, column, settling = _frames(deck, corner, made, gate_v, amperes)
    charge = np.interp(-column, -found.column, found.charge)
    dark, lit, after = charge[1], charge[2:-1], charge[-1]
    wrong = np.abs(lit - dark - np.array(levels) * full).max() / full
    return float(wrong), float(abs(after - dark) / (lit[-1] - dark)), float(settling[1])


def _reset_noise(deck: list[str], corner: Corner, gate_v: float) -> tuple[float, float]:
    """Return noise (V rms) and capacitance (F) of the node while it is reset, with the reset transistor's channel."""
    lines = [f"Vrst pixel_reset 0 {gate_v:g} ac 1", "Vread read 0 0", "Vb photo_b 0 2"]
    deck = [LINEAR if line == OPTIONS else line for line in deck]
    volts = total_noise([*deck, *lines], "noise v(photo_a) Vrst dec 20 1 1e14")
    lines[0] = f"Vrst pixel_reset 0 {gate_v:g}"
    driven = [*deck, *lines, f"Vnode photo_a 0 {corner.supply:g} ac 1"]
    farads = analyse(driven, ["ac lin 1 1e6 1e6"], ["-imag(i(vnode))/(2*pi*1e6)"])
    return volts, float(farads[0, 0])


def _read_noise(deck: list[str], gate_v: float, node_v: float) -> float:
    """Return the noise on the column, V rms, with the node at a voltage: thermal and 1/f of follower and select."""
    lines = ["Vrst pixel_reset 0 0", f"Vread read 0 {gate_v:g}", f"Vnode photo_a 0 {node_v:g} ac 1", "Vb photo_b 0 2"]
    deck = [LINEAR if line == OPTIONS else line for line in deck]
    return total_noise([*deck, *lines], f"noise v(column_a) Vnode dec 20 {NOISE_FROM:g} {NOISE_TO:g}")


def total_noise(deck: list[str], command: str) -> float:
    """Return the total of a noise analysis, V rms. Raises ToolError where ngspice has no numbers.

    ngspice's own sum is not a number for some spectra that are; one is not where it has died away, at the highest
    frequencies, which are left out.
    """
    hertz, volts = analyse(deck, [command, "setplot noise1"], ["frequency", "onoise_spectrum"])
    return summed(hertz, volts)


def summed(hertz: Floats, volts: Floats) -> float:
    """Return the total of a spectrum in V a root hertz, V rms; see `total_noise`."""
    known = int(np.argmin(np.isfinite(volts))) if not np.isfinite(volts).all() else len(volts)
    power = volts[:known] ** 2 * hertz[:known]  # in each e-fold of the frequency
    if known < 2 or (known < len(volts) and power[-1] > DIED * power.max()):
        raise ToolError(f"ngspice: its noise is not a number from {hertz[known]:g} Hz on")
    return float(np.sqrt(np.trapezoid(power, np.log(hertz[:known]))))


def _dark_current(deck: list[str], node_v: float) -> float:
    """A out of a node at a voltage, reset and select off: the junction's, less what the reset transistor leaks in."""
    lines = ["Vrst pixel_reset 0 0", "Vread read 0 0", f"Vnode photo_a 0 {node_v:g}", "Vb photo_b 0 2"]
    return -float(analyse([*deck, *lines], ["op"], ["i(vnode)"])[0, 0])


def _gates(deck: list[str], read_v: float, gate_v: float, node_v: float) -> float:
    """Return the capacitance of a pixel's gates on its reset or select line, the greater, F."""
    deck = [LINEAR if line == OPTIONS else line for line in deck]
    lines = [f"Va photo_a 0 {node_v:g}", f"Vb photo_b 0 {node_v:g}"]
    farads = []
    for rst, rd, source in (f"{gate_v:g} ac 1", "0", "vrst"), ("0", f"{read_v:g} ac 1", "vread"):
        driven = [*deck, *lines, f"Vrst pixel_reset 0 {rst}", f"Vread read 0 {rd}"]
        farads.append(analyse(driven, ["ac lin 1 1e6 1e6"], [f"-imag(i({source}))/(2*pi*1e6)"])[0, 0])
    return float(max(farads))


@dataclass(frozen=True)
class Spread:
    """Pixels with the models' mismatch. offset: V rms of the column in the dark; gain: rms, relative."""

    diodes: int
    offset: float
    gain: float


def spread(made: PixelLayout, corner: Corner, bench: Bench, levels: tuple[float, float], count: int) -> Spread:
    """Columns of ``count`` pixels with their nodes at two levels (V), the dark one first."""
    deck = [line for line in pixel_deck(made, corner, bench, 1) if not line.startswith("Xpixel ")]
    names, lines = [], ["Vrst rst 0 0", f"Vread rd 0 {made.process.gate_v:g}", f"Vnode node 0 {levels[0]:g}"]
    for k in range(count):
        lines.append(f"Xp{k} rst rd ca{k} cb{k} vdda vssa node node pixel")
        for side in "ab":
            names.append(f"v(c{side}{k})")
            lines.append(f"Is{side}{k} c{side}{k} 0 {bench.sink_a:g}")
    found = [analyse([*deck, *lines], [f"alter @vnode[dc] = {level:g}", "op"], names)[:, 0] for level in levels]
    swing = found[0] - found[1]
    return Spread(2 * count, float(found[0].std(ddof=1)), float(swing.std(ddof=1) / swing.mean()))
