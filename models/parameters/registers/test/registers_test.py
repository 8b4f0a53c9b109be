"""The register map: its source, its encoding and its document agree."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from models.afe.trim import TRIM_BITS, TRIM_MAX, TRIM_MIN, trim_gain
from models.digital.registers import RegisterBank
from models.parameters import FrameParameters, ParameterError, SensorParameters, TileParameters
from models.parameters.registers import (
    command,
    decode_status,
    frame_writes,
    read_transfer,
    register_map,
    status_transfers,
    trim_range,
    write_transfers,
)
from models.parameters.registers.__main__ import markdown

CHIP = register_map()
FULL = SensorParameters().full_window


def test_no_two_fields_share_a_bit():
    seen = set()
    for f in CHIP.fields:
        bits = {(f.byte + (f.shift + i) // 8, (f.shift + i) % 8) for i in range(f.width)}
        assert not bits & seen, f.key
        assert f.lsb + f.width <= 8 * f.size
        seen |= bits
    assert max(address for address, _ in seen) < 128


def test_the_configuration_is_one_run_of_addresses_of_its_own():
    """The RTL locks it, and places the counters, by address range."""
    ours = CHIP.writable()
    others = {f.byte + i for f in CHIP.fields if f.access != "rw" for i in range(f.bytes)}
    assert not others & set(range(min(ours), max(ours) + 1))
    assert [f.byte for f in CHIP.counters] == [CHIP.counters[0].byte + 8 * i for i in range(3)]
    assert CHIP.counters[0].byte % 8 == 0
    sticky = [f for f in CHIP.fields if f.access == "w1c"]
    assert [f.shift for f in sticky] == list(range(sticky[0].shift, sticky[0].shift + len(sticky)))
    assert all(f.width == 1 and f.register == "status" for f in sticky)


def test_resets_are_the_default_parameters():
    writes = frame_writes(FrameParameters(FULL))
    assert dict(writes) == CHIP.image(CHIP.configuration)
    assert len(CHIP.trims) == TileParameters().n_types


def test_trims_are_the_front_ends():
    assert {f.width for f in CHIP.trims} == {TRIM_BITS} and all(f.signed for f in CHIP.trims)
    assert trim_range() == (TRIM_MIN, TRIM_MAX)
    assert trim_gain(CHIP.trims[0].reset) == 1


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


def test_the_document_names_every_field():
    text = markdown(CHIP)
    assert all(f"| {f.name} |" in text and f.description in text for f in CHIP.fields)
    assert "| 0x20 + 2 i | trim[0..23] |" in text
