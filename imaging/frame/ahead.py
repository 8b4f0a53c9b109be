"""Numba's functions for the end of a frame, compiled by another process while the first frame is captured.

Both processes have Numba's cache: the first finds there what takes a fourth of its processor time.
"""

import contextlib
import os
import sys
from pathlib import Path

import numpy as np

from talbot.base.cache import cached, digest
from talbot.base.kept import afresh
from talbot.base.paths import BUILD
from talbot.base.sources import code
from talbot.base.tools import ToolError, run
from talbot.imaging.frame.job import read_golden, see
from talbot.imaging.frame.request import request
from talbot.imaging.frame.result import Exposed
from talbot.models.capture import Region, Views
from talbot.models.chip import front_end_of
from talbot.models.parameters import STANDARD

LONGEST = "talbot.models.digital.stream.payload"  # by whose code the functions are taken for compiled


def compiled() -> None:
    """Let a child process compile them, where none has and there is a core for it."""
    if (os.cpu_count() or 1) > 1:
        with contextlib.suppress(ToolError, OSError):  # then each is compiled when it is called
            cached(BUILD / "ahead" / digest(code(LONGEST), sys.version), _compile)


def _compile(_: Path) -> None:
    run([sys.executable, "-m", __name__])


def main() -> None:
    """Convert, encode, decode and rebuild a frame of a few tiles."""
    frame_request = request(scene="flat:50", rows=4 * STANDARD.tile.rows, cols=4 * STANDARD.tile.cols)
    scene, plan = see(frame_request)
    front_end = front_end_of(frame_request.lit, [0] * STANDARD.tile.n_types)
    samples, none = np.random.default_rng(1).uniform(30, 80, (1, *scene.shape, 2)), np.zeros(scene.shape, bool)
    views = Views((Region(1, ~none),), 1, None)
    ideal = np.moveaxis(front_end.values(samples, frame_request.frame.mode), 0, 2)
    with afresh():
        _ = read_golden(frame_request, Exposed(scene, plan, views, front_end, samples, samples, ideal, none)).rebuilt


if __name__ == "__main__":
    main()
