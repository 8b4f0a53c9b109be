"""A bench that runs on from frame to frame: registers and state stay, exposures and SPI transfers come through pipes."""

import json
import os
import selectors
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from time import perf_counter
from typing import IO, Any

from base.tools import ToolError, started

from .frame import NO_FRAME_END, STOP, WAIT, FrameRun, simulator, transfers

NEXT_EXPOSURE, REPORT = b"\x03", b"\x04"  # of the script (bench.sv)
CHUNK = 1 << 20
INPUTS, OUTPUTS = ("script", "samples"), ("stream", "miso", "activity")


class Running:
    """A bench that was started by `running`."""

    def __init__(self, inputs: dict[str, IO[bytes]], outputs: dict[str, int]) -> None:
        self._inputs, self._outputs, self._frames = inputs, outputs, 0

    def frame(self, samples: bytes | memoryview, before: Sequence[bytes], after: Sequence[bytes]) -> FrameRun:
        """One frame: SPI transfers ``before`` it, the last of which starts it, and ``after`` it.

        samples: of every tap that the program has, as `models.afe.sample_words` makes them. `seconds` of the result is
        the wall clock of all of it. Raises ToolError when the bench ends.
        """
        start = perf_counter()
        script = transfers(before) + WAIT + transfers(after) + REPORT
        try:
            self._send("script", NEXT_EXPOSURE + script if self._frames else script)
            self._send("samples", samples)
        except BrokenPipeError:
            raise _Ended from None
        self._frames += 1
        got = self._receive(sum(map(len, (*before, *after))))
        activity = json.loads(got["activity"])
        cycles = activity.pop("cycles")
        return FrameRun(got["stream"], got["miso"], activity, cycles, perf_counter() - start)

    def stop(self) -> None:
        """Let the bench end by itself."""
        self._send("script", STOP)

    def _send(self, name: str, data: bytes | memoryview) -> None:
        self._inputs[name].write(data)
        self._inputs[name].flush()

    def _receive(self, replies: int) -> dict[str, bytes]:
        """What the bench writes of one frame, up to its line of activity."""
        got = {name: bytearray() for name in OUTPUTS}
        with selectors.DefaultSelector() as selector:
            for name, file in self._outputs.items():
                selector.register(file, selectors.EVENT_READ, name)
            size = None
            while size is None or len(got["stream"]) < size or len(got["miso"]) < replies:
                for key, _ in selector.select():
                    data = os.read(key.fd, CHUNK)
                    if not data:
                        raise _Ended
                    got[key.data] += data
                if size is None and got["activity"].endswith(b"\n"):
                    size = json.loads(got["activity"])["bytes"]
        return {name: bytes(data) for name, data in got.items()}


class _Ended(Exception):
    """The bench closed its pipes."""


@contextmanager
def running(program: Path, converter: Path, stall: int = 0, max_cycles: int = 1_000_000_000) -> Iterator[Running]:
    """Start the bench ``program`` (an executable, or .vvp of Icarus); at the end of the context it ends, too.

    converter: file of the analog front end (pixels/README.md). stall: the link is not ready in this many of 256 cycles.
    max_cycles: of a frame. Raises ToolError where the bench ends before.
    """
    with ExitStack() as stack:
        ends = {name: os.pipe() for name in (*INPUTS, *OUTPUTS)}
        theirs = {name: ends[name][name in OUTPUTS] for name in ends}
        inputs: dict[str, Any] = {name: stack.enter_context(os.fdopen(ends[name][1], "wb")) for name in INPUTS}
        outputs = {name: stack.enter_context(os.fdopen(ends[name][0], "rb", 0)).fileno() for name in OUTPUTS}
        log = stack.enter_context(tempfile.TemporaryFile())
        words = [f"+{name}=/dev/fd/{file}" for name, file in theirs.items()]
        words += [f"+converter={converter}", f"+stall={stall}", f"+max_cycles={max_cycles}"]
        try:
            child = stack.enter_context(started([*simulator(program), *words], log, list(theirs.values())))
        finally:
            for file in theirs.values():
                os.close(file)
        try:
            bench = Running(inputs, outputs)
            yield bench
            bench.stop()
            child.wait()
        except _Ended:
            status = child.wait()
            log.seek(0)
            reason = " (no frame end)" if status == NO_FRAME_END else ""
            tail = log.read().decode(errors="replace").strip()[-800:]
            raise ToolError(f"the simulation stopped with status {status}{reason}: {tail}") from None
