"""`python -m talbot COMMAND`: the one program that the make targets call.

Exit status: 0 right, 1 the chip and its golden model differ or a bound is missed, 2 bad input or
environment (one line on standard error says which field, value and range), 130 interrupted.
"""

import argparse
import sys

from models.parameters import ParameterError

from . import commands


def parser():
    top = argparse.ArgumentParser(prog="talbot", description="The open design flow for angle-sensitive-pixel sensors.")
    subs = top.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for add in (commands.add_sim, commands.add_decode, commands.add_tradeoff, commands.add_stability):
        add(subs)
    return top


def main(argv=None):
    arguments = parser().parse_args(argv)
    try:
        return arguments.run(arguments)
    except KeyboardInterrupt:
        print("\ntalbot: interrupted; nothing was left half-written", file=sys.stderr)
        return 130
    except (ParameterError, commands.ToolError) as error:
        message = str(error)
    except OSError as error:
        message = f"file = {error.filename or 'output'}: {error.strerror or error}"
    print(f"talbot: error: {message}", file=sys.stderr)
    return 2


if __name__ == "__main__":
    sys.exit(main())
