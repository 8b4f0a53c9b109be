"""Variables of make's command line as options of a command: `make sim SCENE=coins` is `talbot sim --scene=coins`.

The Makefile names the target and its own variables (`--make 'sim PYTHON PDK_ROOT'`); every other one must be an
argument of the command. Values come from MAKEFLAGS as they were typed: no shell and no make has expanded them. With
`make -e` those of the environment count, too.
"""

import argparse
import os
import re
import sys
from collections.abc import Mapping, Sequence

from talbot.base.command import LIKE, Parser
from talbot.models.parameters.sensor_file import nearest

YES, NO = ("1", "yes", "true", "on"), ("0", "no", "false", "off")


def variables(flags: str) -> dict[str, str]:
    """Name to value of the variables in ``flags``, the text of MAKEFLAGS: after ' -- ', with make's quoting.

    Make 3.81 (macOS) leaves ' -- ' out where there are no options.
    """
    before, dashes, after = f" {flags}".partition(" -- ")
    text = after if dashes or "=" not in before.split(" -")[0] else before
    values = {}
    for word in re.findall(r"(?:\\.|[^ \t\\])+", text, re.DOTALL):
        name, _, value = re.sub(r"\\(.)", r"\1", word, flags=re.DOTALL).partition("=")
        values[name.rstrip(":")] = value.replace("$$", "$")
    return values


def arguments(
    parser: Parser, target_line: str, fixed: Sequence[str], environment: Mapping[str, str] = os.environ
) -> list[str]:
    """The arguments for ``parser``, a command's own: ``fixed``, which the target passes itself, then the variables.

    given: the target, then the variables that are not for the command. A variable that neither knows ends the program
    with status 2 and the nearest name; in a make that another make started it may be that one's, and is left alone.
    """
    target, *of_make = target_line.split()
    known = {action.dest.upper(): action for action in parser.actions if action.option_strings or not fixed}
    flags = environment.get("MAKEFLAGS", "")
    flags = flags.replace("$(MAKEOVERRIDES)", environment.get("TALBOT_OVERRIDES", ""))  # of make -e
    typed = {name: v for name, v in variables(flags).items() if name not in of_make}
    if "e" in re.match(r"[a-zA-Z]*", flags)[0]:  # pyright: ignore[reportOptionalSubscript]
        typed = {name: environment[name] for name in known.keys() & environment.keys()} | typed
    for name in sorted(typed.keys() - known.keys()) if environment.get("MAKELEVEL") == "1" else ():
        must = nearest(name.upper(), [*known, *of_make], LIKE)
        parser.error(f"{name} = {typed[name]!r}: must be a variable of make {target}{must}")
    for name in known.keys() & environment.keys() - typed.keys():
        print(f"talbot: {name} of the environment is not used: make {target} {name}=...", file=sys.stderr)
    words, last = [*fixed], ["--"]
    for name, action in known.items():
        if value := typed.get(name):
            if action.nargs == 0:  # a flag, which the target may have set
                words = [word for word in words if word not in action.option_strings]
            where = words if action.option_strings else last
            where += _words(parser, name, action, value)
    return words + (last if len(last) > 1 else [])


def _at_home(parser: Parser, name: str, value: str) -> str:
    """Return a value with ~ or ~user before it expanded: no shell has seen it (SCENE=~/photo.png)."""
    path = os.path.expanduser(value)
    if path.startswith("~"):
        parser.error(f"{name} = {value!r}: must begin with a user's home folder (or ./{value})")
    return path


def _words(parser: Parser, name: str, action: argparse.Action, value: str) -> list[str]:
    option = list(action.option_strings[-1:])
    several = isinstance(action, argparse._AppendAction) or action.nargs not in (0, None, "?")
    value = " ".join(_at_home(parser, name, word) for word in (value.split() if several else [value]))
    if action.nargs == 0:
        if value.lower() not in YES + NO:
            parser.error(f"{name} = {value!r}: must be 1 or 0")
        return option if value.lower() in YES else []
    if isinstance(action, argparse._AppendAction):
        return [f"{option[0]}={word}" for word in value.split()]
    if action.nargs in (None, "?"):
        return [f"{option[0]}={value}" if option else value]
    return [*option, *value.split()]
