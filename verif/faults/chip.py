"""The small chip that the faults are tried on: its Verilog in Verilator, run under many waveforms at once."""

import tempfile
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from base.tools import ToolError, finish
from flow.simulate.build import Build
from flow.simulate.verilator import bare_program
from models.chip import golden_frame
from models.digital.host import command, frame_writes, write_transfers
from models.digital.pattern import PatternEnd
from models.parameters import AmpTiming, ArrayParameters, ChipParameters, FrameParameters, SensorParameters
from models.parameters.registers import register_map
from rtl.export import translate
from rtl.harness.icarus import kept_program

from .waveform import BUSY, Trace, reset, rest, transfer, transfers

ROWS, COLS, LANES = 8, 13, 2
SENSOR = SensorParameters(array=ArrayParameters(ROWS, COLS), chip=ChipParameters(lanes=LANES))
FAST = AmpTiming(t_reset=2, t_int=3, t_cm=2, t_settle=2, t_read=2, t_guard=1)
OUTPUTS = 3
HERE = Path(__file__).parent
FRAMES = {  # test patterns: the comparators' pins rest
    "edge": {"threshold": 4, "mask": 0x0F0F0F},
    "raw": {"mode": "raw", "mask": 0x8040A1},
    "phase": {"mode": "tof", "phase": True, "mask": 0x000103},
}


def frame_of(name):
    return FrameParameters(SENSOR.full_window, test_pattern=True, timing=FAST, **FRAMES[name])


@cache
def golden(name):
    """GoldenFrame of a frame of FRAMES."""
    return golden_frame(None, SENSOR, frame_of(name), PatternEnd(ROWS, COLS))


@cache
def program():
    """The chip in Verilator: path of an executable."""
    return bare_program(Build.of(SENSOR), main=HERE / "main.cpp")


@cache
def icarus_program():
    """The chip in Icarus: path of what `vvp` runs. Raises IcarusError."""
    return kept_program("Wave", [HERE / "wave.sv"], "Wave", [translate("AspChip", SENSOR)])


def run(waves, icarus=False):
    """The chip under each of ``waves`` (uint8 arrays, see `waveform`), one after the other: list of Trace.

    Raises ToolError; for an X or Z at an output of Icarus, ValueError.
    """
    with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
        wave, trace = Path(folder) / "wave", Path(folder) / "trace"
        wave.write_bytes(b"".join(w.tobytes() for w in waves))
        command = ["vvp", "-n", icarus_program()] if icarus else [program()]
        result = finish([*command, f"+wave={wave}", f"+trace={trace}"])
        if result.returncode or not trace.exists():
            raise ToolError(
                f"the chip under a waveform stopped with status {result.returncode}: "
                f"{(result.stdout + result.stderr)[-800:]}"
            )
        out = _bits(trace.read_text()) if icarus else np.frombuffer(trace.read_bytes(), np.uint8)
        out = out.reshape(-1, OUTPUTS)
    ends = np.cumsum([w.size for w in waves])
    return [Trace(w, out[end - w.size : end]) for w, end in zip(waves, ends, strict=True)]


def _bits(text):
    """Lines of binary digits as bytes. What is X ahead of the first reset counts as 0, later it is an error."""
    bits = np.frombuffer(text.encode(), np.uint8).reshape(-1, 8 * OUTPUTS + 1)[:, :-1]
    unknown = np.flatnonzero((bits > ord("1")).any(1))
    if unknown.size and unknown[-1] > 0:
        raise ValueError(f"cycle {unknown[-1]}: an output is {text.split()[unknown[-1]]}: must be 0 or 1")
    return np.packbits(bits == ord("1"), axis=1)


def resets():
    """The configuration out of reset: dict address -> byte."""
    window = SENSOR.full_window
    return register_map().image(register_map().configuration, {"row1": window.row1, "col1": window.col1})


@cache
def configured(name):
    """Waveform from reset up to where only `start` is missing."""
    held = resets()
    writes = [(address, byte) for address, byte in frame_writes(frame_of(name)) if held[address] != byte]
    return np.concatenate([reset(), transfers(write_transfers(writes))])


def start():
    return transfer(command("start"))


@dataclass(frozen=True, eq=False)
class Quiet:
    """A frame without a fault. before: waveform up to the end of `start`. length: cycles from there on while busy."""

    before: np.ndarray
    length: int
    trace: Trace


@cache
def quiet(name):
    """The frame ``name`` as it should be: Quiet."""
    before = np.concatenate([configured(name), start()])
    (trace,) = run([np.concatenate([before, rest(1000)])])
    if trace.stream != golden(name).stream:
        raise ToolError(f"frame {name}: without a fault, other bytes leave the chip than the golden model's")
    return Quiet(before, int(np.flatnonzero(trace.flag(BUSY))[-1]) + 1 - before.size, trace)
