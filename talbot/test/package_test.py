"""One package, `talbot`: in a checkout its parts are links to the folders next to it, in a wheel they are folders."""

import os
import shutil
import subprocess
import sys
import zipfile
from collections import Counter
from importlib.metadata import version
from pathlib import Path

import pytest

from talbot.base.paths import PACKAGE, ROOT
from talbot.models.parameters import SensorParameters
from talbot.rtl.export import translate

PARTS = {path.name for path in PACKAGE.iterdir() if path.is_symlink()}
TEST = "cells/liberty/test/check_test.py"
PYTEST = "import pytest, sys; status = pytest.main(sys.argv[1:]); print(*sys.modules); sys.exit(status)"
BUILD = "from setuptools import build_meta; build_meta.build_wheel('wheel')"
INSTALLED = """
import talbot
from talbot.base import paths, sources
run = talbot.Sensor(rows=12, cols=18).golden("coins")
assert talbot.decode(run.stream)[0].complete
print(talbot.__file__, paths.BUILD, paths.RESULTS, *{name.split(".")[0] for name in sources.modules()})
"""


def run(*words, cwd=ROOT, **environment):
    """What Python prints for ``words``."""
    command = [sys.executable, *map(str, words)]
    done = subprocess.run(command, cwd=cwd, env=os.environ | environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_every_part_is_a_link():
    assert sorted(PARTS) == ["cells", "flow", "imaging", "memory", "models", "pixels", "rtl", "signoff", "verif"]
    assert all((PACKAGE / part).readlink() == Path("..", part) for part in PARTS)


@pytest.mark.parametrize(
    "folder, given", [("", TEST), ("", ROOT / TEST), ("", f"talbot/{TEST}"), ("cells/liberty/test", "check_test.py")]
)
@pytest.mark.parametrize("node", ["", "::test_what_is_whole_has_no_problem"])
def test_a_file_has_one_name_however_pytest_is_asked_for_it(request, folder, given, node):
    (conftest,) = (p for p in request.config.pluginmanager.get_plugins() if hasattr(p, "in_package"))
    found = conftest.in_package(f"{given}{node}", ROOT / folder)
    assert os.path.join(ROOT / folder, found) == f"{PACKAGE / TEST}{node}"


def test_a_file_is_one_module():
    words = run(
        "-c", PYTEST, "-p", "no:cacheprovider", "check_test.py", cwd=ROOT / "cells/liberty/test", PYTHONPATH=str(ROOT)
    )
    assert "talbot." + TEST.removesuffix(".py").replace("/", ".") in words.split()
    assert not [name for name in words.split() if name.split(".")[0] in PARTS]


def test_a_test_by_its_name():
    shown = run(
        "-m", "pytest", "-vv", "-p", "no:cacheprovider", "-n", "1", f"{TEST}::test_what_is_whole_has_no_problem"
    )
    assert f"talbot/{TEST}::test_what_is_whole_has_no_problem" in shown and "1 passed" in shown


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """(the sources, a wheel of them)."""
    source = tmp_path_factory.mktemp("source") / "talbot"
    shutil.copytree(ROOT, source, True, shutil.ignore_patterns("build", ".*", "__pycache__", "*.egg-info"))
    (source / "build" / "lib" / "models").mkdir(parents=True)  # as an older layout left it
    (source / "build" / "lib" / "models" / "left.py").touch()
    (source / "wheel").mkdir()
    run("-c", BUILD, cwd=source)
    return source, next((source / "wheel").glob("*.whl"))


@pytest.mark.slow
def test_a_wheel_has_the_package_and_nothing_else(built):
    source, wheel = built
    names = Counter(zipfile.ZipFile(wheel).namelist())
    assert {name.split("/")[0] for name in names} == {
        "talbot",
        wheel.name.removesuffix("-py3-none-any.whl") + ".dist-info",
    }
    files = [path for part in PARTS for path in (source / part).rglob("*") if path.is_file()]
    files += [path for path in (source / "talbot").rglob("*") if path.is_file()]
    paths = {f"talbot/{path.relative_to(source)}".replace("talbot/talbot/", "talbot/") for path in files}
    assert {name for name in names if name.startswith("talbot/")} == paths and set(names.values()) == {1}


@pytest.mark.slow
def test_an_installation_works_from_any_folder(built, tmp_path):
    zipfile.ZipFile(built[1]).extractall(tmp_path / "site")
    (tmp_path / "away").mkdir()
    there = {"cwd": tmp_path / "away", "PYTHONPATH": str(tmp_path / "site"), "XDG_CACHE_HOME": str(tmp_path / "cache")}
    found = run("-c", INSTALLED, **there).split()
    assert found == [
        f"{tmp_path}/site/talbot/__init__.py",
        f"{tmp_path}/cache/talbot",
        f"{tmp_path}/away/build",
        "talbot",
    ]
    assert run("-m", "talbot", "--version", **there) == f"talbot {version('talbot')}\n"
    run("-m", "talbot", "verilog", "--top", "EdgeAdc", "--out", "verilog", **there)
    (verilog,) = (tmp_path / "away" / "verilog").iterdir()
    assert verilog.read_text() == translate("EdgeAdc", SensorParameters())
