"""The program `talbot`: a command in a child process, which a signal ends at any moment."""

import signal

# From the first line on: a signal waits until there is someone to take it
signal.pthread_sigmask(signal.SIG_BLOCK, (signal.SIGINT, signal.SIGTERM, signal.SIGHUP))

import sys  # noqa: E402

from talbot.base import environment, failure  # noqa: E402
from talbot.base.supervise import supervised  # noqa: E402


def main() -> int:
    """Run the command of this process's arguments; returns the exit status."""
    environment.open_standard_files()
    environment.start_again()
    try:
        return supervised(lambda: failure.reported("talbot", _command))
    except OSError as error:  # no folder takes a temporary file, no further process
        why = error.strerror or error
        print(f"talbot: error: file = {error.filename or 'temporary'}: {why}; free some space", file=sys.stderr)
        return 2


def _command() -> int:
    from talbot.base import paths

    paths.caches()  # Numba and Matplotlib read it when they are imported
    from talbot import commands  # after the fork: it imports all of NumPy

    return commands.main(sys.argv[1:])


if __name__ == "__main__":
    sys.exit(main())
