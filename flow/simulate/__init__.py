"""Compile the frame bench (flow/simulate) once, cached by content, and run frames through it."""

from .frame import FrameRun, run_frame
from .verilator import bench_program

__all__ = ["FrameRun", "bench_program", "run_frame"]
