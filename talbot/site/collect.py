"""The repository's Markdown as the source of the site: the same files at the same places, README.md as the index.

A link to a document leads to its page, one to a folder to its README; one to any other file becomes text, as the site
has documents alone. A link to what does not exist is an error.
"""

import os
import re
import shutil
from collections.abc import Iterator
from pathlib import Path

FOLDERS = "docs", "models", "rtl", "imaging", "memory", "pixels", "cells", "signoff", "flow", "verif", "talbot"
IMAGE = re.compile(r"!\[[^\]]*\]\(([^)\s]+)\)")
# Code, which stays as it is, or a link, perhaps with code for its words
LINK = re.compile(r"(?ms)^```.*?^```|^ {4}.*?$|(?<!!)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s]+)\)|`[^`\n]+`")
# Title of a part of the contents -> its documents, in order; a folder: all in it that no other part has
PARTS = {
    "Start": ("docs/install", "docs/tutorial", "docs/how-to", "docs/comparison"),
    "Reference": ("api", "docs/chip", "docs/registers", "docs/stream", "docs/host", "docs/bring-up", "docs/figures"),
    "Results": ("docs/gallery", "docs/results"),
    "Models": ("models",),
    "The chip, block by block": ("rtl",),
    "Pictures": ("imaging",),
    "Pixels and cells": ("pixels", "cells", "memory"),
    "Layout": ("flow", "signoff", "talbot/platforms"),
    "Verification": ("verif",),
    "Project": (
        "talbot",
        "docs/glossary",
        "docs/limits",
        "CONTRIBUTING",
        "CHANGELOG",
        "docs/bibliography",
        "docs/decisions",
        "docs/licences",
    ),
}


def documents(root: Path) -> list[Path]:
    """Every Markdown file of the repository, relative to ``root``."""
    found = [*root.glob("*.md"), *(path for folder in FOLDERS for path in (root / folder).rglob("*.md"))]
    return sorted(path.relative_to(root) for path in found)


def collect(root: Path, source: Path) -> list[str]:
    """Write the documents of ``root`` and their pictures into ``source``; returns a line for each link to nothing."""
    broken: list[str] = []
    for name in documents(root):
        text = (root / name).read_text(encoding="utf-8")
        pictures = [name.parent / link for link in IMAGE.findall(text) if "://" not in link]
        for picture in pictures:
            if not (root / picture).is_file():
                broken.append(f"{name}: ![]({picture}) leads nowhere")
                continue
            (source / picture).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(root / picture, source / picture)
        path = source / page_of(name)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(linked(text, name, root, broken), encoding="utf-8")
    return broken


def page_of(name: Path) -> Path:
    """Return the place of a document in the source of the site."""
    return Path("index.md") if name == Path("README.md") else name


def linked(text: str, name: Path, root: Path, broken: list[str]) -> str:
    """The text of the document ``name`` with the links of the site; lines about links to nothing go to ``broken``."""

    def link(found: re.Match[str]) -> str:
        words, (target, mark, anchor) = found[1], (found[2] or "").partition("#")
        if not target or "://" in target or target.startswith("mailto:"):
            return found[0]
        there = Path(os.path.normpath(name.parent / target))
        if (root / there).is_dir() and (root / there / "README.md").is_file():
            there = there / "README.md"
        if not (root / there).exists():
            broken.append(f"{name}: [{words}]({found[2]}) leads nowhere")
        if there.suffix != ".md":
            return words
        return f"[{words}]({os.path.relpath(page_of(there), page_of(name).parent)}{mark}{anchor})"

    return LINK.sub(link, text)


def contents(source: Path) -> str:
    """Return the site's contents, for the end of the index: every document in one of PARTS."""
    every = [path.relative_to(source).with_suffix("").as_posix() for path in source.rglob("*.md")]
    named = {name for names in PARTS.values() for name in names}
    lines = []
    for title, names in PARTS.items():
        lines += ["", "```{toctree}", ":hidden:", f":caption: {title}", ""]
        for name in names:
            lines += [name] if name in every else sorted(_below(every, name, named))
        lines.append("```")
    return "\n".join([*lines, ""])


def _below(every: list[str], folder: str, named: set[str]) -> Iterator[str]:
    return (name for name in every if name.startswith(f"{folder}/") and name not in named)
