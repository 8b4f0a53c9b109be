"""All measurements of the analog circuits as jobs, and the datasheet from them."""

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from time import perf_counter
from typing import Any, TypeVar

import numpy as np

from talbot.base.files import check_file, check_folder, staged, write
from talbot.base.jobs import Job, run
from talbot.base.paths import BUILD
from talbot.base.records import from_json
from talbot.cells.corner import Corner
from talbot.models.parameters import STANDARD, ParameterError, SensorParameters, check_int
from talbot.pixels.circuits import amplifier as amplifiers
from talbot.pixels.circuits import lane as lanes
from talbot.pixels.circuits.amplifier import AmplifierSizes, AmplifierSpec
from talbot.pixels.circuits.column_sizes import ColumnSizes, ColumnSpec
from talbot.pixels.circuits.column_sizes import size as column_size
from talbot.pixels.circuits.lane import LaneSizes
from talbot.pixels.circuits.row_driver import RowDriverSpec
from talbot.pixels.circuits.specification import LaneSpec
from talbot.pixels.circuits.support import SupportSpec
from talbot.pixels.datasheet import (
    amplifier,
    column,
    comparator,
    curves,
    interface,
    lane,
    linearity,
    references,
    row_driver,
    spread,
    support,
    turn,
)
from talbot.pixels.datasheet import noise as noises
from talbot.pixels.datasheet import sensor as sensors
from talbot.pixels.datasheet.amplifier import AmplifierResult
from talbot.pixels.datasheet.column import ColumnResult
from talbot.pixels.datasheet.comparator import BATCH, Decisions
from talbot.pixels.datasheet.converter import converter
from talbot.pixels.datasheet.curves import ColumnFit
from talbot.pixels.datasheet.deck import Setup, deck, process_of
from talbot.pixels.datasheet.found import TYPICAL, Found
from talbot.pixels.datasheet.interface import InterfaceResult
from talbot.pixels.datasheet.lane import LaneResult
from talbot.pixels.datasheet.noise import Noise
from talbot.pixels.datasheet.references import ReferencesResult
from talbot.pixels.datasheet.row_driver import RowDriverResult
from talbot.pixels.datasheet.rows import datasheet
from talbot.pixels.datasheet.spread import AmplifierNoise, Drawn
from talbot.pixels.datasheet.supply import Ripple, ripple
from talbot.pixels.datasheet.support import SupportResult
from talbot.pixels.datasheet.turn import TurnResult

STEPS = "check", "corners", "mismatch", "noise", "linearity", "report"
STORE = BUILD / "analog" / "measured"
QUICK = (TYPICAL, "ss_n40C_1v62", "ff_125C_1v98")
ALL = (
    TYPICAL,
    *(f"{p}_{t}_{v}" for p in ("tt", "ss", "ff", "sf", "fs") for t in ("n40C", "125C") for v in ("1v62", "1v98")),
)
CORNER_SETS = {"all": ALL, "quick": QUICK, "typical": (TYPICAL,)}
ARRAYS = 1000  # drawn capacitor arrays
PIXELS = 25  # draws of a pixel's switches
BOUNDING = 200  # draws, from which on an interval that has the limit inside breaks it
T = TypeVar("T")


def corners_of(text: str) -> tuple[str, ...]:
    """Names of corners from an option: all, quick, typical, or names with commas between. Raises ParameterError."""
    names = CORNER_SETS.get(text) or tuple(name for name in text.split(",") if name)
    for name in names:
        try:
            corner = Corner.parse(name)
        except ParameterError:
            must = f"must be {', '.join(CORNER_SETS)}, or names like {TYPICAL} with commas between"
            raise ParameterError(f"corners = {text!r}: {must}") from None
        if not 1.6 <= corner.supply <= 2.0 or not -40 <= corner.temperature <= 125:
            raise ParameterError(f"corners = {name}: must be at 1.6 to 2 V and -40 to 125 degrees Celsius")
    if not names:
        raise ParameterError(f"corners = {text!r}: must be {', '.join(CORNER_SETS)}, or names like {TYPICAL}")
    return tuple(dict.fromkeys((TYPICAL, *names)))


def setup_of(pdk: str, sensor: SensorParameters = STANDARD) -> tuple[Setup, LaneSizes]:
    """Specification and sizes of the lane of a sensor in a process. Raises ParameterError."""
    process, spec = process_of(pdk), LaneSpec.of(sensor)
    sizes = lanes.size(spec, process)
    cell = next(one for one in process.unit_cells(spec.unit_mismatch) if one.kind == sizes.dac.kind)
    return Setup(pdk, spec, (cell.low, cell.high)), sizes


def amplifier_of(
    setup: Setup, lane: LaneSizes, sensor: SensorParameters = STANDARD
) -> tuple[AmplifierSpec, AmplifierSizes]:
    """Specification and sizes of the amplifier that drives ``lane``. Raises ParameterError."""
    spec = AmplifierSpec.of(sensor)
    load = amplifier.load_of(setup, lane, Corner.parse(TYPICAL))
    return spec, amplifiers.size(spec, load, process_of(setup.pdk))


def column_of(setup: Setup, sensor: SensorParameters = STANDARD) -> tuple[ColumnSpec, ColumnSizes]:
    """Specification and sizes of the column amplifiers of a sensor. Raises ParameterError for too long lines."""
    spec, array = ColumnSpec.of(sensor), sensor.array
    try:
        return spec, column_size(spec, process_of(setup.pdk))
    except ParameterError as error:
        size = f"array.rows, array.cols = {array.rows}, {array.cols}"
        raise ParameterError(f"{size}: must be less at array.pitch = {array.pitch:g} (a column's {error})") from None


def make(
    pdk: str,
    corners: Sequence[str],
    draws: int,
    out: Path,
    table: Path | None = None,
    workers: int = -1,
    note: Callable[[str], None] = lambda text: None,
    sensor: SensorParameters = STANDARD,
) -> dict[str, Any]:
    """Measure, write the datasheet into ``out``, with ``table`` what frames need; returns the summary."""
    from talbot.pixels.datasheet import page  # Matplotlib: not before it is needed

    start = perf_counter()
    check_int("draws", draws, 2 * BATCH, 100_000)
    check_folder("out", out)
    if table:
        check_file("table", table)
    setup, sizes = setup_of(pdk, sensor)
    column_spec = column_of(setup, sensor)[0]
    RowDriverSpec.of(sensor)
    note("check")
    typical = Corner.parse(TYPICAL)
    deck(lanes.sar_lane(sizes), setup, typical)
    spec_a, sizes_a = amplifier_of(setup, sizes, sensor)
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
    fit = table is not None or draws >= BOUNDING  # minutes that a quick look does not take
    found = measured(setup, sizes, corners, draws, workers, note, sensor, fit)
    note("report")
    rows = datasheet(setup.spec, found, len(found.offsets), sensor)
    counts = [*found.decisions.values(), *found.lanes.values(), *found.amplifiers.values(), *found.supports.values()]
    counts += [*found.rows.values(), *found.columns.values(), *found.turns.values()]
    counts += [*found.interfaces.values(), *found.references.values()]
    summary = {
        "pdk": pdk,
        "sensor": sensors.figures(pdk, sensor),
        "corners": list(corners),
        "draws": len(found.offsets),
        "specification": asdict(setup.spec),
        "amplifier": asdict(spec_a),
        "column": asdict(column_spec),
        "sizes": asdict(sizes) | {"amplifier": asdict(sizes_a.ota)} | column_widths(setup, sensor),
        "rows": [asdict(row) | {"verdict": row.verdict, "draws_needed": row.draws_needed} for row in rows],
        "failed": [
            f"{row.circuit}: {row.name}"
            for row in rows
            if row.verdict == "FAIL" or row.verdict == "open" and draws >= BOUNDING
        ],
        "transients": sum(one.runs for one in counts),
        "retried": sum(one.repeated for one in counts),
        "converter": converter(setup.spec, sizes, found, column_spec, found.column_fit) if found.column_fit else None,
        "noise": asdict(found.noise),
        "amplifier_noise": asdict(found.amplifier_noise),
        "wall_s": perf_counter() - start,
    }
    with staged(out, page.NAMES) as folder:
        page.write(folder, summary, rows, found, sensor)
        (folder / "summary.json").write_text(json.dumps(summary, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    if table:
        write(table, json.dumps(summary["converter"], indent=1, allow_nan=False) + "\n")
    return summary


def column_widths(setup: Setup, sensor: SensorParameters) -> dict[str, dict[str, float]]:
    """Widths (um) of each of a column's stages, for the datasheet."""
    _, sizes = column_of(setup, sensor)
    stages = {"front": sizes.front, "back": sizes.back, "lane": sizes.lane}
    return {f"column {name}": {k: v for k, v in asdict(one).items() if k != "current"} for name, one in stages.items()}


def measured(
    setup: Setup,
    sizes: LaneSizes,
    corners: Sequence[str],
    draws: int,
    workers: int = -1,
    note: Callable[[str], None] = lambda text: None,
    sensor: SensorParameters = STANDARD,
    fit: bool = True,
) -> Found:
    """All measurements; those of an earlier run with the same circuits and code are read. fit: the curves, too."""
    places = {name: Corner.parse(name) for name in corners}
    given = repr((setup, sizes))
    jobs = [
        Job(f"{kind}-{name}", call, (setup, sizes, corner), (given, name))
        for name, corner in places.items()
        for kind, call in (("comparator", comparator.decisions), ("lane", lane.measure))
    ]
    note("corners")
    results = run(jobs, STORE, "corners", workers)
    spec_a, sizes_a = amplifier_of(setup, sizes, sensor)
    amplifiers = _everywhere(
        "amplifier", AmplifierResult, amplifier.measure, (setup, spec_a, sizes_a, sizes), places, workers
    )
    ripples = _everywhere("supply", Ripple, ripple, (setup, spec_a, sizes_a, sizes), places, workers)
    supports = _everywhere("support", SupportResult, support.measure, (setup, SupportSpec()), places, workers)
    driven = setup, RowDriverSpec.of(sensor)
    rows = _everywhere("row driver", RowDriverResult, row_driver.measure, driven, places, workers)
    spec_c, sizes_c = column_of(setup, sensor)
    given_c = repr((setup, spec_c, sizes_c))
    columns = _everywhere("column", ColumnResult, column.measure, (setup, spec_c, sizes_c), places, workers)
    both = setup, (spec_c, spec_a), (sizes_c, sizes_a), sizes
    turns = _everywhere("turn", TurnResult, turn.measure, both, places, workers)
    interfaces = _everywhere("interface", InterfaceResult, interface.measure, (setup,), places, workers)
    shared = {
        name: from_json(
            ReferencesResult,
            run(
                [Job(f"references-{name}", references.measure, (setup, sizes, corner, at), (given, name, at))],
                STORE,
                "references",
                workers,
            )[0],
        )
        for name, corner in places.items()
        for at in (interfaces[name].first,)
    }
    note("mismatch")
    typical = places[TYPICAL]
    batches = range(1, -(-draws // BATCH) + 1)
    drawn = [Job(f"offset-{k}", comparator.offsets, (setup, sizes, typical, k), (given, k)) for k in batches]
    offsets = [value for batch in run(drawn, STORE, "mismatch", workers) for value in batch]
    given_a = repr((spec_a, sizes_a))
    more = [
        Job(f"amplifier-draw-{k}", spread.drawn, (setup, spec_a, sizes_a, sizes, typical, k), (given, given_a, k))
        for k in range(1, BATCH * len(batches) + 1)
    ]
    amplifier_draws = [from_json(Drawn, one) for one in run(more, STORE, "amplifiers", workers)]
    start = columns[TYPICAL].start
    given_f = setup, spec_c, sizes_c, typical, start
    column_offsets, pixel_offsets = (
        run(
            [
                Job(f"{name}-draw-{k}", column.offset, (*given_f, k, pixel), (given_c, start, k))
                for k in range(1, count + 1)
            ],
            STORE,
            f"{name}s drawn",
            workers,
        )
        for name, count, pixel in (("column", draws, False), ("pixel", min(draws // 4, PIXELS), True))
    )
    curves_c = Job("column-curves", curves.fitted, given_f, (given_c, start))
    note("noise")
    closed = amplifier.ktc(setup, sizes_a, typical)
    quiet = Job(
        "amplifier-noise", spread.noise, (setup, spec_a, sizes_a, sizes, typical, closed), (given, given_a, closed)
    )
    amplifier_noise: AmplifierNoise = from_json(AmplifierNoise, run([quiet], STORE, "noise", workers)[0])
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
        amplifiers,
        {name: amplifier.ktc(setup, sizes_a, corner) for name, corner in places.items()},
        amplifier_draws,
        amplifier_noise,
        ripples,
        supports,
        rows,
        columns,
        {name: column.noise(spec_c, sizes_c, process_of(setup.pdk), one.temperature) for name, one in places.items()},
        column_offsets,
        pixel_offsets,
        turns,
        from_json(ColumnFit, run([curves_c], STORE, "curves", workers)[0]) if fit else None,
        interfaces,
        shared,
    )


def _everywhere(
    what: str,
    record: type[T],
    measure: Callable[..., T],
    given: tuple[Any, ...],
    places: Mapping[str, Corner],
    workers: int,
) -> dict[str, T]:
    """``measure`` of ``given`` and a corner, at each of ``places``. record: what it returns."""
    jobs = [
        Job(f"{what.replace(' ', '-')}-{name}", measure, (*given, corner), (repr(given), name))
        for name, corner in places.items()
    ]
    return {name: from_json(record, one) for name, one in zip(places, run(jobs, STORE, what, workers), strict=True)}
