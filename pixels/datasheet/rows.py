"""The rows of the datasheet, with limits from the specifications."""

from collections.abc import Sequence

import numpy as np

from talbot.models.parameters import STANDARD, SensorParameters
from talbot.pixels.circuits.amplifier import BIAS, AmplifierSpec
from talbot.pixels.circuits.column_sizes import ColumnSpec
from talbot.pixels.circuits.interface import STROBE
from talbot.pixels.circuits.row_driver import RowDriverSpec
from talbot.pixels.circuits.specification import LaneSpec
from talbot.pixels.circuits.support import SupportSpec
from talbot.pixels.datasheet.comparator import interval
from talbot.pixels.datasheet.datasheet import Row, over_corners
from talbot.pixels.datasheet.found import TYPICAL, Found
from talbot.pixels.datasheet.lane import VALUE, inl
from talbot.pixels.datasheet.row_driver import RowDriverResult
from talbot.pixels.datasheet.supply import RIPPLE
from talbot.pixels.datasheet.support import SupportResult


def datasheet(spec: LaneSpec, found: Found, draws: int, sensor: SensorParameters = STANDARD) -> list[Row]:
    """Return the rows, with limits from the specification."""
    half, share = 1e9 * spec.half_cycle, 1e12 * spec.decision_energy
    rms, low, high = interval(found.offsets)

    def corners(circuit: str, name: str, unit: str, values: dict[str, float], most: float | None) -> Row:
        return over_corners(circuit, name, unit, values.items(), TYPICAL, most=most)

    decisions, results = found.decisions, found.lanes
    energies = {name: 1e12 * sum(one.energy.values()) for name, one in results.items()}
    shapes = {name: inl(one.levels) for name, one in results.items()}
    decided = {name: max(abs(off) for _, off in one.decided) for name, one in results.items()}
    wrong = {name: float(not one.right) for name, one in decisions.items()}
    missed = {name: float(abs(one.code - round(VALUE))) for name, one in results.items()}
    over = f"{draws} draws: 95 % interval"
    arrays = f"{len(found.inl)} drawn arrays; max: 3 sigma in the middle 99.7 %"
    noise = found.noise
    return [
        corners("comparator", "decision, half an LSB", "ns", {n: 1e9 * d.delay for n, d in decisions.items()}, half),
        corners("comparator", "wrong decisions", "", wrong, 0.0),
        corners(
            "comparator",
            "energy of a decision",
            "pJ",
            {n: 1e12 * d.energy for n, d in decisions.items()},
            share * spec.comparator_share,
        ),
        Row("comparator", "offset, rms", "LSB", rms, low, high, most=spec.offset, over=over, draws=draws),
        Row("comparator", "noise, rms", "LSB", noise.rms, None, noise.high, most=spec.noise, over="95 % interval"),
        corners("DAC", "settling to half an LSB", "ns", {n: 1e9 * r.settling for n, r in results.items()}, half),
        corners("DAC", "INL, schematic", "LSB", {n: s[2] for n, s in shapes.items()}, spec.inl),
        _quantile("DAC", "INL, mismatch", found.inl, spec.inl, arrays),
        _quantile("DAC", "DNL, mismatch", found.dnl, spec.dnl, arrays),
        corners("lane", "offset, systematic", "LSB", {n: abs(s[0]) for n, s in shapes.items()}, spec.offset),
        corners("lane", "gain error over the range", "LSB", {n: abs(s[1]) for n, s in shapes.items()}, None),
        corners("lane", "decisions off their level", "LSB", decided, spec.inl),
        corners("lane", "sampled noise, rms", "LSB", found.ktc, spec.ktc),
        corners("lane", "droop in a conversion", "LSB", {n: r.droop for n, r in results.items()}, spec.droop),
        corners("lane", f"conversion of {VALUE:g}, off by", "codes", missed, 0.0),
        Row(
            "lane",
            "ENOB of a sine",
            "bit",
            float(np.median(found.enob)),
            float(min(found.enob)),
            float(max(found.enob)),
            least=spec.enob,
            over=f"{len(found.enob)} drawn arrays, with noise",
        ),
        corners("lane", "energy of a decision", "pJ", energies, share),
        *_timing(found, spec, AmplifierSpec.of(sensor)),
        *_amplifier(found, AmplifierSpec.of(sensor)),
        *_columns(found, ColumnSpec.of(sensor)),
        *_row_driver(found.rows, RowDriverSpec.of(sensor)),
        *_support(found.supports),
    ]


def _timing(found: Found, spec: LaneSpec, amplifier: AmplifierSpec) -> list[Row]:
    """Return the rows of the lanes' timing and of their shared references."""

    def row(circuit: str, name: str, unit: str, values: dict[str, float], **limits: float) -> Row:
        return over_corners(circuit, name, unit, values.items(), TYPICAL, **limits)

    def of(field: str, scale: float) -> dict[str, float]:
        return {corner: scale * getattr(one, field) for corner, one in found.interfaces.items()}

    def shared(field: str, scale: float = 1.0) -> dict[str, float]:
        return {corner: scale * getattr(one, field) for corner, one in found.references.items()}

    early = {name: 1e9 * (one.first - found.lanes[name].settling) for name, one in found.interfaces.items()}
    decided = {name: 1e9 * (one.decided - found.decisions[name].delay) for name, one in found.interfaces.items()}
    return [
        row("interface", "strobe after the clock's rise, duty 20 to 80 %", "ns", of("last", 1e9), most=1e9 * STROBE),
        row("interface", "strobe after the DAC's settling", "ns", early, least=0.0),
        row("interface", "sample after the last decision", "ns", decided, least=0.0),
        row("interface", "sample after the clock's rise", "ns", of("sample", 1e9), most=1e9 * amplifier.track),
        row("interface", "energy of a strobe", "pJ", of("energy", 1e12)),
        row("interface", "energy of a cycle without convert", "pJ", of("idle", 1e12)),
        row("references", "levels of eight lanes, off by", "LSB", shared("off"), most=spec.settling),
        row("references", "settling of eight lanes to half an LSB", "ns", shared("settling", 1e9)),
        row("references", "refp less refn, end to end", "mV", shared("ripple", 1e3)),
    ]


def _amplifier(found: Found, spec: AmplifierSpec) -> list[Row]:
    """Return the rows of the difference amplifier."""

    def corners(name: str, unit: str, values: dict[str, float], most: float | None) -> Row:
        return over_corners("amplifier", name, unit, values.items(), TYPICAL, most=most)

    def row(name: str, unit: str, field: str, most: float | None, scale: float = 1.0) -> Row:
        values = {corner: scale * abs(getattr(one, field)) for corner, one in found.amplifiers.items()}
        return corners(name, unit, values, most)

    def raw(field: str) -> dict[str, float]:
        return {corner: one.most(field) for corner, one in found.amplifiers.items()}

    raw_gains = {n: 100 * max(abs(d.gain - 1) for d in one.raw) for n, one in found.amplifiers.items()}
    count = len(found.amplifier_draws)
    over = f"{count} draws: 95 % interval"
    offset, *offset_ends = interval([one.offset for one in found.amplifier_draws])
    gain, *gain_ends = interval([100 * one.gain for one in found.amplifier_draws])
    rippled = {corner: RIPPLE / LaneSpec().lsb * max(one.gain) for corner, one in found.ripples.items()}
    gains = {corner: 100 * abs(one.gain - 1) for corner, one in found.amplifiers.items()}
    return [
        corners("gain, off by", "%", gains, 100 * spec.gain),
        row("offset, systematic", "LSB", "offset", None),
        Row("amplifier", "offset, rms", "LSB", offset, *offset_ends, most=spec.offset, over=over, draws=count),
        Row("amplifier", "gain, spread", "%", gain, *gain_ends, over=over, draws=count),
        row("INL", "LSB", "inl", spec.inl),
        row("settling to half an LSB", "ns", "settling", 1e9 * spec.hold, 1e9),
        row("left after one cycle", "LSB", "left", spec.settling),
        row("change under 100 times ambient light", "LSB", "ambient", spec.ambient),
        row("steps of the trim, off by", "steps", "trim", spec.trim),
        corners("kT/C, rms", "LSB", found.amplifier_ktc, spec.ktc),
        Row("amplifier", "noise, rms", "LSB", found.amplifier_noise.total, None, None, most=spec.noise, over=TYPICAL),
        corners(f"by {1e3 * RIPPLE:g} mV on the supply, 10 kHz to 1 GHz", "LSB", rippled, spec.settling),
        corners("raw mode, gain off by", "%", raw_gains, 100 * spec.gain),
        corners("raw mode, INL", "LSB", raw("inl"), spec.inl),
        corners("raw mode, left after one cycle", "LSB", raw("left"), spec.settling),
        corners("raw mode, by the other diode's light", "LSB", raw("other"), spec.settling),
        row("energy of a sample, off between samples", "pJ", "energy", 1e12 * spec.energy, 1e12),
        row("energy of a sample, never off", "pJ", "always", None, 1e12),
        row("current while off", "uA", "off", None, 1e6),
    ]


def _columns(found: Found, spec: ColumnSpec) -> list[Row]:
    """Return the rows of a column; LSB are those of the lane's converter in edge mode."""

    def row(
        name: str, unit: str, values: dict[str, float], most: float | None = None, least: float | None = None
    ) -> Row:
        return over_corners("column", name, unit, values.items(), TYPICAL, least, most)

    def each(field: str, scale: float = 1.0) -> dict[str, float]:
        return {corner: scale * getattr(one, field) for corner, one in found.columns.items()}

    slopes = {corner: 100 * max(abs(one.slope - 1), abs(one.mean - 1)) for corner, one in found.columns.items()}
    names = "offset of a difference, rms", "offset by a pixel's switches, rms"
    drawn = zip(names, (found.column_offsets, found.pixel_offsets), (spec.offset, None), strict=True)
    left, settled = ({n: getattr(one, f) for n, one in found.turns.items()} for f in ("left", "settling"))
    return [
        row("slope, off by", "%", slopes, 100 * spec.slope),
        row("slope of a diode", "", each("slope")),
        row("slope of both diodes' mean", "", each("mean")),
        row("INL", "LSB", each("inl"), spec.inl),
        row("lost at 98 % of a full well", "LSB", each("full")),
        row("by the other diode's light", "LSB", each("other"), spec.settling),
        row("settling to half an LSB", "ns", each("settling", 1e9), 1e9 * spec.cycle),
        row("turn, left at the lane after one cycle", "LSB", left, spec.settling),
        row("turn, at the lane to half an LSB", "ns", {n: 1e9 * one for n, one in settled.items()}),
        row("droop until the last column's turn", "LSB", each("droop"), spec.droop),
        row("noise of a diode, closed form", "e", found.column_noise, spec.noise),
        *(
            Row("column", name, "LSB", *interval(of), most=most, over=f"{len(of)} draws: 95 % interval", draws=len(of))
            for name, of, most in drawn
        ),
        row("energy of a pixel", "pJ", each("energy", 1e12), 1e12 * spec.energy),
        row("current of a column at rest", "nA", each("idle", 1e9)),
        *(
            row(f"level that is trimmed, {d} diode", "mV", {n: 1e3 * one.start[k] for n, one in found.columns.items()})
            for k, d in enumerate(("first", "second"))
        ),
    ]


def _row_driver(found: dict[str, RowDriverResult], spec: RowDriverSpec) -> list[Row]:
    """Return the rows of a row's driver."""

    def row(name: str, unit: str, field: str, scale: float, **limits: float) -> Row:
        values = {corner: scale * getattr(one, field) for corner, one in found.items()}
        return over_corners("row driver", name, unit, values.items(), TYPICAL, **limits)

    wrong = {corner: float(not one.right) for corner, one in found.items()}
    return [
        over_corners("row driver", "wrong levels", "", wrong.items(), TYPICAL, most=0.0),
        row("far end within 1 %", "ns", "settling", 1e9, most=1e9 * spec.settle),
        row("far end from 10 to 90 %", "ns", "slew", 1e9, most=1e9 * spec.slew),
        row("energy of a pulse", "pJ", "energy", 1e12),
        row("current of a row at rest", "uA", "idle", 1e6, most=1e6 * spec.idle),
    ]


def _support(found: dict[str, SupportResult]) -> list[Row]:
    """Return the rows of switch drivers and bias."""
    spec = SupportSpec()

    def row(circuit: str, name: str, unit: str, field: str, scale: float, **limits: float) -> Row:
        values = {corner: scale * getattr(one, field) for corner, one in found.items()}
        return over_corners(circuit, name, unit, values.items(), TYPICAL, **limits)

    off = {corner: 100 * abs(one.bias / BIAS - 1) for corner, one in found.items()}
    return [
        row("switch drivers", "shortest gap", "ns", "gap", 1e9, least=1e9 * spec.gap),
        row("switch drivers", "longest gap", "ns", "lost", 1e9, most=1e9 * spec.lost),
        row("bias", "current", "uA", "bias", 1e6),
        over_corners("bias", "current, off by", "%", off.items(), TYPICAL, most=100 * spec.bias),
        row("bias", "start", "us", "start", 1e6, most=1e6 * spec.start),
        row("bias", "current of the whole", "uA", "idle", 1e6),
    ]


def _quantile(circuit: str, name: str, values: Sequence[float], most: float, over: str) -> Row:
    ordered = np.quantile(values, (0.0, 0.5, 0.997))
    return Row(circuit, name, "LSB", float(ordered[1]), float(ordered[0]), float(ordered[2]), most=most, over=over)
