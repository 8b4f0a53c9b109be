"""Sessions at the chip's pins: the golden chip agrees; planted bugs are found, of the interface contract and others."""

import re

import numpy as np
import pytest

from talbot.base.tools import ToolError
from talbot.models.digital.host import command, read_transfer, write_transfers
from talbot.models.parameters.registers import register_map
from talbot.rtl.contract import contract
from talbot.verif.fuzz.checks import Broken
from talbot.verif.fuzz.chip import guided
from talbot.verif.fuzz.chip.golden import check
from talbot.verif.fuzz.chip.program import CHIPS, METASTABLE, chip_verilog, metastable, parse, program, run_sessions
from talbot.verif.fuzz.chip.sessions import Maker, Operation, Session, read, transfer

NAME = next(iter(CHIPS))
SENSOR = CHIPS[NAME]
CHIP = register_map()


def written(**values):
    """Transfers that write registers, and 0 to the rest of their bytes."""
    image = CHIP.image([CHIP[key] for key in values], values)
    return [transfer(data) for data in write_transfers(sorted(image.items()))]


SHORT = dict.fromkeys(("t_reset", "t_int", "t_cm", "t_settle", "t_read", "t_guard"), 2)
FRAME = [transfer(command("start")), Operation("E", 20_000), transfer(read_transfer(3, 1))]


def session(*operations):
    return Session(7, 8, (Operation("R", 4), *operations))


TOF = session(*written(mode=3, phase=1, overlap=1, mask=0xFFFFFF, **SHORT), *FRAME)
EDGE = session(
    *written(mode=0, overlap=1, threshold=4, mask=0xFFFFFF, **SHORT), *FRAME, transfer(read_transfer(88, 24))
)


def test_sessions_are_lines_and_reproducible():
    maker, again = (Maker(SENSOR, np.random.default_rng(3)) for _ in range(2))
    for _ in range(50):
        first, second = maker.session(), maker.session()
        mutated = maker.mutated(first, second)
        assert read(mutated.line) == mutated and mutated.operations[0].kind == "R"
        assert mutated == again.mutated(again.session(), again.session())


def test_an_observation_is_read():
    run = parse("3 900 o 12 0 0 0 - o 80 2 1 1 00000000 b 0 0 0 0 1 0 1 1 1 1 1 2 1 0 2 1 0 2 s 1540ff", True)
    assert (run.fresh, run.cycles, run.link) == (3, 900, [0x154, 0xFF])
    (byte,) = run.operations[1].bytes
    assert byte.effect == [(0, 0, 0), (0, 1, 0)] and byte.aborted == 2 and byte.fetch == [(1, 0, 2), (1, 0, 2)]


def test_a_synchronizer_more_is_an_error():
    good = "module Synchronizer\n logic [1:0] stages;\nstages <= { stages[1'd0], pin };\n" + "  Synchronizer a\n" * 4
    assert METASTABLE in metastable(good)
    with pytest.raises(ToolError, match="synchronizers = 5, of 1 modules: must be 4"):
        metastable(good + "  Synchronizer b\n")


def test_the_contract_has_every_line_of_the_document():
    from talbot.verif.formal.owners import contract as lines

    assert sorted(re.findall(r'broken\("(\w+)"\)', contract(2, True))) == sorted(lines())
    assert "phase__" not in contract(2, False)


MARK = "bank__scan__msg.data[9]"


def turned(mask, where=MARK):
    """A change of bits of samples to PhasePath."""
    change = f"{{12{{P & bank__scan__msg.kind == 2'd2 & {where}}}}} & 12'h{mask}"
    return "assign phase__recv__msg = bank__scan__msg", f"assign phase__recv__msg = bank__scan__msg ^ ({change})"


# Bugs of the chip: text of the Verilog, its replacement with P for a plusarg, the line of the contract that is broken
BROKEN = {
    "mode": ("assign bank__mode = regs__cfg.mode", "OLD ^ {2'd0, P & hold}", "configuration_of_the_bank"),
    "threshold": (
        "assign bank__threshold = regs__cfg.threshold",
        "OLD ^ {6'd0, P & bank__scan__val}",
        "configuration_of_the_bank",
    ),
    "row_inside": (*turned("c00"), "steps_are_whole"),
    "end_inside": (*turned("400"), "steps_are_whole"),
    "no_mark": (*turned("200"), "steps_are_equal"),
    "early_mark": (*turned("200", "bank__scan__msg.data[1]"), "steps_are_equal"),
    "phase": ("assign phase__on = phase_on", "OLD & ~(P & frame_sync)", "phase_is_constant"),
    "done": ("assign seq__amp_done = amp__done", "OLD | P & ~seq__hold_free", "rows_are_free"),
    "no_wait": ("assign amp__hold_free = seq__hold_free", "OLD | P", "rows_are_free"),
    "sync": ("assign frame_status__seq_busy = seq__busy", "OLD & ~P", "bytes_begin_while_busy"),
}
OTHERS = {
    "late_miso": (
        "assign miso = shift_out[7:7];",
        "logic was; always_ff @(posedge clk) was <= shift_out[7]; assign miso = P ? was : shift_out[7];",
    ),
    "unreset": ("if ( reset ) begin\n      snapshot <=", "if ( reset & ~P ) begin\n      snapshot <="),
    "lost_bit": ("assign phase__noise_floor = regs__cfg.noise_floor", "OLD & ~{P, 7'd0}"),
}


def planted(verilog, name, find, replace):
    """The chip with a bug that the plusarg ``name`` turns on, next to those in the same place."""
    assert find in verilog, name
    at = verilog.rindex("\n);\n", 0, verilog.index(find)) + 4  # where the ports of the module end
    declared = f'  logic plant_{name};\n  initial plant_{name} = $test$plusargs("{name}");\n'
    changed = re.sub(r"\bP\b", f"plant_{name}", replace.replace("OLD", find))
    return verilog[:at] + declared + verilog[at:].replace(find, changed)


@pytest.fixture(scope="module")
def bugs():
    """The chip with all bugs."""
    verilog = chip_verilog(NAME)
    for name, (find, replace, _) in BROKEN.items():
        verilog = planted(verilog, name, find, replace)
    for name, pair in OTHERS.items():
        verilog = planted(verilog, name, *pair)
    return program(NAME, verilog)


def problem(path, one, folder, *words, late=False):
    (run,) = run_sessions(path, [one.line], folder, late, words)
    try:
        check(SENSOR, one, run)
    except Broken as error:
        return str(error)
    return ""


needs_verilator = pytest.mark.needs("verilator")


@pytest.mark.slow
@needs_verilator
@pytest.mark.parametrize("name", BROKEN)
def test_a_broken_line_of_the_contract_stops_the_simulation(bugs, name, tmp_path):
    with pytest.raises(ToolError, match=f"interface contract = {BROKEN[name][2]}: is broken"):
        for one in (TOF, EDGE):
            run_sessions(bugs, [one.line], tmp_path, False, [f"+{name}"])


@pytest.mark.slow
@needs_verilator
def test_late_synchronizers_find_what_others_do_not(bugs, tmp_path):
    """`miso` a cycle late is within its limit unless a synchronizer takes a cycle more."""
    assert not problem(bugs, EDGE, tmp_path, "+late_miso")
    assert not problem(bugs, EDGE, tmp_path, late=True)
    assert "of the reply is" in problem(bugs, EDGE, tmp_path, "+late_miso", late=True)


@pytest.mark.slow
@needs_verilator
def test_a_register_without_reset_is_found(bugs, tmp_path):
    fetched = session(transfer(read_transfer(CHIP.counters[0].byte + 1, 7)))
    assert not problem(bugs, fetched, tmp_path)
    assert "byte 1 of the reply is" in problem(bugs, fetched, tmp_path, "+unreset")


@pytest.mark.slow
@needs_verilator
def test_a_search(tmp_path):
    """Every session is as the golden chip; the corpus is where the next search begins."""
    first = guided.search(NAME, 100_000, 1, tmp_path)
    assert first.failures == [] and first.cycles >= 100_000 and first.corpus > 20
    again = guided.search(NAME, 1, 2, tmp_path)
    assert again.sessions == guided.GROUP and again.points > first.points / 3


@pytest.mark.slow
@needs_verilator
def test_a_wrong_chip_is_found_and_its_session_kept(bugs, tmp_path, monkeypatch, capsys):
    """Guided sessions find a lost bit; the file of a failing one repeats it."""
    monkeypatch.setattr(guided, "program", lambda name, verilog="": bugs if verilog else program(name))
    monkeypatch.setattr(guided, "run_sessions", lambda *a: run_sessions(*a, words=["+lost_bit"]))
    found = guided.search(NAME, 100_000, 1, tmp_path, "with bugs")
    monkeypatch.undo()
    file = next(tmp_path.glob("*.session"))
    assert str(file) in found.failures[0] and guided.again(file) == []  # the chip itself is right
    assert "as the golden chip" in capsys.readouterr().out
