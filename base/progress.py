"""Progress: a bar on a terminal, a line for each long step elsewhere."""

import sys
from collections.abc import Iterable
from time import monotonic
from typing import Any, Self

from tqdm import tqdm

INTERVAL = 2.0  # s between the lines of `Frames`


def line(text: str) -> None:
    """Print a line about a long part of a step, where no terminal shows a bar."""
    if not sys.stderr.isatty():
        print(f"        {text}", file=sys.stderr, flush=True)


class Steps:
    """A bar over the steps named in ``names``.

    lines: whether each is a line where there is no terminal: of steps that take minutes.
    """

    def __init__(self, names: Iterable[str], lines: bool = False) -> None:
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
        """Show ``text``: a step's name, which moves the bar, or a line about the step."""
        if text in self.names:
            self.bar.n = self.names.index(text)
        if self.bar.disable and (self.lines or text not in self.names):
            print(f"{self.bar.n + 1:>3}/{len(self.names)} {text}", file=sys.stderr, flush=True)
        self.bar.set_description_str(text)


class Frames:
    """A bar over frames; where there is no terminal, a line now and then. count: None where it is not known."""

    def __init__(self, count: int | None) -> None:
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
