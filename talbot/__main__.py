"""`python -m talbot COMMAND`: the one program that the make targets call.

Exit status: 0 right, 1 the chip and its golden model differ, a bound is missed or a stream is damaged, 2 bad input
or environment (one line on standard error says which field, value and range) or Ctrl-C, 143 terminated.
"""

import argparse
import os
import signal
import sys

from base.tools import ToolError
from models.parameters import ParameterError

from . import commands


class Parser(argparse.ArgumentParser):
    """Refuses with one line, as everything else here does."""

    def __init__(self, **options):
        super().__init__(allow_abbrev=False, **options)

    def error(self, message):
        _refuse(f"{message} (see {self.prog} --help)")
        sys.exit(2)


def parser():
    top = Parser(prog="talbot", description="The open design flow for angle-sensitive-pixel sensors.")
    subs = top.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for add in (commands.add_sim, commands.add_decode, commands.add_tradeoff, commands.add_stability):
        add(subs)
    return top


def main(argv=None):
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # unwinds, so that nothing half-written stays
    arguments = parser().parse_args(argv)
    try:
        return arguments.run(arguments)
    except KeyboardInterrupt:
        _refuse("interrupted; nothing was left half-written")
    except BrokenPipeError:  # the reader of our output went away
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1
    except (ParameterError, ToolError) as error:
        _refuse(error)
    except MemoryError as error:
        _refuse(f"memory = too little: {error or 'the request does not fit'}")
    except OSError as error:
        _refuse(f"file = {error.filename or 'output'}: {error.strerror or error}")
    return 2


def _refuse(message):
    print(f"talbot: error: {message}", file=sys.stderr)


if __name__ == "__main__":
    sys.exit(main())
