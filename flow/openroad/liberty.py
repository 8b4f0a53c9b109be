"""A Liberty file without the cells that must not be used: what a mapper that has no such option may read."""

import fnmatch
import re

from models.parameters import ParameterError

CELL = re.compile(r'^[ \t]*cell\s*\(\s*"?([\w.$]+)"?\s*\)\s*\{', re.M)


def without(text, patterns):
    """``text`` without the cells whose names match one of ``patterns`` (fnmatch). Raises ParameterError."""
    kept, at = [], 0
    for match in CELL.finditer(text):
        if any(fnmatch.fnmatchcase(match[1], pattern) for pattern in patterns):
            kept.append(text[at : match.start()])
            at = _end(text, match)
    return "".join([*kept, text[at:]])


def _end(text, match):
    """Where the group that ``match`` opens has ended."""
    depth = 1
    for brace in re.compile(r'"(?:[^"\\]|\\.)*"|[{}]').finditer(text, match.end()):
        depth += {"{": 1, "}": -1}.get(brace[0], 0)
        if not depth:
            return brace.end() + text.startswith("\n", brace.end())
    raise ParameterError(f"liberty = cell {match[1]}: must end with a brace")
