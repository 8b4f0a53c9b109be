"""ngspice as a process that loads the models once and then runs one transient after another.

`ngspice -p` reads commands from a pipe; sources and loads change by `alter`, results come back in its binary file.
A run that hangs is killed by its time-out, a failed one is repeated with the stated settings of `Settings.retries` in a
new process, and what fails with all of them is an error with the deck that shows it.
"""

import os
import re
import select
import shutil
import signal
import subprocess
import tempfile
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

from base.tools import ToolError
from cells.spice.settings import Settings
from cells.spice.wave import Wave

STALLED = 50  # times its time-out, by the clock, after which a child that uses no processor is given up
_END = "@@end-of-command@@"
_WRONG = re.compile(
    r"(?im)^.*(singular matrix|timestep too small|simulation\(s\) aborted|fatal|unknown subckt|"
    r"can't find model|could not find a valid modelname|error on line|undefined parameter).*$"
)


class SimulationError(RuntimeError):
    """ngspice failed with every setting. ``deck``: a netlist of its own that shows it."""

    def __init__(self, message, deck):
        super().__init__(message)
        self.deck = deck


class Simulator:
    """``circuit``: lines of a deck (models, subcircuit, instance) that drives each of ``inputs`` by nothing yet.

    inputs: nodes that get a source. outputs: nodes that get a load capacitor. rails: node -> volts. A context manager;
    ``runs`` counts the transients, ``repeated`` those that needed other settings.
    """

    def __init__(self, circuit, inputs, outputs, rails, temperature, settings=None):
        self.circuit, self.inputs, self.outputs = list(circuit), tuple(inputs), tuple(outputs)
        self.rails, self.temperature = dict(rails), temperature
        self.settings = settings or Settings()
        self.runs = self.repeated = 0
        self._child = self._current = None
        self._folder = None

    def __enter__(self):
        self._folder = Path(tempfile.mkdtemp(prefix="ngspice-", dir="/dev/shm" if os.path.isdir("/dev/shm") else None))
        return self

    def __exit__(self, *_):
        self._stop()
        shutil.rmtree(self._folder, ignore_errors=True)

    def transient(self, stimulus, loads, stop, step, nodes=(), settings=None, retry=True):
        """One run: Wave. stimulus: input -> [(s, V), ...]; loads: output -> F; stop: s; step: longest time step, s.

        nodes: (node inside the cell, V) to start the search for the first operating point from; other nodes than in the
        run before cost a new process. retry: whether Settings.retries are tried after a failure.

        Raises SimulationError.
        """
        wanted = settings or self.settings
        attempts = (wanted, *wanted.retries) if retry else (wanted,)
        self.runs += 1
        self._request = wanted, stimulus, loads, stop, step, nodes
        for k, attempt in enumerate(attempts):
            self.repeated += k == 1
            try:
                return self._run(attempt, stimulus, loads, stop, step, nodes)
            except _Failed as error:
                why = str(error)
                self._stop()
        raise SimulationError(f"ngspice: {why} (attempts: {len(attempts)})", self.last)

    @property
    def last(self):
        """The run asked for last as a netlist of its own, for `ngspice -b`."""
        return self._deck(*self._request)

    def _deck(self, settings, stimulus, loads, stop, step, nodes):
        lines = self._lines(settings, nodes)
        sources = [f"vin{i} {pin} 0 PWL({_pairs(stimulus[pin])})" for i, pin in enumerate(self.inputs)]
        capacitors = [f"cload{i} {pin} 0 {loads.get(pin, 0.0):.9g}" for i, pin in enumerate(self.outputs)]
        return "\n".join([*lines, *sources, *capacitors, f".tran {step:.6g} {stop:.9g} 0 {step:.6g}", ".end", ""])

    def _lines(self, settings, nodes):
        rails = [f"vrail{i} {node} 0 {volts:g}" for i, (node, volts) in enumerate(self.rails.items())]
        start = [f".nodeset v(xcell.{node})={volts:g}" for node, volts in nodes]
        return ["* made by cells", *settings.options, *self.circuit, f".temp {self.temperature:g}", *rails, *start]

    def _run(self, settings, stimulus, loads, stop, step, nodes):
        self._start(settings, stimulus, tuple(nodes))
        file = self._folder / "wave.raw"
        file.unlink(missing_ok=True)
        # All in one go: on a busy machine every answer that is waited for costs a turn of the scheduler.
        lines = [f"alter @vin{i}[pwl] = [ {_pairs(stimulus[pin])} ]" for i, pin in enumerate(self.inputs)]
        lines += [f"alter cload{i} = {max(loads.get(pin, 0.0), 1e-21):.9g}" for i, pin in enumerate(self.outputs)]
        lines += [f"tran {step:.6g} {stop:.9g} 0 {step:.6g}", f"write {file}", "destroy all"]
        said = self._command("\n".join(lines), settings.timeout)
        if not file.exists():
            raise _Failed(_first_error(said))
        wave = self._read(file)
        if wave.time[-1] < stop * (1 - 1e-6):
            raise _Failed(_first_error(said))
        return wave

    def _start(self, settings, stimulus, nodes):
        wanted = replace(settings, timeout=1.0), nodes
        if self._child is not None and self._current == wanted:
            return
        self._stop()
        sources = [f"vin{i} {pin} 0 PWL({_pairs(stimulus[pin])})" for i, pin in enumerate(self.inputs)]
        capacitors = [f"cload{i} {pin} 0 1f" for i, pin in enumerate(self.outputs)]
        file = self._folder / "deck.sp"
        file.write_text("\n".join([*self._lines(settings, nodes), *sources, *capacitors, ".end", ""]))
        try:
            self._child = subprocess.Popen(
                ["ngspice", "-p", file],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                start_new_session=True,
                cwd=self._folder,
                env=dict(os.environ, OMP_NUM_THREADS="1", OMP_THREAD_LIMIT="1"),
            )
        except FileNotFoundError as error:
            raise ToolError(
                "ngspice: not found; install it with: make tools (Debian: apt-get install ngspice)"
            ) from error
        self._current = wanted
        saved = [
            *(f"v({n.lower()})" for n in (*self.inputs, *self.outputs)),
            *(f"i(vin{i})" for i in range(len(self.inputs))),
            *(f"i(vrail{i})" for i in range(len(self.rails))),
        ]
        said = self._command("set filetype=binary\nsave " + " ".join(saved), 60 + settings.timeout)
        if wrong := _WRONG.search(said):
            raise _Failed(wrong[0].strip())

    def _command(self, text, timeout):
        """What ngspice prints in answer. Raises _Failed when it ends, or has not answered in ``timeout`` s of its own.

        Its processor's time counts, not the clock's: on a busy machine a run is slow for no fault of its own.
        """
        pipe, started = self._child.stdout.fileno(), _seconds(self._child.pid)
        latest = time.monotonic() + STALLED * timeout
        try:
            self._child.stdin.write(f"{text}\necho {_END}\n".encode())
            self._child.stdin.flush()
        except BrokenPipeError:
            raise _Failed("ngspice ended") from None
        said = b""
        while _END.encode() not in said:
            ready = select.select([pipe], [], [], min(timeout, 0.5))[0]
            if _seconds(self._child.pid) - started > timeout or time.monotonic() > latest:
                raise _Failed("no answer within the time-out")
            if not ready:
                continue
            part = os.read(pipe, 65536)
            if not part:
                raise _Failed(_first_error(said.decode(errors="replace")) if said else "ngspice ended")
            said += part
        return said.decode(errors="replace")

    def _read(self, file):
        data = file.read_bytes()
        head, _, body = data.partition(b"Binary:\n")
        names = re.findall(rb"^\t\d+\t(\S+)\t", head, re.M)
        table = np.frombuffer(body).reshape(-1, len(names)).T
        column = {name.decode(): row for name, row in zip(names, table, strict=True)}
        voltage = {n: column[f"v({n.lower()})"] for n in (*self.inputs, *self.outputs)}
        current = {n: -column[f"i(vin{i})"] for i, n in enumerate(self.inputs)}
        current |= {n: -column[f"i(vrail{i})"] for i, n in enumerate(self.rails)}
        return Wave(column["time"], voltage, current)

    def _stop(self):
        if self._child is None:
            return
        with self._child:
            try:
                os.killpg(self._child.pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
            self._child.wait()
        self._child = None


class _Failed(Exception):
    """One attempt did not succeed."""


def _seconds(pid):
    """Processor's seconds that a process has used; the clock's where the system does not say (no /proc)."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return time.monotonic()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def _pairs(points):
    return " ".join(f"{t:.9g} {v:.9g}" for t, v in points)


def _first_error(said):
    found = _WRONG.search(said)
    return found[0].strip() if found else "the transient did not reach its end"
