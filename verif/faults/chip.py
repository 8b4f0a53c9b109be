"""The small chip of the fault tests: its Verilog in Verilator or Icarus with many waveforms."""

import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
import numpy.typing as npt

from talbot.base.tools import ToolError, finish
from talbot.imaging.simulate.build import Build
from talbot.imaging.simulate.verilator import bare_program
from talbot.models.chip import GoldenFrame, golden_frame
from talbot.models.digital.host import command, frame_writes, write_transfers
from talbot.models.digital.pattern import PatternEnd
from talbot.models.parameters import AmpTiming, ArrayParameters, ChipParameters, FrameParameters, SensorParameters
from talbot.models.parameters.registers import register_map
from talbot.rtl.export import translate
from talbot.rtl.harness.icarus import kept_program
from talbot.verif.faults.waveform import BUSY, Trace, Wave, reset, rest, transfer, transfers

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


def frame_of(name: str) -> FrameParameters:
    """Return a frame of FRAMES."""
    return FrameParameters(SENSOR.full_window, test_pattern=True, timing=FAST, **FRAMES[name])


@cache
def golden(name: str) -> GoldenFrame:
    """Return the golden result of a frame of FRAMES."""
    return golden_frame(np.zeros(0), SENSOR, frame_of(name), PatternEnd(ROWS, COLS))  # it takes no samples


@cache
def program() -> Path:
    """Return the executable of the chip in Verilator."""
    return bare_program(Build.of(SENSOR), main=HERE / "main.cpp")


@cache
def icarus_program() -> Path:
    """Return the program of the chip for Icarus's `vvp`. Raises IcarusError."""
    return kept_program("Wave", [HERE / "wave.sv"], "Wave", [translate("AspChip", SENSOR)])


def run(waves: Sequence[Wave], icarus: bool = False) -> list[Trace]:
    """Run the chip under each of ``waves``, one after the other. Raises ToolError; ValueError for X or Z in Icarus."""
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
        out = _bits(trace.read_text(encoding="utf-8")) if icarus else np.frombuffer(trace.read_bytes(), np.uint8)
        out = out.reshape(-1, OUTPUTS)
    ends = np.cumsum([w.size for w in waves])
    return [Trace(w, out[end - w.size : end]) for w, end in zip(waves, ends, strict=True)]


def _bits(text: str) -> npt.NDArray[np.uint8]:
    """Return lines of binary digits as bytes. An X is 0 before the first reset and an error after it."""
    bits = np.frombuffer(text.encode(), np.uint8).reshape(-1, 8 * OUTPUTS + 1)[:, :-1]
    unknown = np.flatnonzero((bits > ord("1")).any(1))
    if unknown.size and unknown[-1] > 0:
        raise ValueError(f"cycle {unknown[-1]}: an output is {text.split()[unknown[-1]]}: must be 0 or 1")
    return np.packbits(bits == ord("1"), axis=1)


def resets() -> dict[int, int]:
    """Return the configuration after a reset: address -> byte."""
    window = SENSOR.full_window
    return register_map().image(register_map().configuration, {"row1": window.row1, "col1": window.col1})


@cache
def configured(name: str) -> Wave:
    """Return the waveform from reset to the command before `start`."""
    held = resets()
    writes = [(address, byte) for address, byte in frame_writes(frame_of(name)) if held[address] != byte]
    return np.concatenate([reset(), transfers(write_transfers(writes))])


def start() -> Wave:
    """Return the transfer that starts a frame."""
    return transfer(command("start"))


@dataclass(frozen=True, eq=False)
class Quiet:
    """A frame without a fault. before: waveform to the end of `start`. length: busy cycles after it."""

    before: Wave
    length: int
    trace: Trace


@cache
def quiet(name: str) -> Quiet:
    """Run frame ``name`` without a fault. Raises ToolError where it differs from the golden model."""
    before = np.concatenate([configured(name), start()])
    (trace,) = run([np.concatenate([before, rest(1000)])])
    if trace.stream != golden(name).stream:
        raise ToolError(f"frame {name}: without a fault, its bytes differ from the golden model's")
    return Quiet(before, int(np.flatnonzero(trace.flag(BUSY))[-1]) + 1 - before.size, trace)
