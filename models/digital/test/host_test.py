"""What a host sends and receives over SPI, and what the register bank does with it."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from talbot.models.digital.host import (
    command,
    decode_status,
    frame_writes,
    read_transfer,
    status_transfers,
    write_transfers,
)
from talbot.models.digital.registers import RegisterBank
from talbot.models.parameters import FrameParameters, ParameterError, SensorParameters, TileParameters
from talbot.models.parameters.registers import register_map, trim_range

CHIP = register_map()
FULL = SensorParameters().full_window


def test_resets_are_the_default_parameters():
    writes = frame_writes(FrameParameters(FULL))
    assert dict(writes) == CHIP.image(CHIP.configuration)
    assert len(CHIP.trims) == TileParameters().n_types


@settings(max_examples=30, deadline=None)
@given(st.lists(st.integers(*trim_range()), max_size=24), st.integers(1, 2**24 - 1), st.integers(0, 127))
def test_what_is_written_is_what_the_bank_holds(trims, mask, threshold):
    bank = RegisterBank()
    for transfer in write_transfers(frame_writes(FrameParameters(FULL, mask=mask, threshold=threshold), trims)):
        assert transfer[0] & 0x80 and 2 <= len(transfer) <= 255
        for i, byte in enumerate(transfer[1:]):
            bank.write((transfer[0] & 0x7F) + i, byte, False, False)
    assert bank.value("mask") == mask and bank.value("threshold") == threshold
    for f, trim in zip(CHIP.trims, trims + [0] * (24 - len(trims)), strict=True):
        sign = 1 << f.width - 1
        assert (bank.value(f.key) ^ sign) - sign == trim


@pytest.mark.parametrize(
    "trims, field", [([trim_range()[1] + 1], "trim 0"), ([0, trim_range()[0] - 1], "trim 1"), ([0] * 25, "trims")]
)
def test_trims_out_of_range(trims, field):
    with pytest.raises(ParameterError, match=f"^{field} = "):
        frame_writes(FrameParameters(FULL), trims)


@pytest.mark.parametrize(
    "writes, field",
    [([(128, 0)], "address"), ([(5, 1), (-1, 0)], "address"), ([(3, 256)], "byte for address 3"), ([(3, -1)], "byte")],
)
def test_writes_of_what_is_no_byte(writes, field):
    with pytest.raises(ParameterError, match=f"^{field}.* = "):
        write_transfers(writes)


def test_status_round_trip():
    bank = RegisterBank()
    bank.set("done")
    bank.set("amp_err")
    counters = [2**63 + 5, 77, 0]
    replies = [
        bytes(1) + bytes(bank.read(t[0] + i, True, counters) for i in range(len(t) - 1)) for t in status_transfers()
    ]
    assert decode_status(replies) == {
        "busy": True,
        "done": True,
        "cfg_err": False,
        "amp_err": True,
        "refused": False,
        "aborted": False,
        "cycles": counters[0],
        "conversions_made": counters[1],
        "conversions_left_out": counters[2],
    }
    with pytest.raises(ParameterError, match="status replies"):
        decode_status(replies[:1])


def test_commands():
    assert command("start") == bytes((0x80 | CHIP["start"].byte, 1))
    assert read_transfer(5, 3) == b"\x05\0\0\0"
    for address, count in ((128, 1), (0, 0), (0, 255)):
        with pytest.raises(ParameterError):
            read_transfer(address, count)
