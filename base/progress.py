"""Progress: a bar on a terminal, a line for each long step elsewhere."""

import sys
from collections.abc import Callable, Iterable, Iterator, Sized
from time import monotonic
from typing import Any, Self, TypeVar

from tqdm import tqdm

from .check import work_begins

T = TypeVar("T")
INTERVAL = 2.0  # s between the lines of `Frames` and of `each`


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
    """The items; a bar on a terminal, elsewhere a line as one ends, with the seconds since the line before.

    Items that take no time share a line. total: how many, where ``items`` does not tell.
    """
    work_begins()
    total = len(items) if isinstance(items, Sized) else total
    began, of = monotonic(), total or "-"
    with tqdm(total=total, desc=title, file=sys.stderr, disable=None) as bar:
        for number, item in enumerate(items, 1):
            yield item
            bar.update()
            spent = monotonic() - began
            if bar.disable and (spent >= INTERVAL or number == total):
                words = " ".join(f"{title} {name(item)}".split())
                print(f"{number:>3}/{of} {words}: {spent:.1f} s", file=sys.stderr, flush=True)
                began = monotonic()


def ended(step: str, seconds: float) -> str:
    """A line about a step that ended."""
    return f"{step}: {seconds:.1f} s"


class Steps:
    """A bar over the steps named in ``names``.

    lines: whether each is a line where there is no terminal: of steps that take minutes.
    """

    def __init__(self, names: Iterable[str], lines: bool = False) -> None:
        work_begins()
        self.names, self.lines = list(names), lines
        self.bar = tqdm(
            total=len(self.names),
            file=sys.stderr,
            leave=False,
            disable=None,
            bar_format="{n_fmt}/{total_fmt} |{bar:24}| {desc} [{elapsed}]",
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: Any) -> None:
        self.bar.close()

    def note(self, text: str) -> None:
        """Show ``text``: a step's name, which moves the bar, or a line about the step; of one that ended, `ended`."""
        number = self.bar.n
        if text in self.names:
            number = self.bar.n = self.names.index(text)
        elif (step := text.rpartition(": ")[0]) in self.names:
            number = self.names.index(step)
        if self.bar.disable and (self.lines or text not in self.names):
            print(f"{number + 1:>3}/{len(self.names)} {text}", file=sys.stderr, flush=True)
        self.bar.set_description_str(text)


class Frames:
    """A bar over frames; where there is no terminal, a line now and then. count: None where it is not known."""

    def __init__(self, count: int | None) -> None:
        work_begins()
        self.count, self.done, self.spoke = count, 0, monotonic()
        self.bar = tqdm(total=count, file=sys.stderr, leave=False, disable=None, unit=" frames", dynamic_ncols=True)

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
