"""Cells drawn, written, checked, extracted and measured -> GDS, SPICE, pictures, page, summary.json."""

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

from talbot.base.files import check_file, check_folder, staged, write
from talbot.base.gds import write_gds
from talbot.cells.corner import Corner
from talbot.models.parameters import STANDARD, ArrayParameters, SensorParameters
from talbot.pixels.analog_layout.amplifier import amplifier_cell
from talbot.pixels.analog_layout.bias import bias_cell
from talbot.pixels.analog_layout.cells import Cell, comparator_cell
from talbot.pixels.analog_layout.column import column_cell
from talbot.pixels.analog_layout.drawable import check_drawable
from talbot.pixels.analog_layout.drawn_block import DrawnBlock
from talbot.pixels.analog_layout.lane import lane_cell
from talbot.pixels.analog_layout.row_drivers import row_cell
from talbot.pixels.analog_layout.switch import switch_cell
from talbot.pixels.circuits.amplifier import AmplifierSizes, AmplifierSpec
from talbot.pixels.circuits.column_sizes import ColumnSizes, ColumnSpec
from talbot.pixels.circuits.dac import BITS
from talbot.pixels.circuits.lane import LaneSizes
from talbot.pixels.circuits.row_driver import RowDriverSpec
from talbot.pixels.circuits.specification import LaneSpec
from talbot.pixels.circuits.support import SupportSpec
from talbot.pixels.datasheet.column import ColumnResult
from talbot.pixels.datasheet.converter import amplifier_curve
from talbot.pixels.datasheet.curves import SOURCES, fitted
from talbot.pixels.datasheet.deck import Setup, process_of
from talbot.pixels.datasheet.job import amplifier_of, column_of, setup_of
from talbot.pixels.datasheet.lane import inl
from talbot.pixels.datasheet.linearity import inl_dnl, levels
from talbot.pixels.datasheet.row_driver import RowDriverResult
from talbot.pixels.datasheet.row_driver import measure as measure_row
from talbot.pixels.datasheet.turn import TurnResult
from talbot.pixels.datasheet.turn import measure as measure_turn
from talbot.pixels.post_layout import amplifier, column, row_driver, switch
from talbot.pixels.post_layout.amplifier import Amplified
from talbot.pixels.post_layout.checks import differences, drc, lvs
from talbot.pixels.post_layout.extract import Extracted, Nets, extract
from talbot.pixels.post_layout.measure import Measured, measure
from talbot.pixels.post_layout.pairs import Pair, pairs
from talbot.pixels.post_layout.row import Row
from talbot.pixels.post_layout.switch import Gaps
from talbot.pixels.post_layout.write import drawn_blocks
from talbot.platforms.analog import AnalogMasks, analog_masks
from talbot.platforms.layout import layout_platform
from talbot.platforms.wires import wire_corner

STEPS = "draw", "drc", "lvs", "extract", "measure", "report"
KINDS = "gds", "spice", "extracted.spice", "lyrdb", "lvsdb"


def cells(
    masks: AnalogMasks,
    sizes: LaneSizes,
    amplifier: AmplifierSizes,
    lanes: int,
    column: ColumnSizes,
    array: ArrayParameters,
) -> dict[str, Cell]:
    """Return the cells that are drawn and extracted, by name. lanes: that share a bias."""
    return {
        "comparator": comparator_cell(masks, sizes.comparator),
        "sar_lane": lane_cell(masks, sizes),
        "amplifier": amplifier_cell(masks, amplifier),
        "bias": bias_cell(masks, lanes),
        "row": row_cell(masks, array),
        "column": column_cell(masks, column),
        "non_overlap": switch_cell(masks),
    }


def make(
    pdk: str,
    corners: Sequence[str],
    out: Path,
    table: Path | None = None,
    workers: int = -1,
    note: Callable[[str], None] = lambda text: None,
    sensor: SensorParameters = STANDARD,
) -> dict[str, Any]:
    """Draw, check, measure and report into ``out``; returns the summary. Raises ParameterError, StepError.

    table: file for the curves of the drawn amplifier and column at the first corner.
    """
    from talbot.pixels.post_layout import page  # Matplotlib: not before it is needed

    start = perf_counter()
    check_folder("out", out)
    if table:
        check_file("table", table)
    check_drawable(sensor)
    masks, (setup, sizes) = analog_masks(pdk), setup_of(pdk)
    spec, own = amplifier_of(setup, sizes)
    made = cells(masks, sizes, own, spec.lanes, column_of(setup)[1], sensor.array)
    blocks = drawn_blocks(pdk, sensor)
    drawn: dict[str, Cell | DrawnBlock] = {**made, **blocks}
    names = [f"{name}.{kind}" for name in drawn for kind in KINDS if name in made or kind != "extracted.spice"]
    names += [f"{name}.lef" for name in blocks]
    with staged(out, (*names, *page.NAMES, "summary.json")) as folder:
        note("draw")
        for name, cell in drawn.items():
            write_gds(cell.layout, folder / f"{name}.gds", cell.cell)
        for name, block in blocks.items():
            (folder / f"{name}.lef").write_text(block.lef(masks), encoding="utf-8")
        note("drc")
        rules = {name: drc(folder / f"{name}.gds", pdk, folder / f"{name}.lyrdb") for name in drawn}
        note("lvs")
        same = {
            name: lvs(folder / f"{name}.gds", cell.spice(masks), pdk, folder / f"{name}.lvsdb", cell.boxes)
            for name, cell in drawn.items()
        }
        differ = {name: differences(folder / f"{name}.lvsdb") for name, match in same.items() if not match}
        note("extract")
        found = {name: _extracted(made, masks, name) for name in dict.fromkeys(wire_corner(c) for c in corners)}
        typical = found[wire_corner(corners[0])]
        for name, (circuit, _) in typical.items():
            (folder / f"{name}.extracted.spice").write_text(
                "\n".join([*circuit.lines(process_of(pdk)), ""]), encoding="utf-8"
            )
        note("measure")
        rows = list(_array(typical["sar_lane"][1], masks, sizes, setup.spec))
        rows += amplifier.capacitors(made["amplifier"], typical["amplifier"][1], masks, spec)
        rows += _measured(
            setup, sizes, (spec, own), {corner: found[wire_corner(corner)] for corner in corners}, workers, sensor
        )
        summary = {
            "process": pdk,
            "corners": list(corners),
            "cells": {
                name: _cell(cell, rules[name], same[name], typical.get(name)) | {"lvs_differs": differ.get(name, [])}
                for name, cell in drawn.items()
            },
            "rows": [asdict(row) | {"passes": row.passes} for row in rows],
            "passed": not any(sum(one.values()) for one in rules.values())
            and all(same.values())
            and all(row.passes for row in rows),
            "wall_s": perf_counter() - start,
        }
        note("report")
        page.write(folder, summary, masks.base)
        (folder / "summary.json").write_text(json.dumps(summary, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    if table:
        text = {"command": f"make analog-layout, {corners[0]}", **_table(setup, sizes, typical, corners[0], workers)}
        write(table, json.dumps(text, indent=1) + "\n")
    return summary


def _table(
    setup: Setup, sizes: LaneSizes, drawn: Mapping[str, tuple[Extracted, Nets]], corner: str, workers: int
) -> dict[str, Any]:
    """Return the curves of the drawn amplifier and column for the real-number model, with sources and errors, LSB.

    Both were measured for the page: that is read.
    """
    circuit, *lanes = (drawn[name][0] for name in ("column", "amplifier", "bias"))
    (column,) = _columns(setup, column_of(setup), {corner: [circuit]}, workers)
    fit = fitted(setup, *column_of(setup), Corner.parse(corner), column.layout.start, circuit)
    (both,) = _amplifiers(setup, amplifier_of(setup, sizes), sizes, {corner: lanes}, workers)
    bend, bend_sources, bend_error = amplifier_curve(both.layout.amplifier.points)
    return {
        "parameters": bend,
        "columns": asdict(fit.curves),
        "sources": bend_sources | SOURCES,
        "errors": {"amplifier_fit": bend_error, "columns": fit.error, "sums": fit.sum_error},
    }


def _extracted(made: dict[str, Cell], masks: AnalogMasks, corner: str) -> dict[str, tuple[Extracted, Nets]]:
    """Every cell with its parasitics, wires at ``corner``: typ, min or max."""
    wires = layout_platform(masks.base.name).wires[corner]
    return {name: extract(cell, masks, wires) for name, cell in made.items()}


def _cell(
    cell: Cell | DrawnBlock, rules: dict[str, int], same: bool, found: tuple[Extracted, Nets] | None
) -> dict[str, Any]:
    box = cell.cell.dbbox()
    out = {
        "width_um": round(box.width(), 3),
        "height_um": round(box.height(), 3),
        "transistors": cell.count,
        "drc": rules,
        "lvs_match": same,
    }
    if found is None:
        return out
    circuit, nets = found
    return out | {
        "capacitors": len(circuit.capacitors),
        "resistors": len(circuit.resistors),
        "net_fF": {net: round(1e15 * farad, 3) for net, farad in sorted(nets.totals.items())},
    }


def _array(nets: Nets, masks: AnalogMasks, sizes: LaneSizes, spec: LaneSpec) -> Iterator[Row]:
    """Yield the converter's levels from the capacitances of the drawn array: what couples to the common node counts."""
    names = [*(f"dac.b{k}" for k in range(BITS)), "dac.bt", "dac.bh"]
    units = np.array([*(1 << k for k in range(BITS)), 1, 0.5])
    coupled = np.array([nets.couplings.get((name, "top"), 0.0) for name in names])
    drawn = inl_dnl(levels(units + coupled / sizes.dac.unit))
    for name, value, most in zip(("INL", "DNL"), drawn, (spec.inl, spec.dnl), strict=True):
        yield Row(f"DAC: {name} of all levels", "LSB", 0.0, value, "capacitances", most)
    ground = nets.totals["top"] - coupled.sum()
    yield Row("DAC: common node to all else", "fF", 1e14 * sizes.dac.total, 1e15 * ground, "capacitances")
    yield Row("DAC: bits to the common node next to it", "fF", 0.0, 1e15 * float(coupled.sum()), "capacitances")


def _measured(
    setup: Setup,
    sizes: LaneSizes,
    amplifiers: tuple[AmplifierSpec, AmplifierSizes],
    drawn: Mapping[str, Mapping[str, tuple[Extracted, Nets]]],
    workers: int,
    sensor: SensorParameters,
) -> Iterator[Row]:
    """Rows of all circuits at every corner, with the lines of a sensor."""

    def circuits(*names: str) -> dict[str, list[Extracted]]:
        return {corner: [cells[name][0] for name in names] for corner, cells in drawn.items()}

    driven, support, columns = (
        RowDriverSpec.of(sensor),
        SupportSpec(),
        (ColumnSpec.of_drawn(sensor), column_of(setup)[1]),
    )
    for lane in pairs("lane", measure, Measured, (setup, sizes), circuits("comparator", "sar_lane"), workers):
        yield from _rows(setup.spec, lane)
    for row in pairs("row driver", measure_row, RowDriverResult, (setup, driven), circuits("row"), workers):
        yield from row_driver.rows(driven, row)
    for one in _columns(setup, columns, circuits("column"), workers):
        yield from column.rows(columns[0], one)
    (spec_c, sizes_c), (spec_a, sizes_a) = columns, amplifiers
    given = setup, (spec_c, spec_a), (sizes_c, sizes_a), sizes
    for turn in pairs("turn", measure_turn, TurnResult, given, circuits("column", "amplifier"), workers):
        yield from column.turn_rows(spec_c, turn)
    for gaps in pairs("switch drivers", switch.measure, Gaps, (setup, support), circuits("non_overlap"), workers):
        yield from switch.rows(support, gaps)
    for both in _amplifiers(setup, amplifiers, sizes, circuits("amplifier", "bias"), workers):
        yield from amplifier.rows(amplifiers[0], both)


def _columns(
    setup: Setup, sized: tuple[ColumnSpec, ColumnSizes], drawn: Mapping[str, Sequence[Extracted]], workers: int
) -> Iterator[Pair[ColumnResult]]:
    """Yield a column at every corner."""
    return pairs("column", column.measure, ColumnResult, (setup, *sized), drawn, workers)


def _amplifiers(
    setup: Setup,
    amplifiers: tuple[AmplifierSpec, AmplifierSizes],
    sizes: LaneSizes,
    drawn: Mapping[str, Sequence[Extracted]],
    workers: int,
) -> Iterator[Pair[Amplified]]:
    """Amplifier and bias at every corner."""
    return pairs("amplifier", amplifier.measure, Amplified, (setup, *amplifiers, sizes), drawn, workers)


def _rows(spec: LaneSpec, found: Pair[Measured]) -> Iterator[Row]:
    half, share, row = 1e9 * spec.half_cycle, 1e12 * spec.decision_energy, found.row
    yield row("comparator: decision, half an LSB", "ns", lambda m: 1e9 * m.decisions.delay, half)
    yield row("comparator: wrong decisions", "", lambda m: not m.decisions.right, 0.0)
    yield row(
        "comparator: energy of a decision", "pJ", lambda m: 1e12 * m.decisions.energy, share * spec.comparator_share
    )
    yield row("comparator: offset, systematic", "LSB", lambda m: m.offset, spec.offset)
    before, after = found.schematic.lane, found.layout.lane
    if before is None or after is None:
        return
    lane = Pair(found.corner, before, after).row
    yield lane("DAC: settling to half an LSB", "ns", lambda one: 1e9 * one.settling, half)
    yield lane("DAC: INL of seven levels", "LSB", lambda one: inl(one.levels)[2], spec.inl)
    yield lane("lane: offset, systematic", "LSB", lambda one: inl(one.levels)[0], spec.offset)
    yield lane("lane: gain error over the range", "LSB", lambda one: inl(one.levels)[1])
    yield lane("lane: decisions off their level", "LSB", lambda one: max(abs(off) for _, off in one.decided), spec.inl)
    yield lane("lane: gain up to the comparator", "", lambda one: one.gain)
    yield lane("lane: droop in a conversion", "LSB", lambda one: one.droop, spec.droop)
    yield lane("lane: energy of a decision", "pJ", lambda one: 1e12 * sum(one.energy.values()), share)
