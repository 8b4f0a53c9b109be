"""The table that frames are simulated with: the converters', amplifiers' and columns' figures at the typical corner."""

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

import numpy as np

from talbot.models.parameters import DIODE
from talbot.models.parameters.electrical import AMPLIFIER
from talbot.pixels.circuits.column_sizes import ColumnSpec
from talbot.pixels.circuits.lane import LaneSizes
from talbot.pixels.circuits.specification import LaneSpec
from talbot.pixels.datasheet.comparator import interval
from talbot.pixels.datasheet.curves import SOURCES, ColumnFit
from talbot.pixels.datasheet.found import TYPICAL, Found
from talbot.pixels.datasheet.lane import CODES, LaneResult, inl


def converter(
    spec: LaneSpec, sizes: LaneSizes, found: Found, column_spec: ColumnSpec, fit: ColumnFit
) -> dict[str, Any]:
    """Return the figures for `models/afe`, each with its source and the fit's error where there is one (LSB)."""
    rms, low, high = interval(found.offsets)
    rms_a, low_a, high_a = interval([one.offset for one in found.amplifier_draws])
    rms_c, low_c, high_c = interval(found.column_offsets)
    rms_p, low_p, high_p = interval(found.pixel_offsets)
    of_diode = 2**0.5 * column_spec.swing / column_spec.lsb / DIODE  # of a difference, for each LSB of a diode
    shape = inl(found.lanes[TYPICAL].decided)
    bend, bend_sources, bend_error = amplifier_curve(found.amplifiers[TYPICAL].points)
    gains = float(np.std([one.gain for one in found.amplifier_draws], ddof=1))
    counts = f"{len(found.offsets)} comparators and {len(found.amplifier_draws)} amplifiers"
    return {
        "command": f"make analog, {TYPICAL}",
        "parameters": {
            "inl": round(shape[2], 4),
            "dnl": 0.0,
            "offset": round(float(np.hypot(rms, rms_a)), 4),
            "noise": round(found.noise.rms, 4),
            "ktc": round(float(np.hypot(found.ktc[TYPICAL], found.amplifier_noise.total)), 4),
            "unit_mismatch": round(sizes.dac.unit_mismatch, 6),
            **bend,
        },
        "columns": asdict(fit.curves),
        "diodes": {
            "read_noise": round(found.column_noise[TYPICAL] / column_spec.full_well * DIODE, 4),
            "column_fpn": round(rms_c / of_diode, 4),
            "offset_fpn": round(rms_p / of_diode, 4),
        },
        "sources": {
            "inl": f"peak of {len(CODES)} levels, by the decisions in ngspice, off the line through the ends",
            "dnl": "steps come from unit_mismatch",
            "offset": f"{counts} with the models' mismatch in ngspice",
            "noise": f"{2 * found.noise.decisions} decisions with transient noise in ngspice",
            "ktc": "closed form of the lane's common plates, .noise of the amplifier in reset and signal",
            "unit_mismatch": f"{sizes.dac.source}",
            **bend_sources,
            **SOURCES,
            "read_noise": "closed form of a column's stages",
            "column_fpn": f"{len(found.column_offsets)} columns with the models' mismatch in ngspice",
            "offset_fpn": f"{len(found.pixel_offsets)} pixels' switches with the models' mismatch in ngspice",
        },
        "errors": {
            "inl": round(shape[2], 4),
            "offset": round(float(np.hypot(high - low, high_a - low_a)) / 2, 4),
            "noise": round((found.noise.high - found.noise.low) / 2, 4),
            "offset_systematic": round(abs(shape[0]), 4),
            "gain": round(abs(shape[1]), 4),
            "amplifier_fit": bend_error,
            "amplifier_gain_spread": round(128 * gains, 4),
            "amplifier_settling": round(found.amplifiers[TYPICAL].left, 4),
            "settling": round(_left(spec, found.lanes[TYPICAL]), 6),
            "droop": round(found.lanes[TYPICAL].droop, 4),
            "columns": fit.error,
            "sums": fit.sum_error,
            "column_fpn": round((high_c - low_c) / 2 / of_diode, 4),
            "offset_fpn": round((high_p - low_p) / 2 / of_diode, 4),
        },
    }


def amplifier_curve(points: Sequence[tuple[float, float]]) -> tuple[dict[str, float], dict[str, str], float]:
    """AMPLIFIER by `polynomial`, as a table has it; the source of each; LSB, the fit's error."""
    bend, error = polynomial(points)
    source = f"cubic through {len(points)} differences that the lane samples in ngspice"
    named = {name: round(value, 4) for name, value in zip(AMPLIFIER, bend, strict=True)}
    return named, dict.fromkeys(AMPLIFIER, source), round(error, 4)


def polynomial(points: Sequence[tuple[float, float]]) -> tuple[tuple[float, ...], float]:
    """Return an amplifier's error polynomial (LSB) in 1, x, x2, x3, x = ideal / 128, and the largest residual."""
    ideal, got = np.array(points).T
    bend = np.polynomial.polynomial.polyfit(ideal / 128, got - ideal, len(AMPLIFIER) - 1)
    rest = got - ideal - np.polynomial.polynomial.polyval(ideal / 128, bend)
    return tuple(float(value) for value in bend), float(np.abs(rest).max())


def _left(spec: LaneSpec, result: LaneResult) -> float:
    """Return the residue of a step of the range at the strobe, LSB: exponential from half an LSB on."""
    constants = np.log(256 / 0.5)
    return float(256 * np.exp(-spec.half_cycle / max(result.settling / constants, 1e-12)))
