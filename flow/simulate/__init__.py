"""Compile the frame bench (verif/frame) once, cached by content, and run frames through it."""

from .run import FrameRun, run_frame
from .verilator import bench_program

__all__ = ["FrameRun", "bench_program", "run_frame"]
