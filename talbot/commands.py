"""The command line: the parser of all commands, and the one that is chosen, run."""

import argparse
import importlib
import os
from collections.abc import Sequence
from importlib.metadata import version
from types import ModuleType

from talbot.base.check import ONLY
from talbot.base.command import Parser, add_command, execute, guarded
from talbot.base.page import index
from talbot.base.paths import RESULTS
from talbot.front import COMMANDS, listing
from talbot.make import arguments

STATUS = """talbot COMMAND --help lists the options of a command.

Exit status: 0 right, 1 a check fails (the chip and its golden model differ, a bound is missed, a stream is damaged),
2 bad input or environment (one line on standard error: field, value and range), 3 an error in Talbot itself (one line,
and the file that has its traceback), 130 Ctrl-C, 143 terminated.
"""


def parser(chosen: str = "") -> Parser:
    """Return the parser of all commands, with the arguments of ``chosen`` alone."""
    about = f"The open design flow for angle-sensitive-pixel sensors.\n\n{listing(make=False)}"
    layout = argparse.RawDescriptionHelpFormatter
    top = Parser(prog="talbot", description=about, epilog=STATUS, formatter_class=layout, usage="talbot COMMAND ...")
    top.add_argument("--version", action="version", version=f"%(prog)s {version('talbot')}")
    commands = top.add_subparsers(
        dest="command", required=True, metavar="COMMAND", prog="talbot", help=argparse.SUPPRESS
    )
    for name in COMMANDS:
        sub = commands.add_parser(name)
        if name == chosen:
            add_command(sub, command(name))
    return top


def command(name: str) -> ModuleType:
    """Return the module of a command, imported now."""
    return importlib.import_module(f"talbot.{COMMANDS[name].module}")


def main(argv: Sequence[str]) -> int:
    """Run the command of ``argv``; returns the exit status. '--make', from the Makefile, is for `talbot.make`."""
    words = list(argv)
    Parser.of_make = words[:1] == ["--make"]
    if Parser.of_make:
        _, given, name, *fixed = words
        alone = Parser(prog=f"talbot {name}")
        add_command(alone, command(name))
        words = [name, *arguments(alone, given, fixed)]
    status = execute(parser(words[0] if words else ""), words)
    if status not in (0, 1) or os.environ.get(ONLY):
        return status
    return guarded("talbot", lambda: refreshed(status))


def refreshed(status: int) -> int:
    """Bring the page over all results up to date; returns ``status``."""
    index.refresh(RESULTS)
    return status
