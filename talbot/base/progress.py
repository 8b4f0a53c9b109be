"""Progress: a bar on a terminal, a line for each long step elsewhere."""

import os
import sys
from collections.abc import Callable, Iterable, Iterator, Sized
from threading import Event, Thread
from time import monotonic
from typing import Any, Self, TypeVar

from tqdm import tqdm

from talbot.base.check import work_begins

T = TypeVar("T")
INTERVAL = 2.0  # s between the lines of `Frames` and of `each`
TICK = 0.5  # s between two looks of a terminal's clock


def terminal() -> dict[str, Any]:
    """Size of the terminal, of tqdm; one that says 0 x 0, as under some containers and editors, has 80 x 24."""
    try:
        columns, rows = os.get_terminal_size(sys.stderr.fileno())
    except (OSError, ValueError, AttributeError):
        columns = rows = 0
    return {"ncols": columns or 80, "nrows": rows or 24}


def line(text: str) -> None:
    """Print a line about a long part of a step, where no terminal shows a bar."""
    if not sys.stderr.isatty():
        print(f"        {text}", file=sys.stderr, flush=True)


def say(text: str) -> None:
    """Print a line that a user must see, above the bars of a terminal."""
    tqdm.write(text, file=sys.stderr)


def each(
    items: Iterable[T], title: str, name: Callable[[T], object] = lambda item: "", total: int | None = None
) -> Iterator[T]:
    """Yield the items; a bar on a terminal, elsewhere a line as one ends, with the seconds since the line before.

    Within a step of `Steps` they move its bar. Items that take no time share a line. total: how many, where ``items``
    does not tell.
    """
    work_begins()
    total = len(items) if isinstance(items, Sized) else total
    began, of, within = monotonic(), total or "-", Steps.current
    with tqdm(total=total, desc=title, file=sys.stderr, disable=True if within else None, **terminal()) as bar:
        for number, item in enumerate(items, 1):
            words = " ".join(f"{title} {name(item)}".split())
            if within:
                within.part(number - 1, total, words)
            yield item
            bar.update()
            spent = monotonic() - began
            if not sys.stderr.isatty() and (spent >= INTERVAL or number == total):
                print(f"{number:>3}/{of} {words}: {spent:.1f} s", file=sys.stderr, flush=True)
                began = monotonic()


def ended(step: str, seconds: float) -> str:
    """Return a line about a step that ended."""
    return f"{step}: {seconds:.1f} s"


class Steps:
    """A bar over the steps named in ``names``, whose clock goes on while one takes long; `each` moves it within one.

    lines: whether each is a line where there is no terminal: of steps that take minutes.
    """

    current: "Steps | None" = None  # whose body runs

    def __init__(self, names: Iterable[str], lines: bool = False) -> None:
        work_begins()
        self.names, self.lines = list(names), lines
        self.number, self.text, self.end = 0, "", Event()
        self.bar = tqdm(total=len(self.names), file=sys.stderr, leave=False, disable=None, **terminal())
        self._show(0.0)

    def __enter__(self) -> Self:
        Steps.current = self
        if not self.bar.disable:
            self.end.clear()
            Thread(target=self._tick, daemon=True).start()
        return self

    def __exit__(self, *_: Any) -> None:
        Steps.current = None
        self.end.set()
        self.bar.close()

    def note(self, text: str) -> None:
        """Show ``text``: a step's name, which moves the bar, or a line about the step; of one that ended, `ended`."""
        if text in self.names:
            number = self.number = self.names.index(text)
            self.bar.n = number
        elif (step := text.rpartition(": ")[0]) in self.names:
            number = self.names.index(step)
        else:
            number = self.number
        if self.bar.disable and (self.lines or text not in self.names):
            print(f"{number + 1:>3}/{len(self.names)} {text}", file=sys.stderr, flush=True)
        self.text = text
        self._show(self.bar.n)

    def part(self, done: int, total: int | None, text: str) -> None:
        """Move the bar within the step, to where ``done`` of ``total`` are; text: what is next."""
        self.text = f"{text}, {done + 1}/{total or '-'}"
        self._show(self.number + (done / total if total else 0.0))

    def _show(self, place: float) -> None:
        """Draw the bar at ``place``, in steps, with their number and the text."""
        self.bar.n = place  # tqdm counts in floats, too
        text = self.text.replace("{", "{{").replace("}", "}}")
        self.bar.bar_format = f"{self.number + 1}/{len(self.names)} |{{bar:24}}| {text} [{{elapsed}}]"
        self.bar.refresh(nolock=True)

    def _tick(self) -> None:
        """Draw the bar again and again, for its clock; without tqdm's lock, which a process may inherit held."""
        while not self.end.wait(TICK):
            self.bar.refresh(nolock=True)


class Frames:
    """A bar over frames; where there is no terminal, a line now and then. count: None where it is not known."""

    def __init__(self, count: int | None) -> None:
        work_begins()
        self.count, self.done, self.spoke = count, 0, monotonic()
        self.bar = tqdm(total=count, file=sys.stderr, leave=False, disable=None, unit=" frames", **terminal())

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: Any) -> None:
        self.bar.close()

    def note(self, text: str) -> None:
        """Show a line about a long part."""
        line(text)
        self.bar.set_description_str(text)

    def step(self) -> None:
        """Count a frame."""
        self.done += 1
        self.bar.set_description_str("")
        self.bar.update()
        if monotonic() - self.spoke > INTERVAL:
            self.spoke = monotonic()
            line(f"frame {self.done}" + (f" of {self.count}" if self.count else ""))
