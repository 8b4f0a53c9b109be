"""Tools as child processes: none outlives an interrupted parent, a missing or failed one is named."""

import os
import signal
import subprocess
from pathlib import Path


class ToolError(RuntimeError):
    """A tool is missing or failed; the message says which and what to do."""


class ToolTimeout(ToolError):
    """A tool was stopped at its time limit."""


def finish(command, env=None, cwd=None, seconds=None):
    """Run ``command`` to its end; returns subprocess.CompletedProcess with its text output.

    env: variables on top of this process's. It gets a process group of its own, which any exception here (Ctrl-C
    too) ends as a whole: a compiler driver's compiler as well. seconds: after which it is stopped. Raises ToolError
    when there is no such program, ToolTimeout.
    """
    command = [str(part) for part in command]
    try:
        child = subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            errors="replace",
            env=dict(os.environ, **(env or {})),
            cwd=cwd,
            start_new_session=True,
        )
    except FileNotFoundError as error:
        raise ToolError(
            f"{Path(command[0]).name}: not found; install it with: make tools "
            f"(Debian: apt-get install {Path(command[0]).name})"
        ) from error
    with child:
        try:
            out, err = child.communicate(timeout=seconds)
        except subprocess.TimeoutExpired:
            os.killpg(child.pid, signal.SIGKILL)
            raise ToolTimeout(f"{Path(command[0]).name}: no end after {seconds} s") from None
        except BaseException:
            os.killpg(child.pid, signal.SIGKILL)
            raise
    return subprocess.CompletedProcess(command, child.returncode, out, err)


def run(command, env=None, cwd=None, seconds=None):
    """As `finish`; returns what the tool printed. Raises ToolError with its last lines when it fails."""
    result = finish(command, env, cwd, seconds)
    if result.returncode:
        tail = "\n".join((result.stderr or result.stdout).strip().splitlines()[-15:])
        raise ToolError(f"{Path(command[0]).name} failed with status {result.returncode}:\n{tail}")
    return result.stdout
