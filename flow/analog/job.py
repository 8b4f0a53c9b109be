"""All measurements of the lane as jobs, the datasheet from them, and the table that frames are simulated with."""

import json
from collections.abc import Callable, Sequence
from dataclasses import asdict
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

from talbot.base.files import check_file, check_folder, staged, write
from talbot.base.jobs import Job, run
from talbot.base.paths import BUILD
from talbot.base.records import from_json
from talbot.cells.corner import Corner
from talbot.models.parameters import ParameterError, check_int
from talbot.pixels.circuits import lane as lanes
from talbot.pixels.circuits.amplifier import AmplifierSizes, AmplifierSpec
from talbot.pixels.circuits.lane import LaneSizes
from talbot.pixels.circuits.specification import LaneSpec

from . import amplifier, comparator, lane, linearity
from . import noise as noises
from .amplifier import AmplifierResult
from .comparator import BATCH, Decisions, spread
from .datasheet import Row, over_corners
from .deck import Setup, deck, process_of
from .found import Found
from .lane import LaneResult, inl
from .noise import Noise

STEPS = "check", "corners", "mismatch", "noise", "linearity", "report"
STORE = BUILD / "analog" / "measured"
TYPICAL = "tt_027C_1v80"
QUICK = (TYPICAL, "ss_n40C_1v62", "ff_125C_1v98")
ALL = (
    TYPICAL,
    *(f"{p}_{t}_{v}" for p in ("tt", "ss", "ff", "sf", "fs") for t in ("n40C", "125C") for v in ("1v62", "1v98")),
)
CORNER_SETS = {"all": ALL, "quick": QUICK, "typical": (TYPICAL,)}
ARRAYS = 1000  # drawn capacitor arrays


def corners_of(text: str) -> tuple[str, ...]:
    """Names of corners from an option: all, quick, typical, or names with commas between. Raises ParameterError."""
    names = CORNER_SETS.get(text) or tuple(name for name in text.split(",") if name)
    for name in names:
        corner = Corner.parse(name)
        if not 1.6 <= corner.supply <= 2.0 or not -40 <= corner.temperature <= 125:
            raise ParameterError(f"corners = {name}: must be at 1.6 to 2 V and -40 to 125 degrees Celsius")
    if not names:
        raise ParameterError(f"corners = {text!r}: must be all, quick, typical, or names like {TYPICAL}")
    return tuple(dict.fromkeys((TYPICAL, *names)))


def setup_of(pdk: str) -> tuple[Setup, LaneSizes]:
    """Specification and sizes of the lane of the default sensor in a process."""
    process, spec = process_of(pdk), LaneSpec.of()
    sizes = lanes.size(spec, process)
    cell = next(one for one in process.unit_cells(spec.unit_mismatch) if one.kind == sizes.dac.kind)
    return Setup(pdk, spec, (cell.low, cell.high)), sizes


def make(
    pdk: str,
    corners: Sequence[str],
    draws: int,
    out: Path,
    table: Path | None = None,
    workers: int = -1,
    note: Callable[[str], None] = lambda text: None,
) -> dict[str, Any]:
    """Measure, write the datasheet into ``out``, with ``table`` what frames need; returns the summary."""
    from . import page  # Matplotlib: not before it is needed

    start = perf_counter()
    check_int("draws", draws, 2 * BATCH, 100_000)
    check_folder("out", out)
    if table:
        check_file("table", table)
    setup, sizes = setup_of(pdk)
    note("check")
    typical = Corner.parse(TYPICAL)
    deck(lanes.sar_lane(sizes), setup, typical)
    spec_a, sizes_a = AmplifierSpec.of(), AmplifierSizes()
    given = repr((setup, sizes))
    checks = [
        Job("faults", lane.faults, (setup, sizes, typical), (given,)),
        Job(
            "amplifier-faults",
            amplifier.faults,
            (setup, spec_a, sizes_a, sizes, typical),
            (given, repr((spec_a, sizes_a))),
        ),
    ]
    if wrong := [fault for faults in run(checks, STORE, "check", workers) for fault in faults]:
        raise ParameterError(wrong[0])
    found = measured(setup, sizes, corners, draws, workers, note)
    note("report")
    rows = datasheet(setup.spec, found, len(found.offsets))
    counts = [*found.decisions.values(), *found.lanes.values(), *found.amplifiers.values()]
    summary = {
        "pdk": pdk,
        "corners": list(corners),
        "draws": len(found.offsets),
        "specification": asdict(setup.spec),
        "sizes": asdict(sizes),
        "rows": [asdict(row) | {"passes": row.passes} for row in rows],
        "failed": [f"{row.circuit}: {row.name}" for row in rows if not row.passes],
        "transients": sum(one.runs for one in counts),
        "retried": sum(one.repeated for one in counts),
        "converter": converter(setup.spec, sizes, found),
        "noise": asdict(found.noise),
        "wall_s": perf_counter() - start,
    }
    with staged(out, page.NAMES) as folder:
        page.write(folder, summary, rows, found)
        (folder / "summary.json").write_text(json.dumps(summary, indent=1, allow_nan=False) + "\n")
    if table:
        write(table, json.dumps(summary["converter"], indent=1, allow_nan=False) + "\n")
    return summary


def measured(
    setup: Setup,
    sizes: LaneSizes,
    corners: Sequence[str],
    draws: int,
    workers: int = -1,
    note: Callable[[str], None] = lambda text: None,
) -> Found:
    """All measurements; those that an earlier run made with the same circuits and code are read."""
    places = {name: Corner.parse(name) for name in corners}
    given = repr((setup, sizes))
    jobs = [
        Job(f"{kind}-{name}", call, (setup, sizes, corner), (given, name))
        for name, corner in places.items()
        for kind, call in (("comparator", comparator.decisions), ("lane", lane.measure))
    ]
    note("corners")
    results = run(jobs, STORE, "corners", workers)
    spec_a, sizes_a = AmplifierSpec.of(), AmplifierSizes()
    amplified = [
        Job(
            f"amplifier-{name}",
            amplifier.measure,
            (setup, spec_a, sizes_a, sizes, corner),
            (given, repr((spec_a, sizes_a)), name),
        )
        for name, corner in places.items()
    ]
    amplifiers = run(amplified, STORE, "amplifier", workers)
    note("mismatch")
    typical = places[TYPICAL]
    batches = range(1, -(-draws // BATCH) + 1)
    drawn = [Job(f"offset-{k}", comparator.offsets, (setup, sizes, typical, k), (given, k)) for k in batches]
    offsets = [value for batch in run(drawn, STORE, "mismatch", workers) for value in batch]
    note("noise")
    noise: Noise = from_json(
        Noise, run([Job("noise", noises.noise, (setup, sizes, typical), (given,))], STORE, "noise", workers)[0]
    )
    note("linearity")
    ktc = {name: linearity.ktc(setup.spec, sizes, one.temperature + 273.15) for name, one in places.items()}
    arrays = []
    for seed in range(ARRAYS):
        rng = np.random.default_rng((seed, 2))
        level = linearity.levels(linearity.drawn(sizes.dac.unit_mismatch, rng))
        tested = linearity.tested(level, noise.rms, ktc[TYPICAL], seed) if seed < draws else None
        arrays.append((*linearity.inl_dnl(level), tested.enob if tested else None))
    return Found(
        {name: from_json(Decisions, one) for name, one in zip(places, results[::2], strict=True)},
        {name: from_json(LaneResult, one) for name, one in zip(places, results[1::2], strict=True)},
        offsets,
        noise,
        [one[0] for one in arrays],
        [one[1] for one in arrays],
        [one[2] for one in arrays if one[2] is not None],
        ktc,
        {name: from_json(AmplifierResult, one) for name, one in zip(places, amplifiers, strict=True)},
        {name: amplifier.ktc(setup, sizes_a, corner) for name, corner in places.items()},
    )


def datasheet(spec: LaneSpec, found: Found, draws: int) -> list[Row]:
    """The rows, with limits from the specification."""
    half, share = 1e9 * spec.half_cycle, 1e12 * spec.decision_energy
    rms, _, high = spread(found.offsets)

    def corners(circuit: str, name: str, unit: str, values: dict[str, float], most: float | None) -> Row:
        return over_corners(circuit, name, unit, values.items(), TYPICAL, most=most)

    decisions, results = found.decisions, found.lanes
    energies = {name: 1e12 * sum(one.energy.values()) for name, one in results.items()}
    shapes = {name: inl(one.levels) for name, one in results.items()}
    wrong = {name: float(not one.right) for name, one in decisions.items()}
    missed = {name: float(abs(one.code - round(lane.VALUE))) for name, one in results.items()}
    over = f"{draws} draws, max: 95 % interval"
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
        Row("comparator", "offset, rms", "LSB", rms, None, high, most=spec.offset, over=over),
        Row("comparator", "noise, rms", "LSB", noise.rms, None, noise.high, most=spec.noise, over="95 % interval"),
        corners("DAC", "settling to half an LSB", "ns", {n: 1e9 * r.settling for n, r in results.items()}, half),
        corners("DAC", "INL, schematic", "LSB", {n: s[2] for n, s in shapes.items()}, spec.inl),
        _quantile("DAC", "INL, mismatch", found.inl, spec.inl, arrays),
        _quantile("DAC", "DNL, mismatch", found.dnl, spec.dnl, arrays),
        corners("lane", "offset, systematic", "LSB", {n: abs(s[0]) for n, s in shapes.items()}, spec.offset),
        corners("lane", "gain error over the range", "LSB", {n: abs(s[1]) for n, s in shapes.items()}, None),
        corners("lane", "sampled noise, rms", "LSB", found.ktc, spec.ktc),
        corners("lane", "droop in a conversion", "LSB", {n: r.droop for n, r in results.items()}, spec.droop),
        corners("lane", f"conversion of {lane.VALUE:g}, off by", "codes", missed, 0.0),
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
        *_amplifier(found),
    ]


def _amplifier(found: Found) -> list[Row]:
    """The rows of the difference amplifier."""
    spec = AmplifierSpec.of()

    def corners(name: str, unit: str, values: dict[str, float], most: float | None) -> Row:
        return over_corners("amplifier", name, unit, values.items(), TYPICAL, most=most)

    def row(name: str, unit: str, field: str, most: float | None, scale: float = 1.0) -> Row:
        values = {corner: scale * abs(getattr(one, field)) for corner, one in found.amplifiers.items()}
        return corners(name, unit, values, most)

    gains = {corner: 100 * abs(one.gain - 1) for corner, one in found.amplifiers.items()}
    return [
        corners("gain, off by", "%", gains, 100 * spec.gain),
        row("offset", "LSB", "offset", None),
        row("INL", "LSB", "inl", spec.inl),
        row("settling to half an LSB", "ns", "settling", 1e9 * spec.hold, 1e9),
        row("left after one cycle", "LSB", "left", spec.settling),
        row("change under 100 times ambient light", "LSB", "ambient", spec.ambient),
        row("steps of the trim, off by", "steps", "trim", spec.trim),
        corners("sampled noise, rms", "LSB", found.amplifier_ktc, spec.ktc),
        row("energy of a sample", "pJ", "energy", 1e12 * spec.energy, 1e12),
    ]


def _quantile(circuit: str, name: str, values: Sequence[float], most: float, over: str) -> Row:
    ordered = np.quantile(values, (0.0, 0.5, 0.997))
    return Row(circuit, name, "LSB", float(ordered[1]), float(ordered[0]), float(ordered[2]), most=most, over=over)


def converter(spec: LaneSpec, sizes: LaneSizes, found: Found) -> dict[str, Any]:
    """What `models/afe` takes of the circuit, each with its source and the fit's error where there is one (LSB)."""
    rms, low, high = spread(found.offsets)
    shape = inl(found.lanes[TYPICAL].levels)
    interval = (found.noise.high - found.noise.low) / 2
    command = f"make analog, {TYPICAL}"
    return {
        "command": command,
        "parameters": {
            "inl": round(shape[2], 4),
            "dnl": 0.0,
            "offset": round(rms, 4),
            "noise": round(found.noise.rms, 4),
            "ktc": round(float(np.hypot(found.ktc[TYPICAL], found.amplifier_ktc[TYPICAL])), 4),
            "unit_mismatch": round(sizes.dac.unit_mismatch, 6),
        },
        "sources": {
            "inl": f"peak of {len(lane.CODES)} levels in ngspice off the line through the ends",
            "dnl": "steps come from unit_mismatch",
            "offset": f"{len(found.offsets)} draws of the models' mismatch in ngspice",
            "noise": f"{2 * found.noise.decisions} decisions with transient noise in ngspice",
            "ktc": "closed form: both common plates of the lane, both inputs of the amplifier",
            "unit_mismatch": f"{sizes.dac.source}",
        },
        "errors": {
            "inl": round(shape[2], 4),
            "offset": round((high - low) / 2, 4),
            "noise": round(interval, 4),
            "offset_systematic": round(abs(shape[0]), 4),
            "gain": round(abs(shape[1]), 4),
            "amplifier_inl": round(found.amplifiers[TYPICAL].inl, 4),
            "amplifier_settling": round(found.amplifiers[TYPICAL].left, 4),
            "settling": round(_left(spec, found.lanes[TYPICAL]), 6),
            "droop": round(found.lanes[TYPICAL].droop, 4),
        },
    }


def _left(spec: LaneSpec, result: LaneResult) -> float:
    """LSB that are left of a step of the range at the strobe: exponential from half an LSB on."""
    constants = np.log(256 / 0.5)
    return float(256 * np.exp(-spec.half_cycle / max(result.settling / constants, 1e-12)))
