"""The same waveforms off-line: what a lock-step drove its circuit with as piecewise linear sources of plain ngspice.

The reference for the error of a lock-step: no callbacks, no cut steps, tight tolerances, the same drive to the last
corner even where the lock-step's answers would have been others.
"""

import re
import tempfile
from pathlib import Path
from time import perf_counter

import numpy as np
import numpy.typing as npt

from talbot.base.tools import ToolError, finish
from talbot.verif.cosim.accuracy import Accuracy
from talbot.verif.cosim.deck import Deck, Timing
from talbot.verif.cosim.lockstep import Cycle, Run

TIGHT = Accuracy(reltol=1e-5, chgtol=1e-17, step=0.2e-9, bodies=True)  # ten times tighter ngspice gives up at an edge
FLAG = re.compile(r"(?P<kind>sample|strobe|d|select)(?P<a>\d+)(?:_(?P<b>\d+))?")


def controls(deck: Deck, cycles: Cycle, lanes: int, tile_cols: int) -> dict[str, npt.NDArray[np.bool_]]:
    """Return the bit of each source of ``deck`` in every cycle, as front_end.sv makes it from the pins."""
    found = {}
    for line in deck.drive:
        name = line.split()[0].removeprefix("v")
        match = FLAG.fullmatch(name)
        assert match, name
        a, b = int(match["a"]), int(match["b"] or 0)
        if match["kind"] == "sample":
            found[name] = cycles.hold
        elif match["kind"] == "strobe":
            found[name] = cycles.deciding[:, a]
        elif match["kind"] == "d":
            found[name] = (cycles.asked[:, a] >> b & 1) != 0
        else:
            here = (cycles.k == a % tile_cols) & (cycles.group == a // tile_cols // lanes) & (cycles.sub == b)
            found[name] = cycles.hold & here
    return found


def corners(line: str, bits: npt.NDArray[np.bool_], timing: Timing) -> list[tuple[float, float]]:
    """(s, V) of one source of the drive. line: of +drive."""
    _, _, low, high, half, rise, fall = line.split()
    volts, points = float(low), [(0.0, float(low))]
    for i, bit in enumerate(bits):
        begin = i * timing.period
        changes = [(begin + float(fall), float(low))] if half == "1" or not bit else []
        if bit:
            changes.append((begin + timing.high * (half == "1") + float(rise), float(high)))
        for start, target in changes:
            if target != volts:
                points += [(start, volts)] * (start > points[-1][0])
                points.append((start + timing.edge, target))
                volts = target
    return points


def replay(deck: Deck, run: Run, lanes: int, tile_cols: int, timing: Timing, accuracy: Accuracy = TIGHT) -> Run:
    """``run`` again off-line with ``deck``, made for ``accuracy``; the answers stay. Raises ToolError."""
    bits = controls(deck, run.cycles, lanes, tile_cols)
    sources = []
    for line in deck.drive:
        name = line.split()[0].removeprefix("v")
        pairs = " ".join(f"{t:.12g} {v:g}" for t, v in corners(line, bits[name], timing))
        sources.append(f"V{name} {name} 0 PWL({pairs})")
    driven = {f"V{line.split()[0].removeprefix('v')} " for line in deck.drive}
    rest = [line for line in deck.lines if not any(line.startswith(name) for name in driven)]
    stop = len(run.cycles.hold) * timing.period
    tran = f".tran {accuracy.step:.6g} {stop:.9g} 0 {accuracy.step:.6g}"
    with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
        file, raw = Path(folder) / "deck.sp", Path(folder) / "deck.raw"
        file.write_text("\n".join([*rest[:-1], *sources, tran, ".end", ""]), encoding="utf-8")
        start = perf_counter()
        done = finish(["ngspice", "-n", "-b", "-r", raw, file], env={"OMP_NUM_THREADS": "1"})
        seconds = perf_counter() - start
        if not raw.exists():
            raise ToolError(f"ngspice: no waves off-line: {(done.stdout + done.stderr).strip()[-400:]}")
        time, waves = read_raw(raw)
    if time[-1] < stop * (1 - 1e-6):
        raise ToolError(f"ngspice: off-line it ended at {time[-1]:.4g} s of {stop:.4g}")
    return Run(run.stream, run.cycles, time, waves, {"seconds": seconds, "accepted": len(time)}, 1)


def read_raw(path: Path) -> tuple[npt.NDArray[np.float64], dict[str, npt.NDArray[np.float64]]]:
    """Time and the other vectors of ngspice's binary file."""
    head, _, body = path.read_bytes().partition(b"Binary:\n")
    names = [name.decode() for name in re.findall(rb"^\t\d+\t(\S+)\t", head, re.M)]
    table = np.frombuffer(body).reshape(-1, len(names)).T
    waves = {name.removeprefix("v(").removesuffix(")"): row for name, row in zip(names, table, strict=True)}
    return waves.pop("time"), waves
