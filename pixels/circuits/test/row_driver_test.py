"""The row's driver as data: values, codes, logic by its gates' functions, and what is broken is named."""

from dataclasses import replace
from itertools import product

import pytest

from talbot.models.parameters import STANDARD, ArrayParameters, ParameterError, drawn_lines
from talbot.pixels.circuits.row_driver import (
    BANK_INPUTS,
    BANK_OUTPUTS,
    CODES,
    ROW_LINES,
    SECTIONS,
    SIDES,
    RowDriverSpec,
    bank,
    nand_of,
    row,
    row_line,
    taken,
)
from talbot.platforms.sky130 import analog as process

SPEC = RowDriverSpec.of()


def settled(circuit, driven):
    """Levels of all nets of a circuit of inverters, NANDs and level shifters, given those of ``driven``."""
    levels = dict(driven)
    for _ in range(len(circuit.instances)):
        for one in circuit.instances:
            kind, nodes = one.circuit.name, one.nodes
            if kind == "lift":
                levels[nodes[1]] = levels.get(nodes[0], False)
            else:
                *inputs, output = nodes[:-2]
                levels[output] = not all(levels.get(net, False) for net in inputs)
    return levels


def chosen(amp, reset, **controls):
    found = {f"{side}_{group}": on for side, on in zip(SIDES, (amp, reset)) for group in CODES}
    return (
        found
        | dict.fromkeys(("pixel_reset", "shutter", "integrate", "read", "tap0", "tap1", "expose"), False)
        | controls
    )


def test_specification_is_the_sensors():
    assert SPEC.cols == 384 and SPEC.settle == 100e-9 and SPEC.high == 5.0


@pytest.mark.parametrize("changes", [{"cols": 0}, {"ohm": float("nan")}, {"high": 6.0}, {"idle": 0.0}, {"slew": -1}])
def test_a_value_out_of_range_is_refused_by_name(changes):
    with pytest.raises(ParameterError, match=f"{next(iter(changes))} = "):
        replace(SPEC, **changes)


def test_all_are_whole_and_what_is_broken_is_named():
    for one in (row(), bank(), row_line(SPEC)):
        one.check(process)
    with pytest.raises(ParameterError, match="circuit row_line: net n8 at device a8: must have two ends"):
        row_line(SPEC).without("b7").check(process)
    with pytest.raises(ParameterError, match="inputs = 5"):
        nand_of(5)


def test_a_line_has_the_resistance_and_capacitance_of_its_columns():
    line = row_line(SPEC)
    assert sum(r.value for r in line.resistors) == pytest.approx(384 * SPEC.ohm)
    assert sum(c.value for c in line.capacitors) == pytest.approx(384 * SPEC.farad)
    assert len(line.capacitors) == SECTIONS


@pytest.mark.parametrize("amp, reset", list(product((False, True), repeat=2)))
def test_a_line_is_high_with_its_phase_in_its_own_row(amp, reset):
    for line, phase in zip(ROW_LINES, ("pixel_reset", "shutter", "integrate", "read", "tap0", "tap1"), strict=True):
        levels = settled(row(), chosen(amp, reset, **{phase: True}) | {"closed": True, "open": False})
        wanted = reset if phase == "pixel_reset" else amp
        assert levels[line] == wanted
        assert not any(levels[other] for other in ROW_LINES if other != line)


def test_the_latch_opens_with_expose_and_closes_with_reset_or_integrate():
    whole, state = row(), {"closed": True, "open": False}

    def step(**controls):
        nonlocal state
        levels = settled(whole, chosen(True, True, **controls) | state)
        state = {name: levels[name] for name in ("closed", "open")}
        return levels["integrate_row"]

    assert not step() and step(expose=True) and step()
    assert step(integrate=True) and not step()
    assert step(expose=True) and step() and not step(pixel_reset=True) and not step()
    assert not step(expose=True, pixel_reset=True)  # a reset wins
    step(pixel_reset=True)
    assert not step()


def test_each_row_has_lines_of_its_own_and_the_bank_drives_them():
    codes = [tuple(taken(number).values()) for number in range(384)]
    assert len(set(codes)) == 384 and all(code < CODES[group] for one in codes for group, code in zip(CODES, one))
    for number in (0, 1, 77, 200, 383):
        driven = dict.fromkeys(BANK_INPUTS, False)
        driven |= {f"amp_row{bit}": bool(number >> bit & 1) for bit in range(10)}
        levels = settled(bank(), driven | {"read": True})
        high = {name for name in BANK_OUTPUTS if levels[name] and name.startswith("amp")}
        assert high == {f"amp_{group}{code}" for group, code in taken(number).items()}
        assert levels["read_line"] and not levels["tap0_line"]


@pytest.mark.parametrize("read, ref_ctl", list(product((False, True), repeat=2)))
def test_rows_are_read_once_the_columns_reset_has_ended(read, ref_ctl):
    """The chip's `read` has two halves, and in the first, with `ref_ctl`, the charge amplifiers are reset."""
    driven = dict.fromkeys(BANK_INPUTS, False) | {"read": read, "ref_ctl": ref_ctl}
    levels = settled(bank(), driven)
    assert levels["read_line"] == (read and not ref_ctl)


def test_lines_follow_the_pitch_and_too_long_ones_are_refused():
    wide = RowDriverSpec.of(replace(STANDARD, array=ArrayParameters(384, 384, 15e-6)))
    assert wide.ohm == drawn_lines(15.0).row_ohm > SPEC.ohm and wide.farad > SPEC.farad
    said = "array.cols = 1536: must be at most 955 .* \\(array.pitch = 1.5e-05, chip.f_clk = 1e\\+07\\)"
    with pytest.raises(ParameterError, match=said):
        RowDriverSpec.of(replace(STANDARD, array=ArrayParameters(384, 1536, 15e-6)))
