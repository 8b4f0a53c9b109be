"""The page over a folder of results: a card for each page in it that has one."""

import html
import json
import re
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, NamedTuple

from base.files import write

from . import FOLDER, Tile, render

NAME = "index.html"
HEAD = 100_000  # characters of a page in which its card is
PATTERNS = ("*/*.html", "*/*/*.html")
CARD = re.compile(r'<meta name="talbot" content="([^"]*)">')


class Card(NamedTuple):
    """A page of the index. href, folder: relative to the folder of all. when: UTC."""

    href: str
    folder: str
    when: str
    title: str
    tiles: list[Tile]
    picture: str


def refresh(folder: Path) -> Path:
    """Write the index of ``folder`` where it would change, none where there is no page; returns its path."""
    pages = {path: path.stat().st_mtime for pattern in PATTERNS for path in folder.glob(pattern)}
    cards = {path: found for path in sorted(pages, key=lambda path: -pages[path]) if (found := read(path, folder))}
    groups: dict[str, list[Card]] = {}
    for path, found in cards.items():
        groups.setdefault(path.relative_to(folder).parts[0], []).append(found)
    text = render(FOLDER / "index.html", "Talbot: results", listed=False, groups=groups)
    if (folder / NAME).is_file() and (folder / NAME).read_text() == text:
        return folder / NAME
    if cards or (folder / NAME).is_file():
        write(folder / NAME, text)
    return folder / NAME


def read(path: Path, folder: Path) -> Card | None:
    """The card of a page below ``folder``, None where it has none."""
    with path.open(errors="replace") as file:
        found = CARD.search(file.read(HEAD))
    if not found:
        return None
    values: dict[str, Any] = json.loads(html.unescape(found[1]))
    when = datetime.fromtimestamp(path.stat().st_mtime, UTC).strftime("%Y-%m-%d %H:%M UTC")
    href = path.relative_to(folder)
    tiles = [Tile(*tile) for tile in values["tiles"]]
    return Card(href.as_posix(), href.parent.as_posix(), when, values["title"], tiles, values["picture"])
