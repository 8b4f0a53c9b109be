"""A user's own settings of Python, Matplotlib and the tools, which change nothing of what our programs do."""

import json
import lzma
import os
import subprocess
import sys

import pytest

from talbot.base import environment
from talbot.base.liberty.verilog import write_models
from talbot.base.paths import PACKAGE, ROOT
from talbot.base.tools import plain, run

TABLES = PACKAGE / "flow" / "layout" / "tables"

KEPT = {
    "PATH": "/bin",
    "LD_LIBRARY_PATH": "/opt/lib",
    "PDK_ROOT": "/pdk",
    "XDG_CACHE_HOME": "/nowhere",  # no unpacked tools
    "PYTHON": "python3",
    "https_proxy": "http://p",
}
KEPT |= {"OMP_NUM_THREADS": "2", "SCHEDULER": "tcp://h:1", "NUMBA_CACHE_DIR": "/scratch", "TALBOT_RUN": "/tmp/x"}
# fmt: off
OWN = (
    "PYTHONPATH", "PYTHONHOME", "PYTHONSTARTUP", "PYTHONOPTIMIZE", "PYTHONWARNINGS", "PYTHONHASHSEED",
    "MPLBACKEND", "LANG", "MATPLOTLIBRC", "PYTEST_ADDOPTS", "PYTEST_DISABLE_PLUGIN_AUTOLOAD",
    "NUMBA_DISABLE_JIT", "BASH_ENV", "CDPATH", "GREP_OPTIONS", "MAKEFILES", "MAKEFLAGS", "CFLAGS", "CXXFLAGS",
    "LDFLAGS", "OBJCACHE", "VERILATOR_ROOT", "SPICE_LIB_DIR", "NGSPICE_MEAS_PRECISION", "KLAYOUT_HOME",
    "CAD_ROOT", "TCLLIBPATH", "LC_NUMERIC", "LANGUAGE",
)
# fmt: on
PRINT = "import json, os, sys; print(json.dumps([*map(int, sys.flags[:16]), sys.path, dict(os.environ)]))"


def test_what_a_user_set_is_gone_and_what_a_machine_needs_stays():
    found = environment.clean(KEPT | dict.fromkeys(OWN, "x"))
    assert found == KEPT | environment.FIXED


def test_tools_run_in_it(monkeypatch, tmp_path):
    monkeypatch.setenv("HOME", str(tmp_path))
    for name in OWN:
        monkeypatch.setenv(name, str(tmp_path))
    *_, found = json.loads(run([sys.executable, "-c", PRINT], {"PYTHONPATH": "/mine"}))
    assert found["HOME"] == environment.NO_HOME and found["PYTHONPATH"] == "/mine"
    assert (
        not {*OWN} - {"PYTHONHASHSEED", "PYTHONPATH", "MATPLOTLIBRC"} & found.keys() and found["PYTHONHASHSEED"] == "0"
    )


@pytest.mark.needs("ngspice", "sta")
def test_a_file_of_settings_in_the_home_or_working_folder_is_not_read(monkeypatch, tmp_path):
    """ngspice with `set interp` writes other points, and OpenSTA's .sta may end it."""
    monkeypatch.setenv("HOME", str(tmp_path))
    (tmp_path / ".spiceinit").write_text("echo mine\nquit\n")
    (tmp_path / ".sta").write_text('puts "mine"; exit 3\n')
    (tmp_path / "deck.sp").write_text("* a resistor\nv1 a 0 1\nr1 a 0 1k\n.op\n.print op v(a)\n.end\n")
    (tmp_path / "end.tcl").write_text("puts yes\n")
    assert "mine" not in run(["ngspice", "-n", "-b", "deck.sp"], cwd=tmp_path)
    assert run(["sta", "-no_splash", "-no_init", "-exit", "end.tcl"], cwd=tmp_path) == "yes\n"


def talbot(*words, python=(), **variables):
    """The program in a process with these variables on top."""
    command = [sys.executable, *python, "-m", "talbot", *words]
    return subprocess.run(command, cwd=ROOT, env=os.environ | variables, capture_output=True, encoding="utf-8")


@pytest.fixture
def hostile(tmp_path):
    """A folder with a NumPy of another Python, and variables that name it."""
    (tmp_path / "numpy.py").write_text('raise ImportError("for another Python")\n')
    names = {
        "PYTHONWARNINGS": "error",
        "PYTHONOPTIMIZE": "2",
        "MPLBACKEND": "module://matplotlib_inline.backend_inline",
    }
    return names | {"PYTHONPATH": str(tmp_path), "PYTHONUTF8": "0", "LC_ALL": "C"}


def test_the_program_starts_again_without_them(hostile):
    done = talbot("sensor", **hostile)
    assert done.returncode == 0 and not done.stderr and "[array]" in done.stdout
    assert talbot("sim", "--rows", "x", **hostile).stderr.startswith("talbot: error: rows = 'x'")


@pytest.mark.parametrize("python", [["-I"], ["-E"]])
def test_where_python_reads_no_variables_it_does_not_start_again_for_ever(hostile, python):
    assert talbot("--version", python=python, **hostile).stdout.startswith("talbot ")


@pytest.mark.parametrize("closed", ["<&-", ">&-", "2>&-", "<&- >&- 2>&-"])
def test_a_closed_standard_file_is_no_error(tmp_path, closed):
    words = [sys.executable, "-m", "talbot", "sensor", "--out", str(tmp_path / "sensor.toml")]
    done = subprocess.run(["sh", "-c", f'"$@" {closed}', "sh", *words], capture_output=True, text=True)
    assert done.returncode == 0 and not done.stderr and (tmp_path / "sensor.toml").read_text().startswith("#")


def test_the_folder_of_the_program_itself_stays_on_the_path(tmp_path):
    """A checkout that is reached by PYTHONPATH alone."""
    program = "from talbot.base.environment import start_again; start_again();" + PRINT
    for paths in (str(ROOT), f"{tmp_path}{os.pathsep}{ROOT}/"):
        command = [sys.executable, "-c", program]
        done = subprocess.run(command, env=os.environ | {"PYTHONPATH": paths}, cwd=tmp_path, capture_output=True)
        *_, path, found = json.loads(done.stdout)
        assert found["PYTHONPATH"] == str(ROOT) and str(tmp_path) not in path


def test_tools_that_make_tools_unpacks_come_after_the_systems(tmp_path):
    folder = tmp_path / "talbot" / "tools"
    user = {"XDG_CACHE_HOME": str(tmp_path), "PATH": f"/usr/bin{os.pathsep}/bin", "CPATH": ""}
    assert environment.with_unpacked(user) == {}
    (folder / "bin").mkdir(parents=True)
    found = environment.with_unpacked(user)
    assert found["PATH"] == os.pathsep.join(("/usr/bin", "/bin", str(folder / "bin")))
    assert found["CPATH"] == str(folder / "include") and found["LIBRARY_PATH"] == str(folder / "lib")
    assert environment.clean(user | found)["PATH"] == found["PATH"]  # once


@pytest.mark.parametrize("name", ["a b", "ü", "$x", "a'b", 'a"b', "a;b#c", "{a", "[a]"])
@pytest.mark.needs("yosys", "sta")
def test_a_path_that_scripts_split_reaches_yosys_abc_and_opensta(tmp_path, name):
    folder = tmp_path / name
    folder.mkdir()
    liberty = folder / f"{name}.lib"
    liberty.write_text(lzma.decompress((TABLES / "sky130.tt_025C_1v80.lib.xz").read_bytes()).decode(), encoding="utf-8")
    write_models(liberty, folder / "cells.v")
    assert "module inv_x1" in (folder / "cells.v").read_text(encoding="utf-8")
    (folder / "t.v").write_text("module t(input a, b, output c); assign c = a ^ b; endmodule\n", encoding="utf-8")
    script = "read_verilog {0}; synth -top t; abc -liberty {1}; write_verilog -noattr {2}"
    paths = plain(folder / "t.v"), plain(liberty), plain(folder) / "mapped.v"
    run(["yosys", "-q", "-p", script.format(*paths)])
    tcl = f"read_liberty {plain(liberty)}\nread_verilog {paths[2]}\nlink_design t\n"
    (folder / "s.tcl").write_text(tcl, encoding="utf-8")
    assert "Error" not in run(["sta", "-no_splash", "-no_init", "-exit", folder / "s.tcl"])


def test_a_plain_path_stays(tmp_path):
    assert plain(tmp_path / "a.lib") == tmp_path / "a.lib"
    (tmp_path / "a b").mkdir()
    link = plain(tmp_path / "a b")
    (link / "file").touch()
    assert [path.name for path in (tmp_path / "a b").iterdir()] == ["file"] and " " not in str(link)
