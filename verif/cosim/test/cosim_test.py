"""Co-simulation: the chip's Verilog against the lane in transistors."""

import re
from dataclasses import replace

import numpy as np
import pytest

from talbot.base.tools import ToolError
from talbot.models.parameters import DIODE, ParameterError, circuit_columns
from talbot.pixels.circuits.column import PINS, column
from talbot.pixels.circuits.column_sizes import ColumnSpec
from talbot.pixels.circuits.column_sizes import size as column_size
from talbot.pixels.circuits.interface import STROBE_TYPICAL
from talbot.pixels.circuits.lane import sar_lane, size
from talbot.pixels.circuits.netlist import Circuit, Resistor
from talbot.pixels.circuits.specification import LaneSpec
from talbot.platforms.sky130 import analog
from talbot.verif.cosim import columns, lockstep
from talbot.verif.cosim.accuracy import Accuracy
from talbot.verif.cosim.diagnose import code_of, value_of
from talbot.verif.cosim.extracted import as_drawn
from talbot.verif.cosim.faults import Fault
from talbot.verif.cosim.pixels import PixelSizes
from talbot.verif.cosim.row import Row, RowRequest, read_row
from talbot.verif.cosim.waves import write_vcd

library = pytest.mark.needs("libngspice", "layout")
COARSE = Accuracy(reltol=1e-3, chgtol=1e-15)  # a quarter of the default's time
SMALL = RowRequest(mode="image", cols=6, lanes=1, types=1, accuracy=COARSE)  # its pixels, too


@pytest.fixture(scope="module")
def told() -> list[str]:
    return []


@pytest.fixture(scope="module")
def row(told: list[str]) -> Row:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(lockstep, "INTERVAL", 0.1)
        return read_row(SMALL, told.append)


@library
def test_it_says_how_far_a_row_is(row: Row, told: list[str]):
    done = [int(text.split()[1]) for text in told if text.endswith("cycles of the circuit")]
    assert done == sorted(done) and len(set(done)) > 2 and done[-1] <= row.run.stats["circuit_cycles"]


@library
def test_a_sample_converts_as_in_the_model(row: Row):
    (sample,) = row.samples
    assert abs(sample.code - sample.expected) <= 1 and (sample.code == sample.expected) == (sample.why is None)
    assert abs(sample.why[1] if sample.why else 0.0) < 1.0  # LSB from the level at which they part
    assert row.run.cycles.deciding.sum() >= 8 and row.run.attempts == 1


@library
@pytest.mark.parametrize("seed", [29, 10])  # values 44 and 212: at the ends the switches' charges have two signs
def test_a_level_is_where_it_is_at_rest(seed: int):
    """A column's switch that opens with the lane's sample moves the level by -0.6 LSB at 44."""
    row = read_row(replace(SMALL, seed=seed, pixels=False))
    assert np.abs(row.level_off).max() < 0.05 and np.abs(row.at_lane).max() < 0.01
    assert not row.differences.any()


@library
def test_pixels_give_the_charge_of_two_milliseconds_from_one_cycle(row: Row):
    """The wells, the column's charge amplifiers and the sample together: the value of models/afe."""
    (sample,), cycles = row.samples, row.run.cycles
    sampled = (np.flatnonzero(cycles.hold)[0] + 1) * SMALL.timing.period
    at_lane = np.interp(sampled, row.run.time, row.run.waves["in0"])
    value = (at_lane - 0.5 * (SMALL.spec.refp + SMALL.spec.refn)) / SMALL.spec.lsb + 128
    assert value == pytest.approx(sample.value, abs=0.2)  # 0.08 % of the charge amplifiers' gain
    assert row.run.stats["cycles"] > SMALL.t_int > 100 * row.run.stats["circuit_cycles"]


@pytest.mark.parametrize(
    ("fault", "code"), [(None, 111), ("comparator:0", -128), ("capacitor:0:6", 115), ("diodes:0", -111), ("row:0", 0)]
)
def test_the_dictionary_knows_what_each_fault_does(fault: str | None, code: int):
    planted = Fault.parse(fault) if fault else None
    assert code_of(value_of(110.8, 0, True, planted), 0, False, 0, planted) == code


@library
def test_every_decision_is_made_in_its_half_cycle(row: Row):
    times = row.decision[row.run.cycles.deciding & row.run.cycles.hold.cumsum()[:, None].astype(bool)]
    made = times[np.isfinite(times)]
    assert made.size >= 8 and (made > 0).all() and made.max() < 0.5 * SMALL.timing.period


@library
def test_time_points_lie_on_every_corner_of_what_turns(row: Row):
    """No step goes past a corner of the drive, and a corner is none where nothing turns."""
    cycles, timing, time = row.run.cycles, SMALL.timing, row.run.time
    starts = np.arange(len(cycles.hold)) * timing.period
    decides, turns = cycles.deciding[:, 0], np.diff(cycles.asked[:, 0], prepend=0) != 0
    assert decides.sum() > 7 and turns.sum() > 7
    for first, corner in (
        (starts, 0.0),
        (starts[turns], timing.edge),
        (starts[decides], timing.high),
        (starts[decides], timing.high + timing.edge),
    ):
        assert np.abs(time[:, None] - (first + corner)).min(0).max() < 1e-15
    of_cycle = np.histogram(time, np.append(starts, starts[-1] + timing.period))[0]
    at_rest = ~decides & ~cycles.hold & ~turns
    assert of_cycle[at_rest].min() < 0.2 * np.median(of_cycle[decides])


@library
def test_waves_hold_both_sides(row: Row, tmp_path):
    write_vcd(tmp_path / "w.vcd", row.run, SMALL.timing.period)
    text = (tmp_path / "w.vcd").read_text()
    head, _, body = text.partition("$enddefinitions $end\n")
    assert "$var real 64" in head and "dac" in head and "xlane0_top" in head
    times = [int(line[1:]) for line in body.splitlines() if line.startswith("#")]
    assert times == sorted(times) and times[-1] <= row.run.time[-1] / 1e-14 + 1


@library
@pytest.mark.slow
def test_the_amplifier_of_a_lane_is_in_the_loop():
    """Pixel, amplifier and converter together give the model's value with the amplifier's fitted curve."""
    row = read_row(replace(SMALL, mode="edge", amplifier=True))
    (sample,) = row.samples
    assert not row.beyond.any() and abs(sample.value) > 10
    assert abs(row.at_lane[0]) < 0.002 * abs(sample.value)  # 0.0008 of the columns' amplifiers, 1e-3 of ngspice
    timing, number = row.request.timing, row.run.cycles.number
    (light,) = np.flatnonzero(np.diff(number, prepend=0) > SMALL.t_int)
    for corner in (0.5 * timing.period, 0.5 * timing.period + timing.edge):  # light ends; clk fell before
        assert np.abs(row.run.time - (light * timing.period + corner)).min() < 1e-15


@library
@pytest.mark.slow
@pytest.mark.parametrize("mode", ["edge", "image"])
def test_the_column_amplifiers_are_in_the_loop(mode):
    """From the well's charge on all is transistors; in image mode it is a sum of charges, not arithmetic."""
    row = read_row(replace(SMALL, mode=mode, amplifier=True, columns=True))
    (sample,) = row.samples
    assert abs(row.at_lane[0]) < 1 and abs(sample.code - sample.expected) <= 1
    assert row.run.attempts == 1 and row.transistors > 400  # 337 with columns of arithmetic


@library
@pytest.mark.slow
@pytest.mark.parametrize("mode", ["edge", "image"])
@pytest.mark.needs("layout")
def test_a_drawn_row_begins_as_the_trim_leaves_it(mode):
    """From 0 V an inner node of the gates moved a line by 1 mV, half an LSB of a sum."""
    row = read_row(RowRequest(mode=mode, cols=6, lanes=1, types=1, amplifier=True, columns=True, extracted=True))
    assert np.abs(row.at_lane).max() < 0.2 and row.decks[0].repeated == 0


@pytest.mark.slow
@pytest.mark.parametrize("edge", [True, False])
def test_a_trim_depends_on_no_tolerance(monkeypatch, edge):
    """Where ngspice gave up, a looser rung of the ladder had another level: 0.8 mV off."""
    of = ColumnSpec.of(), edge, 100e-9, 1.8
    found = columns.trimmed(*of)
    monkeypatch.setattr(columns, "EXACT", replace(columns.EXACT, reltol=1e-5))
    tight = columns.trimmed.__wrapped__(*of)
    assert found.repeated == tight.repeated == 0
    assert np.abs(np.subtract(found.start, tight.start)).max() < 2e-4  # 0.1 LSB; both diodes alike
    assert 0.55 < found.rest["vbp"] < 0.58 and found.column.keys() == tight.column.keys()


@pytest.mark.parametrize("count", [1, 3])
def test_clear_has_the_capacitance_of_all_columns(count):
    """With that of the deck's columns alone a drawn difference was 0.6 LSB off where the deck had two more."""
    spec, trim = ColumnSpec.of(), columns.Trim((1.2, 1.2), {"vbp": 0.5}, {"line_a": 0.5}, 0)
    diodes, lanes = {c: {0: (0.0, 0.0)} for c in range(count)}, dict.fromkeys(range(count), 0)
    deck = columns.lines(diodes, lanes, "edge", 1.0, spec, column_size(spec, analog), PixelSizes(), trim, 6)
    (others,) = (float(line.split()[3]) for line in deck if line.startswith("Cclear "))
    assert others + count * columns.CLEAR_FARAD == pytest.approx(spec.array * columns.CLEAR_FARAD)


@library
@pytest.mark.slow
def test_a_sum_does_not_depend_on_its_turn():
    """With 5 pF at the bias's lines alone it was 0.2 LSB less from turn to turn."""
    row = read_row(replace(SMALL, types=3, amplifier=True, columns=True))
    assert len(row.samples) == 3 and np.abs(row.at_lane).max() < 0.4 and not row.beyond.any()


@library
@pytest.mark.slow
@pytest.mark.needs("layout")
def test_the_drawn_circuits_are_in_the_loop():
    """As drawn, with all parasitics: the plates' ends and the comparator's have other names in the waves."""
    row = read_row(replace(SMALL, extracted=True))
    assert abs(row.at_lane[0]) < 0.3 and abs(row.level_off[0]) < 0.26 and not row.beyond.any()
    assert row.run.attempts == 1 and len(row.decks[0].lines) > 5000  # 160 of schematics, besides the models


def test_every_node_of_a_drawn_net_begins_where_the_net_does():
    ends = (
        Resistor("w0", "cin", "cin__1", 5.0),
        Resistor("w1", "cin__1", "cin__2", 5.0),
        Resistor("w2", "x", "x_1", 5.0),
    )
    drawn = {"column": Circuit("column", ("x",), resistors=ends)}
    calls = ["Xcolumn3 a column", "Xother3 a other"]
    body = [*calls, ".ic v(xcolumn3.cin)=1.6 v(xother3.cin)=2", ".ic v(xcolumn3.xback_a.x)=0.5 v(top)=1"]
    assert as_drawn(body, drawn) == [
        *calls,
        ".ic v(xcolumn3.cin)=1.6 v(xcolumn3.cin__1)=1.6 v(xcolumn3.cin__2)=1.6 v(xother3.cin)=2",
        ".ic v(xcolumn3.back_a.x)=0.5 v(top)=1",
    ]


def test_every_net_inside_a_circuit_has_the_name_that_spice_gives_it():
    of = columns.nets(column(column_size(ColumnSpec.of(), analog)))
    assert {"cin_a", "xback_a.x", "xback_a.xtap3.inner", "xon1.m"} <= set(of) and not set(PINS) & set(of)


def test_faults_are_those_of_schematics():
    with pytest.raises(ParameterError, match="fault = .*: must be none with extracted circuits"):
        replace(SMALL, extracted=True, fault=Fault("row", (1,)))


@pytest.mark.parametrize("mode", ["edge", "image", "tof"])
def test_the_model_has_the_columns_curves(mode: str):
    """A value is what `make analog` measured that a column gives of its charge."""
    ideal = replace(SMALL, mode=mode)
    asked = replace(ideal, amplifier=True, columns=True)
    fills, curves = asked.samples / DIODE, circuit_columns()
    edge = mode == "edge"
    taps = [curves.delivered(tap) if edge else curves.summed(tap, later=i > 0) for i, tap in enumerate(fills)]
    wanted = DIODE * np.stack(taps)
    assert asked.delivered == pytest.approx(wanted) and not np.allclose(wanted, asked.samples, rtol=1e-3)
    assert ideal.delivered is ideal.samples


def test_columns_need_the_lanes_amplifiers():
    assert replace(SMALL, amplifier=True, columns=True).frame[1].timing.t_read == 16
    with pytest.raises(ParameterError, match="columns = True: must be False without amplifier"):
        replace(SMALL, columns=True)


def test_an_amplifier_needs_a_difference_and_a_clock_that_is_low_for_longer():
    assert replace(SMALL, mode="edge", amplifier=True).clock.high == STROBE_TYPICAL < SMALL.clock.high
    with pytest.raises(ParameterError, match="columns = False: must be True in mode raw"):
        replace(SMALL, mode="raw")
    for wrong in (SMALL, replace(SMALL, mode="edge", pixels=False)):
        with pytest.raises(ParameterError, match="amplifier = True: must be False"):
            replace(wrong, amplifier=True)


def test_only_lanes_that_the_row_reads_are_built():
    whole = RowRequest(mode="image", cols=12, lanes=4, types=1)
    (lean,) = replace(whole, partition=False).decks()
    (full,) = replace(whole, everything=True).decks()
    assert lean.lanes == (0, 1) and full.lanes == (0, 1, 2, 3)
    assert lean.answers[2:] == ["-", "-"] and full.transistors > 1.9 * lean.transistors - 20


def test_each_lane_with_its_columns_is_a_part():
    row = RowRequest(mode="image", cols=12, lanes=4, types=2, fault=Fault("row", (2,)))
    (whole,), parts = replace(row, partition=False).decks(), row.decks()
    assert [part.lanes for part in parts] == [(0,), (1,)] and whole.lanes == (0, 1)
    assert tuple(sorted(c for part in parts for c in part.columns)) == whole.columns
    assert [part.answers for part in parts] == [["q0", "-", "-", "-"], ["-", "q1", "-", "-"]]
    for part in parts:  # a line passes the columns of the other lane, too
        (cut,) = (line.split() for line in part.lines if line.startswith("Rread2 "))
        assert cut[1:3] == ["read1", "read2"] and float(cut[3]) == PixelSizes().cut


@library
def test_parts_read_what_one_circuit_does():
    both = RowRequest(mode="image", cols=12, lanes=2, types=1, pixels=False, accuracy=COARSE, seed=3)
    apart, whole = read_row(both), read_row(replace(both, partition=False))
    assert [s.code for s in apart.samples] == [s.code for s in whole.samples]
    assert np.abs(apart.at_lane - whole.at_lane).max() < 0.04 and np.abs(apart.level_off).max() < 0.05
    assert apart.run.stats["circuit_cycles"] == whole.run.stats["circuit_cycles"]
    assert apart.run.waves.keys() == whole.run.waves.keys() and apart.transistors == whole.transistors


@library
def test_a_part_that_ngspice_gives_up_ends_all():
    both = RowRequest(mode="image", cols=12, lanes=2, types=1, pixels=False, accuracy=COARSE)
    sensor, frame = both.frame
    sound, other = both.decks()
    decks = sound, replace(other, lines=["* nothing", "Xnothing a b missing", ".end"])
    given = lockstep.program(sensor), lambda accuracy: decks, frame, both.samples, both.front_end, both.clock
    with pytest.raises(ToolError, match="gave up with every setting"):
        lockstep.run(*given, COARSE)


def test_a_fault_is_in_one_lane_alone():
    sound = RowRequest(mode="image", cols=12, lanes=2, types=1)
    (deck,) = replace(sound, partition=False, fault=Fault("capacitor", (1, 7))).decks()
    lines = [line for text in deck.lines for line in text.splitlines()]
    assert sum(line.endswith(" sar_lane_faulty") and line.startswith("Xlane1") for line in lines) == 1
    assert sum(line.startswith("Cbit7 ") for line in lines) == 1  # the sound lane's
    with pytest.raises(ParameterError, match="net b7 at device switch7: must have two ends"):
        Fault("capacitor", (1, 7)).of_lane(sar_lane(size(LaneSpec(), analog)), 1).check(analog)
    assert not any("faulty" in line for deck in sound.decks() for line in deck.lines)


@pytest.mark.parametrize("text", ["", "capacitor:1", "comparator:x", "diode:1", "row:", "comparator:1:2"])
def test_a_fault_that_is_none_is_refused(text: str):
    with pytest.raises(ParameterError, match=r"fault = .* must be one of"):
        Fault.parse(text)


def test_the_bodies_resistors_are_left_out_of_every_model_or_none():
    cards = analog.cards("tt", {("n_lvt", 1.0, 0.15), ("p_lvt", 1.0, 0.35)})
    lean = "\n".join(Accuracy().cards(cards))
    assert set(re.findall(r"rbodymod = (\S+)", lean)) == {"0"} and Accuracy(bodies=True).cards(cards) == cards


def test_the_ladder_ends_with_the_loosest():
    first, *rest = Accuracy().ladder
    assert first == Accuracy() and [step.method for step in rest] == ["gear"] * 3
    assert rest[-1].gmin > first.gmin and rest[-1].reltol > first.reltol


@library
def test_ngspice_that_gives_up_is_an_error_after_the_whole_ladder(monkeypatch):
    tried = []

    def gives_up(*arguments: object) -> None:
        tried.extend(one for one in arguments if isinstance(one, Accuracy))
        raise ToolError("the simulation stopped with status 5: timestep too small")

    monkeypatch.setattr(lockstep, "_run", gives_up)
    sensor, frame = SMALL.frame
    decks = SMALL.decks()
    given = lockstep.program(sensor), lambda accuracy: decks, frame, SMALL.samples, SMALL.front_end, SMALL.timing
    with pytest.raises(ToolError, match="gave up with every setting"):
        lockstep.run(*given, Accuracy())
    assert tried == list(Accuracy().ladder)


@pytest.mark.parametrize(
    ("field", "value"),
    [("mode", "rgb"), ("cols", 5), ("lanes", 3), ("types", 7), ("t_int", 0), ("threshold", 128), ("seed", -1)],
)
def test_requests_are_checked(field: str, value: object):
    with pytest.raises(ParameterError, match=field):
        RowRequest(**{field: value})  # pyright: ignore[reportArgumentType]
