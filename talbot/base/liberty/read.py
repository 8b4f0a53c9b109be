"""Liberty text into a tree."""

import fnmatch
import re
from collections.abc import Callable, Collection, Sequence
from math import inf
from pathlib import Path

from talbot.base.liberty.group import Group, Scalar, Table
from talbot.models.parameters import ParameterError

_TOKEN = re.compile(r'/\*.*?\*/|//[^\n]*|\\\r?\n|"((?:[^"\\]|\\.)*)"|([{}();:,])|([^\s{}();:,"]+)', re.S)
_END = re.compile(r"\}\s*;?\s*(?:/\*[^*]*\*/\s*|//[^\n]*\s*)*\Z")
_LIBRARY = re.compile(r"(?:\s|/\*.*?\*/|//[^\n]*\n)*library\s*\(", re.S)
Token = tuple[str, bool]  # text, and whether it is quoted
_CELL = re.compile(r'^[ \t]*cell\s*\(\s*"?([\w.$]+)"?\s*\)\s*\{', re.M)


def read(path: str | Path) -> Group:
    """Return the outermost group of a Liberty file. Raises ParameterError naming what is wrong."""
    return parse(text_of(path), str(path))


def text_of(path: str | Path) -> str:
    """The text of a Liberty file: UTF-8, with a byte order mark or without, else Latin-1; lines end with a newline."""
    data = Path(path).read_bytes().replace(b"\r\n", b"\n")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("latin-1")


def plain(text: str) -> str:
    """``text`` as every tool reads it: ASCII, no semicolon after a group's brace."""
    text = re.sub(r"\}[ \t]*;", "}", text)
    return text.encode("ascii", "replace").decode()


def parse(text: str, origin: str = "liberty") -> Group:
    """As `read`, of a text; ``origin`` names it in errors."""
    tokens = [
        (m[1] if m[1] is not None else m[2] or m[3], m[1] is not None)
        for m in _TOKEN.finditer(text)
        if m[1] is not None or m[2] or m[3]
    ]
    reader = _Reader(tokens, origin)
    try:
        return reader.group(*reader.head())
    except IndexError:
        raise ParameterError(f"liberty = {origin}: ends within a group") from None


def names(text: str) -> set[str]:
    """Return the names of the cells in the text of a Liberty file, which is not read further."""
    return {match[1] for match in _CELL.finditer(text)}


def is_library(path: Path) -> bool:
    """Return whether a file begins as a Liberty file does, after comments: library (...)."""
    return bool(_LIBRARY.match(text_of(path)[:10_000]))


def is_whole(path: Path) -> bool:
    """Return whether a file ends as a Liberty file does, before comments: with a brace."""
    return bool(_END.search(text_of(path)[-1_000:]))


def areas(path: Path) -> dict[str, float]:
    """Return the area of every cell of a Liberty file, in its own unit (um2)."""
    return {cell.name: cell.number("area") for cell in read(path).all("cell")}


def most_loads(path: Path) -> dict[str, float]:
    """The least max_capacitance of the outputs of every cell of a Liberty file that states any, in its own unit."""
    limits = {
        cell.name: [pin.number("max_capacitance", inf) for pin in cell.all("pin")] for cell in read(path).all("cell")
    }
    return {cell: least for cell, found in limits.items() if (least := min(found, default=inf)) < inf}


def without(text: str, patterns: Sequence[str]) -> str:
    """``text`` without the cells whose names match one of ``patterns`` (fnmatch), all else byte-identical.

    For mappers that have no such option; a foundry's file is not reformatted. Raises ParameterError.
    """
    return _kept(text, lambda name: not any(fnmatch.fnmatchcase(name, pattern) for pattern in patterns))


def only(text: str, names: Collection[str]) -> str:
    """``text`` with no other cells than ``names``, all else byte-identical. Raises ParameterError."""
    return _kept(text, lambda name: name in names)


def _kept(text: str, keep: Callable[[str], bool]) -> str:
    """``text`` without the cells whose names ``keep`` refuses."""
    kept, at = [], 0
    for match in _CELL.finditer(text):
        if not keep(match[1]):
            kept.append(text[at : match.start()])
            at = _end(text, match)
    return "".join([*kept, text[at:]])


def _end(text: str, match: re.Match[str]) -> int:
    """Index after the group that ``match`` opens, and after its end of line."""
    depth = 1
    for token in _TOKEN.finditer(text, match.end()):
        depth += {"{": 1, "}": -1}.get(token[2], 0)
        if not depth:
            return token.end() + text.startswith("\n", token.end())
    raise ParameterError(f"liberty = cell {match[1]}: must end with a brace")


class _Reader:
    def __init__(self, tokens: list[Token], origin: str) -> None:
        self.tokens, self.origin, self.at = tokens, origin, 0

    def next(self) -> Token:
        self.at += 1
        return self.tokens[self.at - 1]

    def mark(self, text: str) -> bool:
        """Take the punctuation ``text`` if it is next."""
        found = self.at < len(self.tokens) and self.tokens[self.at] == (text, False)
        self.at += found
        return found

    def head(self) -> tuple[str, list[Token]]:
        """Return a statement's name and, after it, its arguments in parentheses."""
        name, _ = self.next()
        if not self.mark("("):
            raise ParameterError(f"liberty = {self.origin}: {name!r} must be followed by ':' or '('")
        arguments = []
        while not self.mark(")"):
            if not self.mark(","):
                arguments.append(self.next())
        return name, arguments

    def group(self, kind: str, arguments: list[Token]) -> Group:
        """Return the group whose head has been read."""
        if not self.mark("{"):
            raise ParameterError(f"liberty = {self.origin}: {kind!r} must be a group")
        group = Group(kind, tuple(text for text, _ in arguments))
        while not self.mark("}"):
            if self.mark(";"):  # after a group: foundries have it
                continue
            if self.tokens[self.at + 1] == (":", False):
                name, _ = self.next()
                self.at += 1
                group.attributes[name] = self._value()
                self.mark(";")
                continue
            name, inside = self.head()
            if self.tokens[self.at] == ("{", False):
                group.groups.append(self.group(name, inside))
                continue
            self.mark(";")
            _add(group, name, inside)
        return group

    def _value(self) -> Scalar:
        word, quoted = self.next()
        words = [word]
        while not quoted and self.tokens[self.at] not in ((";", False), ("}", False)):
            if self.tokens[self.at][0] not in "+-*":
                break
            words += [self.next()[0], self.next()[0]]
        return word if quoted else _scalar(" ".join(words))


def _scalar(word: str) -> Scalar:
    try:
        return float(word)
    except ValueError:
        return {"true": True, "false": False}.get(word, word)


def _add(group: Group, name: str, arguments: list[Token]) -> None:
    """Set the attribute ``name (arguments)``: a table, or a tuple; a list of tuples where it is repeated."""
    if name == "values" or name.startswith("index_"):
        group.attributes[name] = _table(arguments)
        return
    value = tuple(text if quoted else _scalar(text) for text, quoted in arguments)
    before = group.attributes.get(name)
    if isinstance(before, tuple):
        group.attributes[name] = [before, value]
    elif isinstance(before, list):
        group.attributes[name] = [*(one for one in before if isinstance(one, tuple)), value]
    else:
        group.attributes[name] = value


def _table(arguments: list[Token]) -> Table:
    rows = [[float(x) for x in re.split(r"[\s,]+", row.strip(" ,")) if x] for row, _ in arguments]
    return rows[0] if len(rows) == 1 else rows
