"""An ngspice process that loads the models when it starts and then runs one transient after another.

`ngspice -p` reads commands from a pipe; sources and loads change by `alter`, results come back in its binary file.
A run that hangs is killed at its timeout, a failed one is repeated with `Settings.retries` in a new process, and what
fails with all of them is an error that holds the deck.
"""

import contextlib
import os
import re
import select
import shutil
import signal
import tempfile
import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from subprocess import PIPE, STDOUT, Popen
from typing import Self

import numpy as np

from talbot.base.environment import of_tools
from talbot.base.tools import ToolError
from talbot.cells.spice.settings import Settings
from talbot.cells.spice.wave import Wave

STALLED = 50  # times its timeout, by the clock, after which a child that uses no CPU is given up
Points = Sequence[tuple[float, float]]  # (s, V) of a piecewise linear source
_END = "@@end-of-command@@"
_WRONG = re.compile(
    r"(?im)^.*(singular matrix|timestep too small|simulation\(s\) aborted|fatal|unknown subckt|"
    r"can't find model|could not find a valid modelname|error on line|undefined parameter).*$"
)


class SimulationError(ToolError):
    """A transient that failed with every setting; ``deck``: a netlist that reproduces it."""

    def __init__(self, message: str, deck: str) -> None:
        super().__init__(message)
        self.deck = deck


@dataclass(frozen=True)
class Transient:
    """A transient analysis.

    stimulus: sources of the inputs.
    loads: F at the outputs.
    stop, step: s, end and longest time step.
    nodes: (node inside the cell, V) from which the search for the operating point starts.
    """

    stimulus: Mapping[str, Points]
    loads: Mapping[str, float]
    stop: float
    step: float
    nodes: tuple[tuple[str, float], ...] = ()

    @property
    def command(self) -> str:
        """The tran command."""
        return f"tran {self.step:.6g} {self.stop:.9g} 0 {self.step:.6g}"


class Simulator:
    """A context manager around one ngspice process.

    circuit: lines of a deck (models, subcircuit, instance). inputs: nodes that get a source; outputs: nodes that get a
    load capacitor; rails: supplies and their volts. runs: transients so far; repeated: those that needed a retry.
    """

    def __init__(
        self,
        circuit: Iterable[str],
        inputs: Iterable[str],
        outputs: Iterable[str],
        rails: Mapping[str, float],
        temperature: float,
        settings: Settings | None = None,
    ) -> None:
        self.circuit, self.inputs, self.outputs = list(circuit), tuple(inputs), tuple(outputs)
        self.rails, self.temperature = dict(rails), temperature
        self.settings = settings or Settings()
        self.runs = self.repeated = 0
        self.last = ""  # the latest run as a netlist for `ngspice -b`
        self._child: Popen[bytes] | None = None
        self._current: tuple[Settings, tuple[tuple[str, float], ...]] | None = None

    def __enter__(self) -> Self:
        self._folder = Path(tempfile.mkdtemp(prefix="ngspice-", dir="/dev/shm" if os.path.isdir("/dev/shm") else None))
        return self

    def __exit__(self, *error: object) -> None:
        self._stop()
        shutil.rmtree(self._folder, ignore_errors=True)

    def transient(
        self,
        stimulus: Mapping[str, Points],
        loads: Mapping[str, float],
        stop: float,
        step: float,
        nodes: Iterable[tuple[str, float]] = (),
        settings: Settings | None = None,
    ) -> Wave:
        """Run a `Transient`; other ``nodes`` than in the run before cost a new process.

        settings: instead of the simulator's, without retries after a failure. Raises SimulationError.
        """
        requested, run = settings or self.settings, Transient(stimulus, loads, stop, step, tuple(nodes))
        attempts = (requested,) if settings else (requested, *requested.retries)
        self.runs += 1
        self.last = "\n".join([*self._deck(requested, run, run.loads), f".{run.command}", ".end", ""])
        why = ""
        for k, attempt in enumerate(attempts):
            self.repeated += k == 1
            try:
                return self._run(attempt, run)
            except _Failed as error:
                why = str(error)
                self._stop()
        raise SimulationError(f"ngspice: {why} (attempts: {len(attempts)})", self.last)

    def _deck(self, settings: Settings, run: Transient, loads: Mapping[str, float]) -> list[str]:
        return [
            "* made by cells",
            *settings.options,
            *self.circuit,
            f".temp {self.temperature:g}",
            *(f"vrail{i} {node} 0 {volts:g}" for i, (node, volts) in enumerate(self.rails.items())),
            *(f".nodeset v(xcell.{node})={volts:g}" for node, volts in run.nodes),
            *(f"vin{i} {pin} 0 PWL({_pairs(run.stimulus[pin])})" for i, pin in enumerate(self.inputs)),
            *(f"cload{i} {pin} 0 {loads.get(pin, 0.0):.9g}" for i, pin in enumerate(self.outputs)),
        ]

    def _run(self, settings: Settings, run: Transient) -> Wave:
        child = self._started(settings, run)
        file = self._folder / "wave.raw"
        file.unlink(missing_ok=True)
        # All in one write: on a busy machine every answer that is waited for costs a turn of the scheduler.
        lines = [f"alter @vin{i}[pwl] = [ {_pairs(run.stimulus[pin])} ]" for i, pin in enumerate(self.inputs)]
        lines += [f"alter cload{i} = {max(run.loads.get(pin, 0.0), 1e-21):.9g}" for i, pin in enumerate(self.outputs)]
        output = _command(child, "\n".join([*lines, run.command, f"write {file}", "destroy all"]), settings.timeout)
        wave = self._read(file) if file.exists() else None
        if wave is None or wave.time[-1] < run.stop * (1 - 1e-6):
            raise _Failed(_first_error(output))
        return wave

    def _started(self, settings: Settings, run: Transient) -> Popen[bytes]:
        """The process with the models, these settings and nodes loaded."""
        requested = replace(settings, timeout=1.0), run.nodes
        if self._child is not None and self._current == requested:
            return self._child
        self._stop()
        file = self._folder / "deck.sp"
        file.write_text(
            "\n".join([*self._deck(settings, run, dict.fromkeys(self.outputs, 1e-15)), ".end", ""]), encoding="utf-8"
        )
        command, env = ["ngspice", "-n", "-p", file], of_tools({"OMP_NUM_THREADS": "1", "OMP_THREAD_LIMIT": "1"})
        try:
            self._child = Popen(
                command, stdin=PIPE, stdout=PIPE, stderr=STDOUT, start_new_session=True, cwd=self._folder, env=env
            )
        except FileNotFoundError as error:
            missing = "ngspice: not found; install it with: make tools (Debian: apt-get install ngspice)"
            raise ToolError(missing) from error
        self._current = requested
        saved = [f"v({n.lower()})" for n in (*self.inputs, *self.outputs)]
        saved += [f"i(vin{i})" for i in range(len(self.inputs))] + [f"i(vrail{i})" for i in range(len(self.rails))]
        command = "set filetype=binary\nsave " + " ".join(saved)
        if wrong := _WRONG.search(_command(self._child, command, 60 + settings.timeout)):
            raise _Failed(wrong[0].strip())
        return self._child

    def _read(self, file: Path) -> Wave:
        head, _, body = file.read_bytes().partition(b"Binary:\n")
        names = re.findall(rb"^\t\d+\t(\S+)\t", head, re.M)
        table = np.frombuffer(body).reshape(-1, len(names)).T
        column = {name.decode(): row for name, row in zip(names, table, strict=True)}
        voltage = {n: column[f"v({n.lower()})"] for n in (*self.inputs, *self.outputs)}
        current = {n: -column[f"i(vin{i})"] for i, n in enumerate(self.inputs)}
        current |= {n: -column[f"i(vrail{i})"] for i, n in enumerate(self.rails)}
        return Wave(column["time"], voltage, current)

    def _stop(self) -> None:
        if self._child is None:
            return
        with self._child, contextlib.suppress(ProcessLookupError):
            os.killpg(self._child.pid, signal.SIGKILL)
        self._child = None


class _Failed(Exception):
    """One attempt did not succeed."""


def _command(child: Popen[bytes], text: str, timeout: float) -> str:
    """Return ngspice's answer to a command. Raises _Failed when it ends or uses ``timeout`` s of CPU.

    CPU time counts, not elapsed time: a busy machine slows a run.
    """
    assert child.stdin and child.stdout
    started, latest = _cpu_seconds(child.pid), time.monotonic() + STALLED * timeout
    try:
        child.stdin.write(f"{text}\necho {_END}\n".encode())
        child.stdin.flush()
    except BrokenPipeError:
        raise _Failed("ngspice ended") from None
    output = b""
    while _END.encode() not in output:
        ready = select.select([child.stdout], [], [], min(timeout, 0.5))[0]
        if _cpu_seconds(child.pid) - started > timeout or time.monotonic() > latest:
            raise _Failed("no answer within the timeout")
        if not ready:
            continue
        part = os.read(child.stdout.fileno(), 65536)
        if not part:
            raise _Failed(_first_error(output.decode(errors="replace")) if output else "ngspice ended")
        output += part
    return output.decode(errors="replace")


def _cpu_seconds(pid: int) -> float:
    """CPU seconds that a process has used; the clock's seconds where the system has no /proc."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text(encoding="utf-8", errors="replace").rpartition(")")[2].split()
    except OSError:
        return time.monotonic()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def _pairs(points: Points) -> str:
    return " ".join(f"{t:.9g} {v:.9g}" for t, v in points)


def _first_error(output: str) -> str:
    match = _WRONG.search(output)
    return match[0].strip() if match else "the transient did not reach its end"
