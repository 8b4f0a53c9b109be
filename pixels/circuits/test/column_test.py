"""A column as data: sizes follow from the specification, its decoder and the order of its phases by their gates."""

from dataclasses import replace

import pytest

from talbot.models.parameters import STANDARD, ArrayParameters, ParameterError, SensorParameters
from talbot.pixels.circuits import column as columns
from talbot.pixels.circuits import column_block as block
from talbot.pixels.circuits.column import TAPS, column, holder
from talbot.pixels.circuits.column_block import BANK_INPUTS, bank, column_bias, taken
from talbot.pixels.circuits.column_sizes import ColumnSpec, size
from talbot.platforms.sky130 import analog as process

SPEC = ColumnSpec.of()
SIZES = size(SPEC, process)
COLUMN = column(SIZES)


def settled(circuit, driven):
    """Levels of all nets of a circuit's inverters, NANDs and NORs, given those of ``driven``."""
    levels = dict(driven)
    for _ in range(len(circuit.instances)):
        for one in circuit.instances:
            kind, (*inputs, output) = one.circuit.name, one.nodes[:-2]
            if kind.startswith(("inv", "nand")):
                levels[output] = not all(levels.get(net, False) for net in inputs)
            elif kind == "clear_pulse":
                levels["clear"] = settled(one.circuit, {"ref": levels.get("ref", False), "ramp": driven["ramp"]})[
                    "clear"
                ]
            elif kind.startswith("nor"):
                levels[output] = not any(levels.get(net, False) for net in inputs)
    return levels


def lines(**driven):
    return settled(bank(SIZES), dict.fromkeys((*BANK_INPUTS, "ramp"), False) | driven)


def test_specification_is_the_sensors():
    assert SPEC.cycle == 100e-9 and SPEC.swing == pytest.approx(127.5 * 4 * 1.2 / 256 / 2.4) and SPEC.columns == 48
    assert SPEC.line == pytest.approx(384 * 2.088e-15)
    assert SPEC.well == pytest.approx(1e5 * 1.602e-19 / 0.5, rel=1e-3)
    assert SPEC.noise == pytest.approx(5e4**0.5)
    assert SPEC.energy == 70e-12  # 300 uW over 30 frames of 384 x 384 pixels a second, to one digit
    few = replace(SensorParameters(), chip=replace(SensorParameters().chip, lanes=4))
    assert ColumnSpec.of(few).columns == 96


@pytest.mark.parametrize(
    "changes",
    [
        {"fall": 0.8},
        {"dark": float("nan")},
        {"settle": 3},
        {"ready": 1e-6},
        {"slope": 0},
        {"columns": 0.5},
        {"array": 0},
    ],
)
def test_a_limit_out_of_range_is_refused_by_name(changes):
    with pytest.raises(ParameterError, match=f"{next(iter(changes))} = "):
        replace(SPEC, **changes)


@pytest.mark.parametrize("changes", [{"feedback": 0.0}, {"gain": 17}])
def test_a_size_out_of_range_is_refused_by_name(changes):
    with pytest.raises(ParameterError, match=f"{next(iter(changes))} = "):
        replace(SIZES, **changes)


def test_currents_follow_from_time_and_load():
    """Twice the time of the signal half, half the current; twice the lane's wire, more for the lane alone."""
    slower = size(replace(SPEC, read=32), process)
    assert 0.45 < slower.front.current / SIZES.front.current < 0.52
    assert slower.lane.current == pytest.approx(SIZES.lane.current)
    longer = size(replace(SPEC, wire=2 * SPEC.wire), process)
    assert 1.3 < longer.lane.current / SIZES.lane.current < 2 and longer.front == SIZES.front


def test_inputs_of_the_charge_amplifiers_are_as_alike_as_the_offset_asks():
    """What their thresholds differ by is doubled, at both diodes: half of the limit."""
    millivolts = process.AREA["n"] / (SIZES.front.input * 2.0) ** 0.5
    unlike = 1e-3 * millivolts * SPEC.swing / SPEC.fall * 2**0.5 / SPEC.lsb
    assert unlike == pytest.approx(0.5 * SPEC.offset, rel=0.01)
    assert size(replace(SPEC, offset=2.0), process).front.input == pytest.approx(4 * SIZES.front.input, rel=0.01)


def test_a_source_of_current_is_as_many_as_it_has_parts_of_the_biass():
    """Of other widths they are less alike than their ratio says."""
    bias = {one.name: (one.w / one.fingers, one.l) for one in column_bias(SIZES).transistors if one.fingers}
    assert bias["vbp_top"] == bias["level_top"] == bias["vcn_top"] == (SIZES.front.top, 3.3)
    ends = {one.name: one for one in block.lane_end(SIZES).transistors if one.fingers}
    for name in ("top", "cascode_p"):
        assert ends[name].fingers == 16
        assert bias[f"vbl_{name.removesuffix('_p')}"] == pytest.approx((ends[name].w / 16, ends[name].l))


def test_the_feedback_is_the_well_less_what_is_lost():
    assert 0.97 < SIZES.feedback / (2 * SPEC.fall / SPEC.swing * SPEC.well) < 1


def test_all_are_whole_and_what_is_broken_is_named():
    for one in (
        COLUMN,
        column_bias(SIZES),
        block.lane_end(SIZES),
        block.cascode_lines(),
        block.lane_line(SIZES, SPEC),
        bank(SIZES),
    ):
        one.check(process)
    with pytest.raises(ParameterError, match="circuit tap: net inner at device hold: must have two ends"):
        COLUMN.replaced(columns.tap(SIZES).without("join").without("write")).check(process)
    with pytest.raises(ParameterError, match="circuit column: net go_a at device back_a: must have two ends"):
        COLUMN.without("go_a").without("stop_a").check(process)


def test_of_a_sum_each_diode_has_a_quarter_of_the_firsts_capacitors():
    """The rest is at no output then: half an LSB of the lane for each of a diode, instead of two."""
    parts = {one.name: one.value for one in COLUMN.capacitors}
    assert parts["in_a"] == parts["in_quarter"] == parts["in_half"] / 2 == parts["in_b"] / 4
    assert parts["in_b"] == pytest.approx(SIZES.gain * SIZES.hold)


def test_the_first_diode_has_a_capacitor_for_each_tap():
    taps = {one.circuit.name: sum(i.circuit.name == "tap" for i in one.circuit.instances) for one in COLUMN.instances}
    assert taps[holder(SIZES, TAPS).name] == TAPS and taps[holder(SIZES, 1).name] == 1


def test_each_column_of_a_lane_has_lines_of_its_own():
    found = [taken(number, 8) for number in range(384)]
    codes = [(lane, *code.values()) for lane, code in found]
    assert len(set(codes)) == 384 and max(code["group"] for _, code in found) == 7
    assert found[5 * 6 + 3] == (5, {"group": 0, "k": 3}) and found[8 * 6] == (0, {"group": 1, "k": 0})


@pytest.mark.parametrize("number", [0, 5, 77, 383])
def test_a_turn_selects_one_column(number):
    _, code = taken(number, 8)
    position = {f"{name}{bit}": bool(code[name] >> bit & 1) for name in code for bit in range(3)}
    high = {
        name
        for name, on in lines(hold=True, **position).items()
        if on and name.rstrip("0123456789") in ("group_", "k_")
    }
    assert high == {f"group_{code['group']}", f"k_{code['k']}"}
    assert not any(lines(hold=False, **position)[f"group_{g}"] for g in range(block.GROUPS))


def test_the_phases_of_a_row():
    quiet = lines()
    assert not any(quiet[name] for name in ("clear", "reads", "ref", "sig", "w0", "f0"))
    assert all(quiet[name] for name in ("readsn", "fn0", "idle"))
    first = lines(read=True, ref_ctl=True, tap1=True)
    assert first["clear"] and first["ref"] and first["w2"] and not first["w0"] and not first["sig"]
    assert not first["fn2"] and not first["f2"] and first["fn0"] and not first["idle"]  # the far end is at start, and f
    assert not lines(read=True, ref_ctl=True, ramp=True)["clear"]
    second = lines(read=True, tap1=True)
    assert second["sig"] and second["w2"] and second["f2"] and not second["fn2"] and not second["f0"]
    assert not second["ref"] and not second["clear"] and not second["sign"]
    assert first["reads"] and second["reads"]


def test_modes_and_sub_samples():
    assert lines()["edge"] and not lines(mode0=True)["edge"] and lines(mode0=True)["edgen"]
    for sub in range(TAPS):
        levels = lines(mode0=True, sub0=bool(sub & 1), sub1=bool(sub & 2))
        assert [levels[f"unasked{t}"] for t in range(TAPS)] == [t != sub for t in range(TAPS)]
        assert not any(levels[f"f{t}"] for t in range(TAPS))
        levels = lines(hold=True, mode0=True, sub0=bool(sub & 1), sub1=bool(sub & 2))
        assert [levels[f"f{t}"] for t in range(TAPS)] == [t == sub for t in range(TAPS)] and not levels["idle"]


@pytest.mark.parametrize("sub", [0, 1])
def test_in_raw_mode_each_diode_has_a_turn_alone(sub):
    """A turn takes charge of the samples that it joins: the first diode's is in tap 1, the second's in tap 0."""
    raw = {"mode1": True, "sub0": bool(sub)}
    written, turn = lines(read=True, **raw), lines(hold=True, **raw)
    assert [written[name] for name in ("w0", "w0_a", "w1", "w2", "w3")] == [True, False, True, False, False]
    assert [written[name] for name in ("f0", "f0_a", "f1")] == [True, False, True]
    assert [turn[f"unasked{t}"] for t in range(TAPS)] == [t == sub for t in range(2)] + [True, True]
    assert turn["edge"] and turn["turnb"] and [turn[f"f{t}"] for t in range(2)] == [bool(sub), not sub]
    plain = lines(read=True)
    assert plain["w0"] and plain["w0_a"] and not plain["w1"] and plain["f0_a"] == plain["f0"]


def selected(**driven):
    unasked = {f"unasked{t}": True for t in range(TAPS)}
    return settled(COLUMN, {"group": False, "k": False} | unasked | driven)


def test_a_column_in_its_turn():
    """Its tap that is asked for is joined; one that is not selected has none, and its drive is off."""
    turn = selected(group=True, k=True, unasked2=False)
    assert turn["sel"] and not turn["seln"] and [turn[f"s{t}"] for t in range(TAPS)] == [False, False, True, False]
    for other in (selected(group=True, unasked0=False), selected(k=True, unasked0=False)):
        assert not other["sel"] and not other["s0"]


def test_lines_follow_the_pitch_and_drawn_columns_refuse_more_capacitance():
    def sensor(rows, cols, pitch=13.5e-6):
        return replace(STANDARD, array=ArrayParameters(rows, cols, pitch))

    wide = ColumnSpec.of(sensor(384, 384))
    assert wide.line > SPEC.line and wide.wire > SPEC.wire and wide.ohm > SPEC.ohm
    assert ColumnSpec.of_drawn(STANDARD) == SPEC and ColumnSpec.of_drawn(sensor(200, 200)).line < SPEC.line
    with pytest.raises(ParameterError, match=r"array.rows = 384: must be at most 228 at array.pitch = 1.5e-05"):
        ColumnSpec.of_drawn(sensor(384, 200, 15e-6))
    with pytest.raises(ParameterError, match=r"array.cols = 384: must be at most 263 at array.pitch = 1.5e-05"):
        ColumnSpec.of_drawn(sensor(200, 384, 15e-6))
