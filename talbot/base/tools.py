"""Tools as child processes: none outlives an interrupted parent, and errors name the tool that is missing or failed."""

import atexit
import contextlib
import os
import re
import secrets
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextvars import ContextVar, copy_context
from functools import cache, partial
from importlib.util import find_spec
from pathlib import Path
from threading import Lock
from typing import IO, TypeVar

from talbot.base.check import work_begins
from talbot.base.environment import of_tools
from talbot.base.paths import ROOT

T = TypeVar("T")
YOSYS = "yosys", "yosys-abc", "yosys-smtbmc"
PLAIN = re.compile(r"[A-Za-z0-9_./+,@%=:-]*")


class ToolError(RuntimeError):
    """A tool is missing or failed; the message says which and what to do."""


class ToolTimeout(ToolError):
    """A tool was stopped at its time limit."""


class _Tools:
    """Tools that run for one call, as long as nobody ends them."""

    def __init__(self) -> None:
        self._ends, self._lock, self._ended = set[Callable[[], None]](), Lock(), False

    @contextlib.contextmanager
    def running(self, end: Callable[[], None]) -> Iterator[None]:
        """Count what ``end`` ends, a tool or the tools of another call, as one of these."""
        with self._lock:
            self._ends.add(end)
            if self._ended:
                end()
        try:
            yield
        finally:
            with self._lock:
                self._ends.remove(end)

    def end(self) -> None:
        """End those that run, and at once each that starts from now on."""
        with self._lock:
            self._ended = True
            for end in self._ends:
                end()


_tools: ContextVar[_Tools | None] = ContextVar("tools", default=None)


@contextlib.contextmanager
def meanwhile(call: Callable[..., T], *arguments: object) -> Iterator["Future[T]"]:
    """Run ``call(*arguments)`` in another thread, whose tools end where the context ends by an exception."""
    outer, tools, context = _tools.get(), _Tools(), copy_context()
    context.run(_tools.set, tools)
    with ThreadPoolExecutor(1) as pool, outer.running(tools.end) if outer else contextlib.nullcontext():
        result = pool.submit(context.run, call, *arguments)
        try:
            yield result
        except BaseException:
            tools.end()
            raise


def located(name: str) -> str | None:
    """Return the path of a tool: on PATH, or a YoWASP package's next to this Python; None where neither is.

    Yosys, its ABC and its model checker are those of packages (pyosys by `base.yosys`, YoWASP's) whatever is on PATH:
    one version on every machine, since cells, names and reports differ from one to the next.
    """
    folder, program = Path(sys.executable).parent, shutil.which(name)
    wheel = folder / f"yowasp-{name}"
    if name in ("yosys", "yosys-abc"):
        package = find_spec("pyosys")
        if not package or not package.origin:
            return program
        wheel = folder / "talbot-yosys" if name == "yosys" else Path(package.origin).with_name(name)
    found = str(wheel) if wheel.exists() else None
    return (found or program) if name in YOSYS else (program or found)


def plain(path: Path) -> Path:
    """Return ``path`` as scripts of tools can say it: where it has a space, a quote, a `$`, by way of a link.

    Yosys, ABC and Tcl split such a path, each by other rules. The link, to the file or folder, lasts as long as this
    process; a folder that is not there yet is made. Letters that are not ASCII count, too.
    """
    path = Path(path)
    if PLAIN.fullmatch(str(path)):
        return path
    existing = next(p for p in (path, *path.absolute().parents) if p.exists())
    rest = path.absolute().relative_to(existing.absolute())
    if not PLAIN.fullmatch(str(rest)):
        path.mkdir(parents=True, exist_ok=True)
        existing, rest = path, Path()
    link = _links() / secrets.token_hex(4)
    link.symlink_to(existing.absolute())
    return link / rest


@cache
def _links() -> Path:
    """Return the folder of this process's links, which goes with it."""
    folder = tempfile.gettempdir() if PLAIN.fullmatch(tempfile.gettempdir()) else "/tmp"
    links = Path(tempfile.mkdtemp(prefix="talbot-links-", dir=folder))
    atexit.register(shutil.rmtree, links, ignore_errors=True)
    return links


def finish(
    command: Sequence[object],
    env: Mapping[str, str] | None = None,
    cwd: Path | str | None = None,
    seconds: float | None = None,
    log: Path | None = None,
) -> subprocess.CompletedProcess[str]:
    """Run ``command`` to its end and return its status and text output. Its program is looked for as `located` does.

    env: variables on top of the clean environment of tools (`environment.of_tools`). The command has a process group
    of its own, which any exception (Ctrl-C too) ends as a whole, with what the command started. seconds: time limit.
    log: file that gets both outputs as they come, then returned as stdout. Raises ToolError when there is no such
    program, ToolTimeout.
    """
    work_begins()
    words = [str(part) for part in command]
    words[0] = located(words[0]) or words[0]
    output = log.open("wb") if log else None
    try:
        child = subprocess.Popen(
            words,
            stdin=subprocess.DEVNULL,
            stdout=output or subprocess.PIPE,
            stderr=subprocess.STDOUT if output else subprocess.PIPE,
            text=True,
            encoding="utf-8",
            errors="replace",
            env=of_tools(env),
            cwd=cwd,
            start_new_session=True,
        )
    except FileNotFoundError as error:
        raise _missing(words[0]) from error
    finally:
        if output:
            output.close()
    tools = _tools.get()
    with child, tools.running(partial(_kill_group, child.pid)) if tools else contextlib.nullcontext():
        try:
            out, err = child.communicate(timeout=seconds)
        except subprocess.TimeoutExpired:
            _kill_group(child.pid)
            raise ToolTimeout(f"{Path(words[0]).name}: no end after {seconds} s") from None
        except BaseException:
            _kill_group(child.pid)
            raise
    if log:
        out, err = log.read_text(encoding="utf-8", errors="replace"), ""
    return subprocess.CompletedProcess(words, child.returncode, out, err)


def _missing(program: str) -> ToolError:
    """Return the error of a program that is not there."""
    name = Path(program).name
    return ToolError(f"{name}: not found; install it with: make tools (Debian: apt-get install {name})")


def _kill_group(leader: int) -> None:
    with contextlib.suppress(ProcessLookupError):  # it has ended by itself
        os.killpg(leader, signal.SIGKILL)


@contextlib.contextmanager
def started(
    command: Sequence[object],
    log: IO[bytes],
    files: Sequence[int] = (),
    env: Mapping[str, str] | None = None,
    cwd: Path | str | None = None,
) -> Iterator["subprocess.Popen[bytes]"]:
    """Start ``command`` as a separate process group, which ends with the context at the latest.

    log: gets both outputs. files: open ones that it keeps. env: see `finish`. Raises ToolError when there is no such
    program.
    """
    work_begins()
    words = [str(part) for part in command]
    try:
        child = subprocess.Popen(
            words,
            stdin=subprocess.DEVNULL,
            stdout=log,
            stderr=log,
            pass_fds=files,
            env=of_tools(env),
            cwd=cwd,
            start_new_session=True,
        )
    except FileNotFoundError as error:
        raise _missing(words[0]) from error
    try:
        yield child
    finally:
        if child.poll() is None:
            _kill_group(child.pid)
        child.wait()


def run(
    command: Sequence[object],
    env: Mapping[str, str] | None = None,
    cwd: Path | str | None = None,
    seconds: float | None = None,
) -> str:
    """Run ``command`` as `finish` does and return its output. Raises ToolError with its last lines when it fails."""
    result = finish(command, env, cwd, seconds)
    if result.returncode:
        tail = "\n".join((result.stderr or result.stdout).strip().splitlines()[-15:])
        raise ToolError(f"{Path(str(command[0])).name} failed with status {result.returncode}:\n{tail}")
    return result.stdout


def commit() -> str:
    """Return the short hash of the checkout, with + where files differ; '' outside a checkout or without git."""
    if not (ROOT / ".git").exists() or not located("git"):
        return ""
    return finish(["git", "describe", "--always", "--dirty=+"], cwd=ROOT).stdout.strip()
