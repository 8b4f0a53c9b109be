"""The page over a folder of results: a card for each page in it that has one."""

import contextlib
import html
import json
import re
from collections import Counter
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, NamedTuple

from talbot.base.files import write
from talbot.base.page import FOLDER, Tile, render

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


def cards(folder: Path) -> list[Card]:
    """Those of the pages below ``folder``, the newest first."""
    pages = {}
    for path in (path for pattern in PATTERNS for path in folder.glob(pattern) if path.is_file()):
        with contextlib.suppress(OSError):  # another process has removed it, or it is another user's
            pages[path] = path.stat().st_mtime, read(path, folder)
    return [card for _, card in sorted(pages.values(), key=lambda page: -page[0]) if card]


def told_apart(cards: Sequence[Card]) -> list[Card]:
    """Return the cards, those of one title with what their folder or file is called, too."""
    titles = Counter(card.title for card in cards)
    places = Counter((card.title, Path(card.folder).name) for card in cards)
    out = []
    for card in cards:
        place = Path(card.folder).name
        if places[card.title, place] > 1:
            place = card.href.removesuffix(".html")
        out.append(card._replace(title=f"{card.title} ({place})") if titles[card.title] > 1 else card)
    return out


def refresh(folder: Path) -> Path:
    """Write the index of ``folder`` where it would change, none where there is no page; returns its path."""
    groups: dict[str, list[Card]] = {}
    for card in told_apart(cards(folder)):
        groups.setdefault(card.href.partition("/")[0], []).append(card)
    path, text = folder / NAME, render(FOLDER / "index.html", "Talbot: results", listed=False, groups=groups)
    if groups and not path.is_file() or path.is_file() and path.read_text(errors="replace", encoding="utf-8") != text:
        write(path, text)
    return path


def read(path: Path, folder: Path) -> Card | None:
    """Return the card of a page below ``folder``, None where it has none, or a damaged one. Raises OSError."""
    with path.open(encoding="utf-8", errors="replace") as file:
        found = CARD.search(file.read(HEAD))
    if not found:
        return None
    try:
        values: dict[str, Any] = json.loads(html.unescape(found[1]))
        tiles, title, picture = [Tile(*tile) for tile in values["tiles"]], values["title"], values["picture"]
    except (ValueError, LookupError, TypeError):
        return None
    when = datetime.fromtimestamp(path.stat().st_mtime, UTC).strftime("%Y-%m-%d %H:%M UTC")
    href = path.relative_to(folder)
    return Card(href.as_posix(), href.parent.as_posix(), when, title, tiles, picture)
