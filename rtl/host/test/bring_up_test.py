"""The bring-up's code against the chip's Verilog and the golden chip, sound and with faults of each kind."""

from dataclasses import replace
from itertools import count

import pytest

from talbot.imaging.frame import job
from talbot.imaging.frame.request import request
from talbot.models.chip import front_end_of, golden_frame
from talbot.models.parameters import MODES
from talbot.rtl.host import bring_up
from talbot.rtl.host.driver import Code, Host, HostError
from talbot.rtl.host.test.bench import Bench
from talbot.rtl.host.test.host_test import LIMIT, SENSOR


@pytest.fixture(scope="module")
def bench():
    return Bench(SENSOR)


def test_a_sound_chip_passes_every_digital_step(bench):
    bench.reset()
    steps = bring_up.digital(Host(bench.transfer, bench.link, bench.now), SENSOR, LIMIT)
    assert steps == ["identity", "registers", "loop-back", *(f"test pattern, {mode}" for mode in MODES)]


def stuck(transfer):
    """Register writes with data bit 3 stuck at 0 at the board."""
    return lambda out: transfer(bytes([out[0], *(b & ~8 for b in out[1:])]) if out[0] & 0x80 else out)


@pytest.mark.parametrize(
    "code, broken",
    [
        (Code.IDENTITY, lambda bench: (lambda out: bytes(len(out)), bench.link)),
        (Code.READ_BACK, lambda bench: (stuck(bench.transfer), bench.link)),
        (Code.LINK, lambda bench: (bench.transfer, lambda: bytes(b ^ 4 for b in bench.link()))),
        (Code.TIMEOUT, lambda bench: (bench.transfer, lambda: bench.link()[:0])),
    ],
)
def test_a_broken_wire_is_named_by_its_step(bench, code, broken):
    bench.reset()
    with pytest.raises(HostError) as error:
        bring_up.digital(Host(*broken(bench), bench.now), SENSOR, LIMIT)
    assert error.value.code == code


def frames_of(scene, number, **electrical):
    """Frames of the golden chip before a scene, each with other noise, and the request of a raw one."""
    asked = request(48, 96, scene=scene, mode="raw")
    sensor = replace(asked.sensor, electrical=replace(asked.sensor.electrical, **electrical))
    asked = replace(asked, sensor=sensor)

    def frames(frame, trims):
        told = replace(asked, frame=frame)
        seen = job.expose(told, *job.see(told), front_end_of(told.lit, trims), None, next(number))
        return golden_frame(seen.samples, sensor, frame, seen.front_end).stream

    return frames, asked


def figures(**electrical):
    """All figures of a chip, by name, by the expectations of the default sensor."""
    number, sensor = count(1), request(48, 96).sensor
    frames, asked = frames_of("flat:0", number, **electrical)
    found = bring_up.dark(frames, sensor, asked.frame)
    frames, asked = frames_of("flat:50", number, **electrical)
    lit, trims = bring_up.flat(frames, sensor, asked.frame)
    edge = replace(asked.frame, mode="edge", threshold=12)
    return {figure.name: figure for figure in (*found, *lit, *bring_up.silent(frames, sensor, edge, trims, 0.02))}


def test_a_sound_sensor_passes_every_analog_step():
    assert [name for name, figure in figures().items() if not figure.passes] == []


@pytest.mark.parametrize(
    "fault, failed",
    [
        ({"full_well": 3e4}, "full wells"),
        ({"read_noise": 900.0}, "electrons of a raw code"),
        ({"column_fpn": 2000.0}, "columns differ"),
        ({"column_fpn": 2000.0}, "silent pixels"),
        ({"dark_current": 3e-13}, "dark level"),
    ],
)
def test_a_fault_is_seen_by_its_figure(fault, failed):
    assert any(name.startswith(failed) and not figure.passes for name, figure in figures(**fault).items())
