"""The guided search: sessions that reach new points become the corpus, from which the next ones are mutated."""

import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from talbot.base.files import write
from talbot.base.tools import ToolError
from talbot.models.parameters import ParameterError
from talbot.verif.fuzz.checks import Broken
from talbot.verif.fuzz.chip.golden import check
from talbot.verif.fuzz.chip.program import CHIPS, program, run_sessions
from talbot.verif.fuzz.chip.sessions import Maker, Session, read

GROUP = 32  # sessions of one run of the program
FAILURES = 3  # at which a search ends
LATE = "late synchronizers"
FRESH = 0.25  # share of sessions that are not mutations


@dataclass(frozen=True)
class Search:
    """The result for a chip. points: reached, of counters and steps. corpus: sessions kept. failures: one line each."""

    chip: str
    sessions: int
    cycles: int
    points: int
    corpus: int
    seconds: float
    failures: list[str] = field(default_factory=list)


def file_of(folder: Path, name: str) -> Path:
    """Return the file of a chip's corpus."""
    return folder / f"{name.replace(', ', '-').replace(' ', '_')}.corpus"


def tried(name: str, path: Path, sessions: list[Session], folder: Path, late: bool) -> list[tuple[int, int, str]]:
    """Run sessions on a chip; returns fresh points, cycles and the problem, '' for none, of each."""
    try:
        runs = run_sessions(path, [session.line for session in sessions], folder, late)
    except ToolError as error:  # the contract is broken in one of them
        if len(sessions) == 1:
            return [(0, 0, str(error).splitlines()[-1])]
        return [result for session in sessions for result in tried(name, path, [session], folder, late)]
    results = []
    for session, run in zip(sessions, runs, strict=True):
        try:
            check(CHIPS[name], session, run)
            results.append((run.fresh, run.cycles, ""))
        except Broken as error:
            results.append((run.fresh, run.cycles, str(error)))
    return results


def search(name: str, cycles: int, seed: int, folder: Path, verilog: str = "") -> Search:
    """Try sessions for ``cycles`` cycles, every second group with late synchronizers; stop at three failures.

    folder: of the corpus, which a later search begins with. verilog: instead of the chip's.
    """
    start, path, kept = time.perf_counter(), program(name, verilog), file_of(folder, name)
    maker = Maker(CHIPS[name], np.random.default_rng([seed, [*CHIPS].index(name)]))
    waiting = [read(line) for line in kept.read_text(encoding="utf-8").splitlines()] if kept.exists() else []
    corpus: list[Session] = []
    done = points = spent = 0
    failures: list[str] = []
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="talbot-") as work:
        while spent < cycles and len(failures) < FAILURES:
            group, waiting = waiting[:GROUP], waiting[GROUP:]
            late = done // GROUP % 2 == 1
            while len(group) < GROUP:
                if not corpus or maker.rng.random() < FRESH:
                    group.append(maker.session())
                else:
                    first, second = (corpus[i] for i in maker.rng.integers(len(corpus), size=2))
                    group.append(maker.mutated(first, second))
            for session, result in zip(group, tried(name, path, group, Path(work), late), strict=True):
                fresh, length, problem = result
                done, spent, points = done + 1, spent + length, points + fresh
                if problem and len(failures) < FAILURES:
                    file = folder / f"failing-{seed}-{done}.session"
                    write(file, f"{name}\n{LATE if late else ''}\n{session.line}\n")
                    failures.append(f"{name}: {problem}; again: talbot fuzz --session {file}")
                elif fresh and not problem:
                    corpus.append(session)
    write(kept, "".join(f"{session.line}\n" for session in corpus))
    return Search(name, done, spent, points, len(corpus), round(time.perf_counter() - start, 1), failures)


def again(file: Path) -> list[str]:
    """Run the session of a file of `search`; returns what is wrong with it."""
    try:
        name, late, line = file.read_text(encoding="utf-8").splitlines()
    except (OSError, ValueError):
        raise ParameterError(f"session = {file}: must be a file of a session that failed") from None
    with tempfile.TemporaryDirectory(prefix="talbot-") as work:
        ((_, cycles, problem),) = tried(name, program(name), [read(line)], Path(work), late == LATE)
    print(f"{name}: {cycles} cycles, {problem or 'as the golden chip'}")
    return [problem] if problem else []
