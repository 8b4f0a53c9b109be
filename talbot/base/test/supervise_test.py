"""A supervised program that a signal ends: no process and no file of it is left, and files that appear together do."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from talbot.base.files import PART
from talbot.base.paths import ROOT

PROGRAM = """
import os, signal, subprocess, sys, time
from pathlib import Path
from talbot.base.supervise import supervised
out = Path(sys.argv[1])
def tools():
    for _ in range(200):
        subprocess.Popen(["sleep", "20"], start_new_session=True)
        print("begun", flush=True)
    time.sleep(20)
def orphans():
    subprocess.run(["sh", "-c", "setsid sh -c 'sleep 20 & sleep 20' & sleep 20 &"])
    print("begun", flush=True)
    time.sleep(20)
def writes():
    from talbot.base.files import atomic, staged  # NumPy, which the others need not load
    with staged(out / "new" / "out") as part, atomic(out / "other" / "file"):
        (part / "half").write_text("")
        print("begun", flush=True)
        time.sleep(20)
def publishes():
    from talbot.base.files import staged
    with staged(out / "out") as part:
        for i in range(8000):
            (part / str(i)).touch()
        print("begun", flush=True)
    time.sleep(20)
def crashes():
    from talbot.base.files import atomic
    with atomic(out / "file"):
        os.kill(os.getpid(), signal.SIGSEGV)
def works():
    worker = subprocess.Popen(["sleep", "20"])
    print(os.getpid(), flush=True)
    worker.wait()
    raise RuntimeError("a worker ended")
def leaves():
    subprocess.Popen(["sleep", "20"], start_new_session=True)
    return 7
sys.platform = os.environ.get("TEST_PLATFORM", sys.platform)
sys.exit(supervised(globals()[sys.argv[2]]))
"""
# What macOS's ps says, which Debian does not always have
PS = """#!/usr/bin/env python3
from pathlib import Path
for path in Path("/proc").glob("[0-9]*/stat"):
    try:
        print(path.parent.name, path.read_text().rpartition(")")[2].split()[1])
    except OSError:
        pass
"""


def heard():
    """Whether or not a shell in the background or nohup started the tests, in which these are ignored."""
    for name in (signal.SIGINT, signal.SIGHUP):
        signal.signal(name, signal.SIG_DFL)


def started(folder, words, prepare=heard):
    """A Python with ``words`` in a separate session, known by TEST_MARK=``folder``, in which Ctrl-C counts."""
    environment = {key: value for key, value in os.environ.items() if key != "TALBOT_RUN"}
    return subprocess.Popen(
        [sys.executable, *words],
        cwd=ROOT,
        env=environment | {"TEST_MARK": str(folder), "TMPDIR": str(folder)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        preexec_fn=prepare,
    )


def program(out, name, **more):
    """The program on its way, and the text by which its processes are known."""
    return started(out, ["-c", PROGRAM, str(out), name], **more), f"TEST_MARK={out}"


def running(mark):
    """Processes whose environment has ``mark``."""
    found = []
    for path in Path("/proc").glob("[0-9]*/environ"):
        try:
            if mark.encode() in path.read_bytes().split(b"\0"):
                found.append(path.parent.name)
        except OSError:
            pass
    return found


@pytest.mark.parametrize("sent", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
@pytest.mark.parametrize("whole_group", [False, True])
@pytest.mark.parametrize("name", ["tools", "orphans", "writes"])
def test_nothing_is_left(tmp_path, name, sent, whole_group):
    process, mark = program(tmp_path, name)
    process.stdout.readline()
    assert len(running(mark)) > 1
    (os.killpg if whole_group else os.kill)(process.pid, sent)
    _, err = process.communicate(timeout=200)
    assert process.returncode == 128 + sent and err.count("\n") == 1 and "nothing was left half-written" in err
    assert not running(mark) and not list(tmp_path.iterdir())


@pytest.mark.parametrize("name", ["tools", "writes"])
def test_nothing_is_left_where_there_is_no_proc(tmp_path, tmp_path_factory, monkeypatch, name):
    """The way of macOS: ps says which processes there are, and those that nobody waits for are not looked for."""
    programs = tmp_path_factory.mktemp("bin")
    (programs / "ps").write_text(PS, encoding="utf-8")
    (programs / "ps").chmod(0o755)
    monkeypatch.setenv("PATH", f"{programs}:{os.environ['PATH']}")
    monkeypatch.setenv("TEST_PLATFORM", "darwin")
    process, mark = program(tmp_path, name)
    process.stdout.readline()
    process.terminate()
    process.wait(timeout=200)
    assert not running(mark) and not list(tmp_path.iterdir())
    _, err = process.communicate(timeout=200)  # which would wait for tools that are left
    assert process.returncode == 143 and err.count("\n") == 1 and "nothing was left half-written" in err


def test_files_that_appear_together_do(tmp_path):
    process, mark = program(tmp_path, "publishes")
    process.stdout.readline()
    while not (tmp_path / "out" / "0").exists():
        pass
    seen = len(os.listdir(tmp_path / "out"))
    process.terminate()
    process.communicate(timeout=200)
    assert process.returncode == 143 and seen < 8000
    names = os.listdir(tmp_path / "out")
    assert len(names) == 8000 and not any(name.startswith(PART) for name in names) and not running(mark)


def test_a_program_that_crashes_is_cleared_away_too(tmp_path):
    process, mark = program(tmp_path, "crashes")
    _, err = process.communicate(timeout=200)
    assert process.returncode == 139 and "SIGSEGV" in err
    assert not running(mark) and not list(tmp_path.iterdir())


def test_a_tool_that_a_program_forgets_ends_with_it(tmp_path):
    process, mark = program(tmp_path, "leaves")
    process.communicate(timeout=200)
    assert process.returncode == 7 and not running(mark)


@pytest.mark.parametrize("attempt", range(5))
@pytest.mark.parametrize("sent", [signal.SIGTERM, signal.SIGHUP])
def test_a_worker_that_the_signal_ends_first_is_no_error(tmp_path, sent, attempt):
    process, mark = program(tmp_path, "works")
    process.stdout.readline()
    os.killpg(process.pid, sent)
    _, err = process.communicate(timeout=200)
    assert process.returncode == 128 + sent and err.count("\n") == 1 and "nothing was left" in err
    assert not running(mark)


def test_a_signal_to_the_child_alone_ends_both(tmp_path):
    process, mark = program(tmp_path, "works")
    os.kill(int(process.stdout.readline()), signal.SIGTERM)
    _, err = process.communicate(timeout=200)
    assert process.returncode == 143 and "nothing was left" in err and not running(mark)


def test_an_ignored_signal_stays_ignored(tmp_path):
    """As nohup does it."""
    process, mark = program(tmp_path, "leaves", prepare=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
    for _ in range(20):
        process.send_signal(signal.SIGHUP)
        time.sleep(0.01)
    process.communicate(timeout=200)
    assert process.returncode == 7 and not running(mark)
