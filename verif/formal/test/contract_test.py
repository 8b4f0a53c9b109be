"""The interface contract: every assumption has an owner, and the chip keeps each in every cycle of whole frames."""

import dataclasses

import pytest

from talbot.models.digital.host import command, frame_writes
from talbot.models.parameters import ParameterError
from talbot.rtl.asp_chip import AspChip
from talbot.rtl.asp_chip.test.asp_chip_test import COLS, FRAMES, LANES, PHASE, ROWS, SENSOR
from talbot.rtl.harness.testbench import build
from talbot.verif.formal import contract, manifest, owners
from talbot.verif.formal.proof import Owner

SIZE = {"rows": ROWS, "cols": COLS, "lanes": LANES}


@pytest.fixture(scope="module")
def recorder():
    """The chip's traffic: frames of every mode with stalls, one that is aborted, a refused start, a reset."""
    recorder = contract.Recorder(SIZE)
    tile = SENSOR.tile
    chip = build(AspChip(ROWS, COLS, LANES, tuple(tile.order), tile.rows, tile.cols))
    bench = contract.RecordingBench(chip, recorder, stall=0.3)
    for frame in (FRAMES["raw, a window"], PHASE, FRAMES["tof, decimated"]):
        bench.reset()
        bench.registers = {}
        bench.write(frame_writes(frame))
        bench.start()
    bench.write(frame_writes(dataclasses.replace(FRAMES["every sample"], mask=0x000021)))
    bench.spi.transfer(command("start"))
    while not chip.frame_sync:
        bench.tick()
    bench.spi.transfer(bytes([0x80 | 0x20, 0xFF]))  # refused: the configuration is locked
    bench.spi.transfer(command("abort"))
    bench.write(frame_writes(PHASE))
    bench.start()
    assert bench.stream
    return recorder


@pytest.mark.slow
@pytest.mark.needs("verilator")
def test_the_chip_keeps_every_assumption_in_every_cycle(recorder):
    assert min(map(len, recorder.cycles.values())) > 2000
    assert list(recorder.violations()) == []


@pytest.mark.slow
@pytest.mark.needs("verilator")
@pytest.mark.parametrize(
    "name, changes, label",
    [
        ("readout_seq_7x31_2", lambda c: {"mask": c["mask"] ^ 1} if c["step__rdy"] else {}, "a_config"),
        ("byte_queue", lambda c: {"put": 1}, "a_put"),
        ("payload", lambda c: {"push": 1, "flush": 1}, "a_control"),
        ("edge_adc", lambda c: {"threshold": c["threshold"] ^ 1} if c["out__rdy"] else {}, "a_config"),
    ],
)
def test_a_neighbour_that_breaks_an_assumption_is_found(recorder, name, changes, label):
    cycles = [cycle | changes(cycle) for cycle in recorder.cycles[name]]
    broken = contract.Recorder(SIZE, {name: cycles})
    (proof,) = (proof for proof in manifest.every() if proof.name == name)
    assert label in {found for row in broken.rows(proof) for found in row}


def test_every_assumption_has_an_owner():
    assert owners.problems(manifest.every(), owners.contract()) == []
    assumed = {proof.name for proof in manifest.every() if any(o.contract for o in proof.assumptions.values())}
    first = {proof.wrapper: proof.name for proof in reversed(manifest.every()) if proof.name in assumed}
    assert set(first.values()) <= contract.BLOCKS.keys()  # the lines of the contract are checked at run time


def changed(label, owner, name="byte_queue"):
    """The proofs, with another owner of an assumption."""
    return [
        dataclasses.replace(proof, assumptions=proof.assumptions | {label: owner}) if proof.name == name else proof
        for proof in manifest.every()
    ]


@pytest.mark.parametrize(
    "owner, problem",
    [
        (Owner(), "no owner: must be proven of a neighbour, or in the contract of docs/chip.md"),
        (Owner(contract="nothing"), "contract nothing: must be a line of the contract in docs/chip.md"),
        (Owner("stream_9x13_2.p_nothing"), "stream_9x13_2.p_nothing: must be an assertion of a proof"),
        (Owner("stream_9x13_2.c_row"), "stream_9x13_2.c_row: must be an assertion of a proof"),
        (Owner("stream_9x13_2.p_queue"), r"! put | | ready: must be the text of stream_9x13_2.p_queue, ! put | | \dut"),
        (Owner("stream_9x13_2.p_time"), "must be the text of stream_9x13_2.p_time"),
    ],
)
def test_an_assumption_without_an_owner_is_an_error(owner, problem):
    (line,) = owners.problems(changed("a_put", owner), owners.contract())
    assert line.startswith("RunLength.byte_queue.a_put = ") and problem in line


def test_a_property_must_hold_wherever_it_is_assumed():
    proofs = manifest.every()
    stream = next(proof for proof in proofs if proof.name == "stream_9x13_2")
    text = stream.text.replace("      p_queue:", "      if (open) p_queue:")
    narrow = type("Narrow", (), {"name": stream.name, "text": text, "size_of": None, "assumptions": {}, "block": ""})()
    found = owners.problems([narrow, *(p for p in proofs if p is not stream)], owners.contract())
    assert found == ["RunLength.byte_queue.a_put = stream_9x13_2.p_queue under open: must hold wherever it is assumed"]


def test_a_line_that_nothing_assumes_is_an_error():
    found = owners.problems(manifest.every(), [*owners.contract(), "left_over"])
    assert found == ["contract left_over = no assumption: must be one of a proof"]


def test_an_owner_of_another_form_is_refused():
    for entry in ("RegFile p_write", {"proven": "a.b", "contract": "c"}, {}, None):
        with pytest.raises(ParameterError, match="assumptions.a_x = .*: must be definition"):
            owners.parse("a_x", entry)
