"""The drivers against the chip's Verilog: every function, every mode and every error, in Python and in C."""

import re

import numpy as np
import pytest

from talbot.models.chip import golden_frame
from talbot.models.digital.host import command, cycles_at_most, frame_values
from talbot.models.digital.pattern import PatternEnd
from talbot.models.parameters import (
    SHORT_TIMING,
    AmpTiming,
    ArrayParameters,
    ChipParameters,
    FrameParameters,
    SensorParameters,
    Window,
)
from talbot.models.parameters.registers import register_map
from talbot.rtl.host.driver import Code, Host, HostError
from talbot.rtl.host.test.bench import NEVER, Bench
from talbot.rtl.host.test.c_host import FOLDER, OUT_OF_ROOM, TRANSFER, CHost

ROWS, COLS, LANES = 10, 17, 2  # partial tiles at both edges
SENSOR = SensorParameters(array=ArrayParameters(ROWS, COLS), chip=ChipParameters(lanes=LANES))
FULL = SENSOR.full_window
CHIP = register_map()
LIMIT = 100_000  # cycles


def pattern(window=FULL, mode="edge", **fields):
    return FrameParameters(window, mode, test_pattern=True, **{"timing": SHORT_TIMING} | fields)


FRAMES = {
    "edge": pattern(frame_number=0xABCD),
    "every sample": pattern(threshold=0, overlap=False),
    "ternary": pattern(mode="ternary", threshold=6),
    "image, some types": pattern(mode="image", mask=0x8040A1),
    "raw, a window": pattern(Window(1, 2, 1, 2), "raw"),
    "tof": pattern(mode="tof", mask=0x030201),
    "tof, decimated": pattern(mode="tof", decimation=1, timing=AmpTiming(3, 4, 5, 6, 7, 8, 2)),
    "phase": pattern(Window(0, 2, 0, 2), "tof", mask=0x0F0F00, phase=True, noise_floor=20),
}
SHORT = FRAMES["raw, a window"]


def golden(frame):
    return golden_frame(np.zeros(0), SENSOR, frame, PatternEnd(ROWS, COLS))


@pytest.fixture(scope="module")
def bench():
    return Bench(SENSOR)


@pytest.fixture(params=[Host, CHost], ids=["Python", "C"])
def host(request, bench):
    bench.reset()
    host = request.param(bench.transfer, bench.link, bench.now)
    host.identify()
    return host


class Fails:
    """Within it, the driver must raise HostError with this code."""

    def __init__(self, code):
        self.code = code

    def __enter__(self):
        return self

    def __exit__(self, kind, error, trace):
        assert kind is not None, f"{self.code.name} expected"
        if kind is HostError:
            assert error.code == self.code, error
        return kind is HostError


def check(host, frame=SHORT):
    """A whole frame: its bytes, its counters and its end."""
    expected = golden(frame)
    host.configure(frame_values(frame))
    assert host.frame(LIMIT) == expected.stream
    status = host.status()
    assert status.pop("done") and not any(status.values())
    counters = host.counters()
    assert 0 < counters.pop("cycles") <= cycles_at_most(frame, SENSOR)
    assert counters == {"conversions_made": expected.made, "conversions_left_out": expected.left_out}


def running(host, bench, frame=SHORT):
    """Start a frame whose link takes nothing."""
    bench.stall(NEVER)
    host.configure(frame_values(frame))
    host.start()
    bench.ticks(1000)
    assert bench.pins() == (1, 1, 1)


def test_identity(host):
    known = {
        "id": 0x54, "version": 6, "stepping": 0, "lanes": LANES, "rows": ROWS, "cols": COLS, "tile_rows": 4,
        "tile_cols": 6, "divider": 1,
    }  # fmt: skip
    assert host.identify() == {f.name: known[f.name] for f in CHIP.identity}


def test_the_defaults_are_those_of_the_chip(host):
    first, count = CHIP.configuration[0].byte, len(CHIP.image(CHIP.configuration))
    held = host.read(first, count)
    host.configure({})
    assert host.defaults()["row1"] == FULL.row1 and host.defaults()["col1"] == FULL.col1
    assert host.read(first, count) == held


@pytest.mark.parametrize("name", FRAMES)
def test_frames(host, bench, name):
    check(host, FRAMES[name])


def test_a_slow_link_changes_no_byte(host, bench):
    frame = FRAMES["every sample"]
    bench.stall(200)
    host.configure(frame_values(frame))
    assert host.frame(LIMIT) == golden(frame).stream


def test_frames_back_to_back(host):
    for name in ("phase", "edge", "phase", "raw, a window", "tof", "edge"):
        check(host, FRAMES[name])


def test_every_trim_and_every_field_reads_back(host):
    trims = [(-1) ** t * (20 * t + 3) for t in range(24)]
    host.configure(frame_values(FRAMES["phase"], trims) | {"frame_number": 0xFFFF, "n_cm": 255})
    assert host.read(CHIP.trims[0].byte, 48) == b"".join((t & 0x3FF).to_bytes(2, "little") for t in trims)
    assert host.read(CHIP["n_cm"].byte, 1) == b"\xff"


@pytest.mark.parametrize(
    "wrong", [{"threshold": 128}, {"mode": 8}, {"trim[5].trim": 512}, {"trim[23].trim": -513}, {"mask": 1 << 24}]
)
def test_values_out_of_range(host, wrong):
    with Fails(Code.RANGE):
        host.configure(wrong)


@pytest.mark.parametrize(
    "wrong, code",
    [
        ({"mask": 0}, Code.WINDOW),
        ({"row0": 2, "row1": 1}, Code.WINDOW),
        ({"col0": 1, "col1": 0}, Code.WINDOW),
        ({"row1": FULL.row1 + 1}, Code.WINDOW),
        ({"col1": FULL.col1 + 1}, Code.WINDOW),
        *(({name: 0}, Code.DURATION) for name in ("t_reset", "t_int", "t_cm", "t_settle", "t_read", "t_guard")),
    ],
)
def test_frames_that_cannot_start(host, bench, wrong, code):
    host.configure(frame_values(SHORT) | wrong)
    with Fails(code):
        host.frame(LIMIT)
    status = host.status()
    assert status["cfg_err"] and status["amp_err"] == (code == Code.DURATION) and not status["busy"] | status["done"]
    assert not bench.link()
    check(host)


def test_start_and_configuration_while_a_frame_runs(host, bench):
    running(host, bench)
    with Fails(Code.REFUSED):
        host.start()
    with Fails(Code.REFUSED):
        host.configure(frame_values(FRAMES["edge"]))
    bench.stall(0)
    bench.ticks(5000)
    assert bench.link() == golden(SHORT).stream and host.status()["done"]
    check(host, FRAMES["edge"])


def test_the_time_limit(host, bench):
    """A link that takes nothing: the limit passes, the frame is aborted, the next one is complete."""
    host.configure(frame_values(SHORT))
    bench.stall(NEVER)
    with Fails(Code.TIMEOUT):
        host.frame(3000)
    status = host.status()
    assert status["aborted"] and not status["busy"] | status["done"]
    bench.stall(0)
    check(host)


@pytest.mark.parametrize("after", [0, 40, 300, 900])
def test_abort_in_a_frame(host, bench, after):
    frame = FRAMES["every sample"]
    bench.stall(220)
    host.configure(frame_values(frame))
    host.start()
    bench.ticks(after)
    host.abort()
    with Fails(Code.ABORTED):
        host.wait(LIMIT)
    assert bench.pins() == (0, 0, 0)
    got = bench.link()
    assert golden(frame).stream.startswith(got) and len(got) < len(golden(frame).stream)
    bench.stall(0)
    check(host, FRAMES["phase"])


def test_the_state_says_what_waits(host, bench):
    """Nothing at rest; the link, where it stalls; nothing after the abort."""
    f = CHIP.state[0]

    def state():
        value = int.from_bytes(host.read(f.address, f.size), "little")
        return {f.name: value >> f.lsb & (1 << f.width) - 1 for f in CHIP.state}

    assert not any(state().values())
    running(host, bench)
    names = {name: dict(CHIP[name].choices)[value] for name, value in state().items() if name.endswith("_state")}
    assert names["encoder_state"] != "idle" and state()["link_waits"] and not state()["loop_waits"]
    host.abort()
    assert not any(state().values())


def test_abort_while_the_link_stalls(host, bench):
    running(host, bench)
    host.abort()
    assert bench.pins() == (0, 0, 0) and host.status()["aborted"]
    bench.stall(0)
    bench.ticks(100)
    assert not bench.link()
    check(host)


def test_start_and_abort_in_one_write(host):
    host.configure(frame_values(SHORT))
    host.write([(CHIP["start"].byte, command("start")[1] | command("abort")[1])])
    status = host.status()
    assert status["refused"] and status["aborted"] and not status["busy"]
    check(host)


def test_reset_in_a_frame(host, bench):
    running(host, bench)
    bench.reset()
    assert bench.pins() == (0, 0, 0) and not any(host.status().values())
    fields = [f for f in CHIP.configuration if f.name not in ("row1", "col1")]
    for address, byte in CHIP.image(fields).items():
        assert host.read(address, 1)[0] == byte, hex(address)
    check(host)


def test_loop_back(host, bench):
    data = bytes(range(0, 256, 5)) + b"\xff\0"
    host.loop_back(data, 1000)
    assert not host.status()["refused"] and bench.pins() == (0, 0, 0)
    check(host)
    host.loop_back(data, 1000)


def test_many_loop_back_bytes_in_one_transfer(host, bench):
    loop, data = CHIP["loop_enable"], b"Talbot\xff\0"
    host.write([(loop.byte, 1 << loop.shift)])
    bench.transfer(bytes((0x80 | CHIP["loop_back"].byte, *data)))
    assert bench.link() == data


def test_a_loop_back_byte_waits(host, bench):
    """It locks the configuration, keeps the next byte out, and goes when it is taken, at an abort, at a reset."""
    loop, back, options = CHIP["loop_enable"], CHIP["loop_back"].byte, CHIP["loop_enable"].byte

    def offer():
        bench.stall(NEVER)
        host.write([(options, 1 << loop.shift), (back, 0x5A)])
        assert bench.pins() == (0, 0, 1) and not host.status()["refused"]

    def refused(*write):
        host.write([write])
        assert host.status()["refused"]
        host.write([(CHIP["refused"].byte, 1 << CHIP["refused"].shift)])

    offer()
    refused(back, 0xA5)
    refused(options, 0)
    refused(CHIP["threshold"].byte, 3)
    refused(CHIP["start"].byte, 1)
    assert host.read(options, 1)[0] >> loop.shift & 1 and host.read(CHIP["threshold"].byte, 1)[0] == 10
    bench.stall(0)
    assert bench.link() == b"\x5a"
    refused(CHIP["start"].byte, 1)  # loop_enable is still set
    offer()
    host.abort()
    assert bench.pins() == (0, 0, 0) and host.read(options, 1)[0] >> loop.shift & 1
    bench.stall(0)
    host.write([(options, 0)])
    assert not bench.link()
    refused(back, 0xA5)  # loop_enable is clear
    offer()
    bench.reset()
    assert not bench.link()
    check(host)


def test_start_with_loop_enable(host):
    host.configure(frame_values(SHORT) | {"loop_enable": 1})
    with Fails(Code.REFUSED):
        host.start()
    assert not host.status()["busy"]
    check(host)


def test_loop_back_that_fails(host, bench):
    bench.stall(NEVER)
    with Fails(Code.TIMEOUT):
        host.loop_back(b"ab", 500)
    bench.stall(0)
    host.loop_back(b"cd", 500)
    check(host)


def test_loop_back_in_a_frame_is_refused(host, bench):
    running(host, bench)
    with Fails(Code.REFUSED):
        host.loop_back(b"a", 500)


@pytest.mark.parametrize("kind", [Host, CHost])
def test_who_answers(bench, kind):
    """Nobody (miso low or high), another map, a wrong byte from the link, a bit lost in the configuration."""
    for stuck in (0, 0xFF):
        with Fails(Code.IDENTITY):
            kind(lambda out, level=stuck: bytes([level] * len(out)), bench.link, bench.now).identify()
    bench.reset()
    version = CHIP["version"].byte
    with Fails(Code.IDENTITY):
        kind(lambda out: b"\0\x01" if out[0] == version else bench.transfer(out), bench.link, bench.now).identify()

    host = kind(bench.transfer, lambda: bytes(b ^ 4 for b in bench.link()), bench.now)
    with Fails(Code.LINK):
        host.loop_back(b"abc", 500)

    def loses_a_bit(out):
        return bench.transfer(bytes(b & 0x7F if i == 5 and out[0] & 0x80 else b for i, b in enumerate(out)))

    host = kind(loses_a_bit, bench.link, bench.now)
    host.identify()
    with Fails(Code.READ_BACK):
        host.configure({"frame_number": 0xFFFF, "mask": 0xFFFFFF, "t_reset": 0xFFFF})


def test_errors_of_the_c_driver_alone(bench):
    bench.reset()
    with pytest.raises(OSError, match=f"Errno {TRANSFER}"):
        CHost(lambda out: b"", bench.link, bench.now).identify()
    host = CHost(bench.transfer, bench.link, bench.now, room=50)
    host.identify()
    host.configure(frame_values(SHORT))
    with pytest.raises(OSError, match=f"Errno {OUT_OF_ROOM}"):
        host.frame(LIMIT)
    assert host.status()["aborted"] and not host.status()["busy"]


def test_both_drivers_have_the_same_codes():
    (names,) = re.findall(r"enum asp_error \{(.*?)\n\};", (FOLDER / "asp_chip.h").read_text(), re.S)
    codes = {name: i for i, name in enumerate(re.findall(r"ASP_(\w+)", re.sub(r"/\*.*?\*/", "", names)))}
    assert {c.name: c.value for c in Code} == {k: v for k, v in codes.items() if k not in ("OK", "TRANSFER", "ROOM")}
    assert (codes["TRANSFER"], codes["ROOM"]) == (TRANSFER, OUT_OF_ROOM)
