"""A bench that runs on from frame to frame: registers and state stay, exposures and transfers come through pipes."""

import contextlib
import fcntl
import json
import os
import selectors
import tempfile
from collections.abc import Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import ExitStack, contextmanager
from pathlib import Path
from time import perf_counter

from talbot.base.tools import ToolError, started
from talbot.imaging.simulate.frame import NO_FRAME_END, STOP, WAIT, FrameRun, simulator, transfers

NEXT_EXPOSURE, REPORT = b"\x03", b"\x04"  # of the script (bench.sv)
CHUNK = 1 << 20  # bytes
INPUTS, OUTPUTS = ("script", "samples"), ("stream", "miso", "activity")


class Running:
    """A bench that was started by `running`.

    The next frame can be sent while one runs: the simulator waits for nothing.
    """

    def __init__(self, inputs: dict[str, int], outputs: dict[str, int]) -> None:
        self._inputs, self._frames = inputs, 0
        self._got = {name: bytearray() for name in outputs}
        self._selector = selectors.DefaultSelector()
        for name, file in outputs.items():
            self._selector.register(file, selectors.EVENT_READ, name)
        self._senders, self._receivers = ThreadPoolExecutor(1), ThreadPoolExecutor(1)

    def frame(self, samples: bytes | memoryview, before: Sequence[bytes], after: Sequence[bytes]) -> "Future[FrameRun]":
        """One frame: SPI transfers ``before`` it, the last of which starts it, and ``after`` it.

        samples: of every tap, as `models.afe.sample_words` makes them. `seconds` of the result is
        the wall clock since the frame was sent, or the one before was done. Raises ToolError when the bench ends.
        """
        script = transfers(before) + WAIT + transfers(after) + REPORT
        self._senders.submit(self._send, NEXT_EXPOSURE + script if self._frames else script, samples)
        self._frames += 1
        return self._receivers.submit(self._received, sum(map(len, (*before, *after))))

    def stop(self) -> None:
        """Let the bench end by itself after its last frame."""
        self._senders.submit(self._send, STOP, b"")

    def close(self) -> None:
        """End the threads: the bench is gone, or will end by itself."""
        self._senders.shutdown()
        self._receivers.shutdown()
        self._selector.close()

    def _send(self, script: bytes, samples: bytes | memoryview) -> None:
        with contextlib.suppress(BrokenPipeError):  # who receives sees that the bench ended
            for name, data in (("script", script), ("samples", samples)):
                left = memoryview(data)
                while left:
                    left = left[os.write(self._inputs[name], left) :]

    def _received(self, replies: int) -> FrameRun:
        """Return the bench's output of one frame; output of the next frame is kept."""
        start = perf_counter()
        while b"\n" not in self._got["activity"]:
            self._read()
        line, _, self._got["activity"] = self._got["activity"].partition(b"\n")
        activity = json.loads(line)
        integrated, cycles = activity.pop("integrated"), activity.pop("cycles")
        stream, miso = self._taken("stream", activity["bytes"]), self._taken("miso", replies)
        return FrameRun(stream, miso, activity, integrated, cycles, perf_counter() - start)

    def _taken(self, name: str, size: int) -> bytes:
        while len(self._got[name]) < size:
            self._read()
        data = bytes(self._got[name][:size])
        del self._got[name][:size]
        return data

    def _read(self) -> None:
        """Read what there is, of any output: the bench waits for none that is full."""
        for key, _ in self._selector.select():
            data = os.read(key.fd, CHUNK)
            if not data:
                raise _Ended
            self._got[key.data] += data


class _Ended(Exception):
    """The bench closed its pipes."""


@contextmanager
def running(
    program: Path, converter: Path, taps: int, stall: int = 0, max_cycles: int = 1_000_000_000
) -> Iterator[Running]:
    """Start the bench ``program`` (an executable, or .vvp of Icarus); at the end of the context it ends, too.

    converter: file of the analog front end (pixels/README.md). taps: of a frame, 1 or 4. stall: the link is not ready
    in this many of 256 cycles. max_cycles: of a frame. Raises ToolError where the bench ends before.
    """
    with ExitStack() as stack:
        ends = {name: os.pipe() for name in (*INPUTS, *OUTPUTS)}
        theirs = {name: ends[name][name in OUTPUTS] for name in ends}
        ours = {name: ends[name][name in INPUTS] for name in ends}
        for file in ours.values():
            stack.callback(os.close, file)
        # More than a user may have, or a system that has no such call (macOS): it waits for the simulator more often
        with contextlib.suppress(OSError, AttributeError):
            fcntl.fcntl(ours["samples"], fcntl.F_SETPIPE_SZ, CHUNK)
        inputs, outputs = ({name: ours[name] for name in names} for names in (INPUTS, OUTPUTS))
        bench = Running(inputs, outputs)
        stack.callback(bench.close)
        log = stack.enter_context(tempfile.TemporaryFile())
        words = [f"+{name}=/dev/fd/{file}" for name, file in theirs.items()]
        words += [f"+converter={converter}", f"+taps={taps}", f"+stall={stall}", f"+max_cycles={max_cycles}"]
        try:
            child = stack.enter_context(started([*simulator(program), *words], log, list(theirs.values())))
        finally:
            for file in theirs.values():
                os.close(file)
        try:
            yield bench
            bench.stop()
            child.wait()
        except _Ended:
            status = child.wait()
            log.seek(0)
            reason = " (no frame end)" if status == NO_FRAME_END else ""
            tail = log.read().decode(errors="replace").strip()[-800:]
            raise ToolError(f"the simulation stopped with status {status}{reason}: {tail}") from None
