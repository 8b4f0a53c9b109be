"""Liberty text into a tree."""

import re
from pathlib import Path

from base.liberty.group import Group
from models.parameters import ParameterError

_TOKEN = re.compile(r'/\*.*?\*/|//[^\n]*|\\\r?\n|"((?:[^"\\]|\\.)*)"|([{}();:,])|([^\s{}();:,"]+)', re.S)


def read(path):
    """The outermost group of a Liberty file. Raises ParameterError naming what is wrong."""
    return parse(Path(path).read_text(), str(path))


def parse(source, origin="liberty"):
    """As `read`, of a text."""
    tokens = [
        (m[1] if m[1] is not None else m[2] or m[3], m[1] is not None)
        for m in _TOKEN.finditer(source)
        if m[1] is not None or m[2] or m[3]
    ]
    reader = _Reader(tokens, origin)
    try:
        return reader.statement(None)
    except IndexError:
        raise ParameterError(f"liberty = {origin}: ends within a group") from None


class _Reader:
    def __init__(self, tokens, origin):
        self.tokens, self.origin, self.at = tokens, origin, 0

    def next(self):
        self.at += 1
        return self.tokens[self.at - 1]

    def peek(self):
        return self.tokens[self.at]

    def mark(self, text):
        """Take the punctuation ``text`` if it is next: bool."""
        if self.at < len(self.tokens) and self.tokens[self.at] == (text, False):
            self.at += 1
            return True
        return False

    def statement(self, parent):
        """One attribute of ``parent``, or a group (returned)."""
        name, _ = self.next()
        if self.mark(":"):
            parent.attributes[name] = self._value()
            self.mark(";")
            return None
        if not self.mark("("):
            raise ParameterError(f"liberty = {self.origin}: {name!r} must be followed by ':' or '('")
        arguments = []
        while not self.mark(")"):
            if not self.mark(","):
                arguments.append(self.next())
        if self.mark("{"):
            group = Group(name, tuple(a for a, _ in arguments))
            while not self.mark("}"):
                inside = self.statement(group)
                if inside is not None:
                    group.groups.append(inside)
            return group
        self.mark(";")
        parent.attributes[name] = _table(name, arguments)
        return None

    def _value(self):
        word, quoted = self.next()
        words = [word]
        while not quoted and self.peek() not in ((";", False), ("}", False)) and self.peek()[0] in "+-*":
            words += [self.next()[0], self.next()[0]]
        return word if quoted else _scalar(" ".join(words))


def _scalar(word):
    try:
        return float(word)
    except ValueError:
        return {"true": True, "false": False}.get(word, word)


def _table(name, arguments):
    if name == "values" or name.startswith("index_"):
        rows = [[float(x) for x in re.split(r"[\s,]+", row.strip(" ,")) if x] for row, _ in arguments]
        return rows[0] if len(rows) == 1 else rows
    return tuple(a if quoted else _scalar(a) for a, quoted in arguments)
