"""A command of the program `talbot`: what its module provides, and the one place that runs it and reports errors.

The module's docstring begins with what the command does, and the module has two functions: ``add_arguments(parser)``
declares the options, ``run(options)`` does the work and returns the exit status: 0, or 1 where a check fails. For bad
input or a tool that is missing or fails, it raises. In a package the module is command.py.
"""

import argparse
import contextlib
import os
import re
import sys
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from types import ModuleType
from typing import Any, NoReturn

from talbot.base import failure
from talbot.base.check import ONLY, Checked
from talbot.base.files import check_folder
from talbot.base.paths import BUILD
from talbot.base.tools import ToolError
from talbot.models.parameters import ParameterError
from talbot.models.parameters.sensor_file import nearest, printable

# A value too long to be read in an error's line, quoted or a word: its beginning, the rest
LONG = re.compile(r"""('[^']{80})[^']{80,}(?=')|("[^"]{80})[^"]{80,}(?=")|(\S{160})\S{160,}?(?=:?(?:\s|$))""")

LIKE = 0.7  # how like an unknown word the nearest known one must be, 0..1


class HelpFormatter(argparse.RawDescriptionHelpFormatter, argparse.ArgumentDefaultsHelpFormatter):
    """Shows the defaults of options that have one and do not name it: several as words, folders from here."""

    def _get_help_string(self, action: argparse.Action) -> str | None:
        default, words = action.default, action.help or ""
        if not default or default is argparse.SUPPRESS or "default" in words:
            return action.help
        if isinstance(default, list | tuple):
            default = " ".join(map(str, default))
        if isinstance(default, Path) and default.is_relative_to(Path.cwd()):
            default = default.relative_to(Path.cwd())
        return f"{words} (default: {str(default).replace('%', '%%')})"


class Parser(argparse.ArgumentParser):
    """A parser that refuses with one line, takes no abbreviations and shows defaults.

    of_make: whether its options are variables of make's command line, and errors name these.
    """

    of_make = False

    def __init__(self, **options: Any) -> None:
        super().__init__(**{"allow_abbrev": False, "formatter_class": HelpFormatter} | options)
        self._negative_number_matcher = re.compile(r"-\.?\d")  # as Python 3.14 has it: -1:3,0:2 and -1e1 are values

    @property
    def actions(self) -> list[argparse.Action]:
        """The parser's own arguments, without --help."""
        return [action for action in self._actions if not isinstance(action, argparse._HelpAction)]

    def parse_known_args(self, *arguments: Any, **named: Any) -> tuple[Any, list[str]]:
        """Refuse unknown arguments; names the nearest option."""
        namespace, rest = super().parse_known_args(*arguments, **named)
        if rest:
            options = [name for action in self.actions for name in action.option_strings]
            self.error(f"unrecognized arguments: {' '.join(rest)}{_near(rest[0].partition('=')[0], options)}")
        return namespace, rest

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        """Refuse a value that is no choice; names the nearest, or all."""
        choices = list(action.choices or ())
        if choices and value not in choices:
            near = _near(str(value), [str(choice) for choice in choices])
            every = "" if near else f" (choose from {', '.join(map(str, choices))})"
            raise argparse.ArgumentError(action, f"invalid choice: {value!r}{near}{every}")

    def error(self, message: str) -> NoReturn:
        """Print the line and exit with status 2."""
        if Parser.of_make:
            message = message.replace("the following arguments are required", "missing")
            message = re.sub(r"--([a-z][a-z0-9-]*)", lambda name: f"{name[1].upper().replace('-', '_')}=", message)
        _report(self.prog.split()[0], f"{message} (see {self.prog} --help)")
        sys.exit(2)


def add_command(parser: argparse.ArgumentParser, command: ModuleType) -> None:
    """Give ``parser`` the description, arguments and ``run`` of ``command``.

    An option --out that has a default is a folder, which `execute` checks.
    """
    parser.description = command.__doc__
    command.add_arguments(parser)
    folder = next((a.dest for a in parser._actions if a.dest == "out" and isinstance(a.default, Path)), None)
    parser.set_defaults(run=command.run, writes_in=folder)


def main(command: ModuleType, argv: Sequence[str] | None = None) -> int:
    """Exit status of ``command`` alone: for processes that our code starts, and for tests."""
    spec = command.__spec__
    parser = Parser(prog=spec.name.removeprefix("talbot.").removesuffix(".command") if spec else command.__name__)
    add_command(parser, command)
    return execute(parser, argv)


def execute(parser: Parser, argv: Sequence[str] | None = None) -> int:
    """Run the command that ``argv`` chooses: its status; one line on standard error for what it raises.

    2: bad input, a tool, memory, files. 3: any other exception (`failure`).
    """
    options = parser.parse_args(argv)
    run: Callable[[argparse.Namespace], int] = options.run
    out = getattr(options, options.writes_in) if options.writes_in else None

    def checked() -> int:
        if out is not None:
            check_folder(options.writes_in, out)
        return run(options)

    return guarded(parser.prog, checked, [out] if out else [])


def guarded(program: str, call: Callable[[], int], folders: Sequence[Path] = ()) -> int:
    """Return the exit status of ``call()``, or of what it raises, as `execute`. folders: where it writes."""
    try:
        if not os.environ.get(ONLY):
            status = call()
        else:
            with contextlib.suppress(Checked, ToolError, ModuleNotFoundError):  # of packages that are not there yet
                call()
            status = 0
        sys.stdout.flush()
        return status
    except KeyboardInterrupt:
        message = "interrupted; nothing was left half-written"
    except BrokenPipeError:  # the reader of our output went away
        _silence()
        return 1
    except ModuleNotFoundError:  # `failure.reported` says it; a test is skipped for it
        raise
    except Exception as error:
        if failure.is_full(error):
            message = failure.full(error, "output" if _silence() else None, *folders, BUILD)
        elif isinstance(error, ParameterError | ToolError):
            message = one_line(error)
        elif isinstance(error, MemoryError):
            message = f"memory = too little: {error or 'the request does not fit'}"
        elif isinstance(error, OSError):
            message = f"file = {error.filename or 'output'}: {error.strerror or error}"
        else:
            return failure.internal(program, error)
    _report(program, message)
    return 2


def _silence() -> bool:
    """Return whether standard output takes nothing more; Python's end does not try again then."""
    try:
        sys.stdout.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return True
    return False


def one_line(error: Exception) -> str:
    """Return the first line of an error's message and, of a tool's output after it, the first line with an error."""
    lines = [line.strip() for line in str(error).splitlines() if line.strip()] or [type(error).__name__]
    detail = next((line for line in lines[1:] if "error" in line.lower()), lines[-1])
    return lines[0] if len(lines) == 1 else f"{lines[0]} {detail}"


def failures(lines: Iterable[str]) -> int:
    """Print what a check found, a line each, on standard error; the exit status: 1 where there is a line, else 0."""
    problems = list(lines)
    for line in problems:
        print(line, file=sys.stderr, flush=True)
    return int(bool(problems))


def _near(word: str, known: Sequence[str]) -> str:
    """'; did you mean ...?', or nothing."""
    suggestion = nearest(word, known, LIKE)
    return suggestion if suggestion.startswith(";") else ""


def _report(program: str, message: str) -> None:
    """One line; of a long value in it, the beginning."""
    text = LONG.sub(lambda match: f"{match[match.lastindex or 0]}...", printable(" ".join(message.split())))
    print(f"{program}: error: {text}", file=sys.stderr)
