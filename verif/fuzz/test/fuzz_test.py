"""A part of the fuzzing for `make test`; it detects a wrong decoder."""

import json
import time

import pytest

from talbot.base.command import main
from talbot.models.digital.stream import decode_stream
from talbot.verif.fuzz import batch, checks, command, host, resync
from talbot.verif.fuzz.streams import KINDS

SEED = 20


def test_a_batch_of_every_kind(tmp_path):
    found = batch.run_batch(SEED, 0, 3000, tmp_path)
    assert found.failures == []
    assert set(found.kinds) == set(KINDS) and sum(found.outcomes.values()) == 3000
    assert found.outcomes["frames"] > 1500 and found.outcomes["refused"] > 100
    assert not list(tmp_path.iterdir())


def test_an_input_is_made_from_its_numbers_alone():
    pool = batch.make_pool(SEED, 7)
    for index in (0, 1, 2500):
        assert batch.make_input(SEED, 7, index).data == batch.make_input(SEED, 7, index, pool).data
    assert batch.make_input(SEED, 7, 1).data != batch.make_input(SEED, 8, 1).data


def crash(data, tile):
    if len(data) % 7 == 3:
        raise IndexError("index 4 is out of bounds")
    return decode_stream(data, tile)


def falsify(data, tile):
    frames = decode_stream(data, tile)
    for frame in frames:
        frame.samples[frame.layout.rows[0]] ^= 1
    return frames


def slow(data, tile):
    end = time.thread_time() + 0.02
    while time.thread_time() < end:
        pass
    return decode_stream(data, tile)


def greedy(data, tile):
    return decode_stream(data, tile) if len(data) % 7 != 3 else bytearray(2 * batch.MEMORY_MAX)


@pytest.mark.parametrize(
    "wrong, error",
    [
        (crash, "IndexError: index 4"),
        (falsify, "Broken: other samples"),
        (slow, "TimeoutError: 0.0"),
        (greedy, "MemoryError"),
    ],
)
def test_a_wrong_decoder_is_seen_and_its_input_kept(tmp_path, monkeypatch, wrong, error):
    monkeypatch.setattr(checks, "decode_stream", wrong)
    monkeypatch.setattr(batch, "SECONDS_MAX", 0.01 if wrong is slow else 10)
    monkeypatch.setattr(batch, "FILE_EVERY", 10**9)
    found = batch.run_batch(SEED, 0, 60, tmp_path)
    first = found.failures[0]
    assert any(f.error.startswith(error) for f in found.failures) and first.target == "decoder"
    kept = (tmp_path / f"failing-{SEED}-0-{first.index}.bin").read_bytes()
    assert kept == batch.make_input(SEED, 0, first.index).data


@pytest.mark.parametrize("target", host.TARGETS)
def test_host_and_registers(target):
    for index in range(60):
        host.TARGETS[target](batch.generator(SEED, index))


@pytest.mark.parametrize("name", resync.FRAMES)
@pytest.mark.parametrize(
    "around", ["followed by bytes", *(pytest.param(name, marks=pytest.mark.slow) for name in resync.AROUND[:-1])]
)
def test_one_wrong_byte_anywhere_in_a_frame_of_every_mode(name, around):
    """Two values at every byte; `talbot fuzz` tries more, and larger frames."""
    found = resync.sweep(name, around, 2, SEED, (12, 20))
    assert found.failures == [] and found.tried == 2 * found.bytes > 100
    assert bool(found.row_lost) == (around == "followed by bytes")


def test_a_row_lost_in_secret_is_seen(monkeypatch):
    frame = resync.real_frame("image", (12, 20))
    monkeypatch.setattr(resync, "decode_stream", lambda data: falsify(data, resync.request().sensor.tile))
    with pytest.raises(AssertionError, match="byte 40 xor 0x03, alone: rows .* are wrong"):
        resync.check_position(frame, 40, 3, "alone")


def test_the_command(tmp_path, capsys):
    few = ["--inputs", "300", "--changes", "0", "--cycles", "0", "--seed", "3"]
    assert main(command, [*few, "--out", str(tmp_path)]) == 0
    found = json.loads((tmp_path / "fuzz.json").read_text())
    assert found["Decoder"]["fuzz"]["inputs"] == 300 and found["Host"]["fuzz"]["inputs"] == 60
    assert main(command, ["--only", "2", "17"]) == 0 and " ms" in capsys.readouterr().out
    assert main(command, ["--inputs", "-1"]) == 2
    assert capsys.readouterr().err == "verif.fuzz: error: inputs = -1: must be an integer in 0..1000000000\n"
