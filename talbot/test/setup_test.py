"""Set-up: what it says of the Python that it finds, that nothing of a user's own reaches it, and two at once."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from talbot.base.paths import ROOT

SCRIPT = ROOT / "requirements" / "venv.sh"
# A Python that makes environments without packages, and says what of the environment reached pip
FAKE = """#!/usr/bin/env bash
case "$*" in
    *fcntl* | *literal_eval*) exec "$REAL" "$@" ;;
    *ZLIB_RUNTIME_VERSION*) exec "$REAL" -c "import zlib; zlib.ZLIB_RUNTIME_VERSION = '${ZLIB:-1.3.1}'; $2" ;;
    "-m pip config list") echo "${CONF:-}" ;;
    "-m venv "*) mkdir -p "${*: -1}/bin" && cp "$0" "${*: -1}/bin/python" ;;
    "-m pip --version") exit 0 ;;
    "-m pip install "*uv.lock) env | grep -E '^(PIP_|PYTHON)' | sort >>"$LOG"
        [ -z "${UV:-}" ] || { echo "no uv" >&2; exit 1; }
        cp "$0" "${0%/*}/uv" ;;
    *"pip install "*) env | grep -E '^(UV_|SSL_CERT_FILE|HTTPS_PROXY)' | sort >>"$LOG.uv"
        echo "umask $(umask)" >>"$LOG"; echo "${0##*/} $*" >>"$LOG.pip"; sleep 0.3 ;;
    *version_info*) exit "${UNFIT:-0}" ;;
    *) echo "Python 3.12.1 at fake" ;;
esac
"""


@pytest.fixture
def checkout(tmp_path):
    """A checkout with the script alone, `python3` that installs nothing, and the environment for both."""
    folder = tmp_path / "Prüf stand"
    for part in ("requirements", "rtl", "talbot"):
        (folder / part).mkdir(parents=True)
    shutil.copy(SCRIPT, folder / "requirements")
    (folder / "talbot" / "rtl").symlink_to("../rtl")
    (folder / "pyproject.toml").touch()
    (folder / "a.lock").touch()
    for name in ("python3", "g++"):
        (tmp_path / name).write_text(FAKE, encoding="utf-8")
        (tmp_path / name).chmod(0o755)
    unset = {name: text for name, text in os.environ.items() if not name.startswith(("PIP_", "PYTHON"))}
    path = f"{tmp_path}:{os.environ['PATH']}"
    return folder, unset | {"PATH": path, "REAL": sys.executable, "LOG": str(tmp_path / "log")}


def start(checkout, *words, **environment):
    folder, given = checkout
    command = ["bash", "requirements/venv.sh", *(words or ("python3", ".venv", ".venv/.ready", "a.lock"))]
    return subprocess.Popen(
        command, cwd=folder, env=given | environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8"
    )


def test_settings_of_a_user_do_not_reach_pip_and_those_of_a_registry_do(checkout):
    settings = {"PIP_TARGET": "/t", "PIP_PREFIX": "/p", "PIP_USER": "1", "PIP_REQUIRE_VIRTUALENV": "1"}
    settings |= {"PYTHONPATH": "/x", "PYTHONHOME": "/h", "PYTHONUSERBASE": "/u"}
    registry = {"PIP_INDEX_URL": "https://mirror", "PIP_CERT": "/c.pem", "PIP_CONFIG_FILE": "/dev/null"}
    done = start(checkout, **settings, **registry)
    assert (done.communicate()[1], done.returncode) == ("", 0)
    log = Path(checkout[1]["LOG"]).read_text(encoding="utf-8").splitlines()
    expected = {f"{name}={text}" for name, text in (registry | {"PIP_USER": "0"}).items()}
    assert set(log) == expected | {"PIP_DISABLE_PIP_VERSION_CHECK=1", "umask 0022"}


PIP_CONF = r"""
:env:.cert='/own.pem'
global.cert='/all.pem'
global.extra-index-url='\nhttps://a\nhttps://b'
global.index-url='https://global'
global.target='/t'
install.index-url='https://install'
install.user='true'
"""


def test_of_a_pip_conf_only_the_registry_counts_and_the_environment_counts_more(checkout):
    own = {"PIP_CERT": "/own.pem", "PIP_CONFIG_FILE": "/p.conf", "CONF": PIP_CONF}
    done = start(checkout, **own)
    assert (done.communicate()[1], done.returncode) == ("", 0)
    log = Path(checkout[1]["LOG"]).read_text(encoding="utf-8").splitlines()
    assert {line for line in log if line.startswith("PIP_")} == {
        "PIP_CERT=/own.pem",
        "PIP_CONFIG_FILE=/dev/null",
        "PIP_DISABLE_PIP_VERSION_CHECK=1",
        "PIP_EXTRA_INDEX_URL=https://a https://b",
        "PIP_INDEX_URL=https://install",
        "PIP_USER=0",
    }


def test_uv_gets_the_registry_of_pip_and_no_other_setting(checkout):
    own = {"UV_TARGET": "/t", "UV_DEFAULT_INDEX": "https://own", "PIP_FIND_LINKS": "/a /b", "CONF": PIP_CONF}
    assert start(checkout, **own).communicate()[1] == ""
    assert Path(checkout[1]["LOG"] + ".uv").read_text(encoding="utf-8").splitlines() == [
        "SSL_CERT_FILE=/all.pem",
        "UV_DEFAULT_INDEX=https://install",
        "UV_FIND_LINKS=/a,/b",
        "UV_INDEX=https://a https://b",
        "UV_INDEX_STRATEGY=unsafe-best-match",
        "UV_NATIVE_TLS=1",
        "UV_NO_CONFIG=1",
    ]


@pytest.mark.parametrize("missing, program", [("", "uv pip"), ("1", "python -m pip")])
def test_pip_installs_where_uv_cannot(checkout, missing, program):
    assert start(checkout, UV=missing).communicate()[1] == ""
    (call,) = Path(checkout[1]["LOG"] + ".pip").read_text(encoding="utf-8").splitlines()
    assert call.startswith(f"{program} install --quiet ") and call.endswith(" --require-hashes -r a.lock")


def test_two_at_once_install_once(checkout):
    both = [start(checkout) for _ in range(2)]
    texts = [one.communicate() for one in both]
    assert [one.returncode for one in both] == [0, 0], texts
    assert sorted("waiting for another set-up" in out for out, _ in texts) == [False, True]
    assert Path(checkout[1]["LOG"]).read_text(encoding="utf-8").count("umask") == 1


def test_the_project_is_installed_with_the_packages_of_make_sim(checkout):
    (checkout[0] / "run.lock").touch()
    for lock in ("run.lock", "a.lock"):
        assert start(checkout, "python3", ".venv", f".venv/.{lock}", lock).communicate()[1] == ""
    calls = Path(checkout[1]["LOG"] + ".pip").read_text(encoding="utf-8").splitlines()
    assert ["--editable ." in call for call in calls] == [False, True, False]


def test_an_environment_without_pip_is_made_again(checkout):
    (broken := checkout[0] / ".venv" / "bin").mkdir(parents=True)
    (broken / "python").symlink_to("/bin/false")
    done = start(checkout)
    assert "making .venv" in done.communicate()[0] and (checkout[0] / ".venv" / ".ready").exists()


def test_a_checkout_without_links_is_refused_before_anything_is_made(checkout):
    link = checkout[0] / "talbot" / "rtl"
    link.unlink()
    link.write_text("../rtl", encoding="utf-8")  # as Git writes it with core.symlinks = false
    done = start(checkout)
    _, err = done.communicate()
    assert done.returncode == 2 and err.startswith("setup: talbot/rtl = not a link: ") and err.count("\n") == 1
    assert not (checkout[0] / ".venv").exists()


# The program that prints the C library's version, that of its kind, and apt-get
SYSTEM = {"getconf": "echo glibc {libc}", "uname": "echo {machine}", "apt-get": "exit 0"}


def system(checkout, libc="2.41", machine="Linux x86_64", **environment):
    """Put the programs of a system in front of this one's, and a tools.sh that unpacks a loader."""
    folder = Path(checkout[1]["PATH"].split(":")[0])
    for name, line in SYSTEM.items():
        (folder / name).write_text(f"#!/bin/sh\n{line.format(libc=libc, machine=machine)}\n", encoding="utf-8")
        (folder / name).chmod(0o755)
    (checkout[0] / "requirements" / "openroad.lock").touch()
    (checkout[0] / "requirements" / "tools.sh").write_text(
        'mkdir -p "$3" && echo "$1" "$2" >"$3/loader"\n', encoding="utf-8"
    )
    done = start(checkout, "python3", ".venv", ".venv/.ready", "a.lock", "requirements/openroad.lock", **environment)
    _, err = done.communicate()
    calls = Path(checkout[1]["LOG"] + ".pip").read_text(encoding="utf-8").splitlines()
    return done.returncode, err, [call for call in calls if "openroad.lock" in call]


def test_openroad_is_a_package_of_the_environment_from_glibc_2_38_on(checkout):
    status, err, calls = system(checkout, "2.38")
    assert (status, err, len(calls)) == (0, "", 1) and "-r a.lock -r requirements/openroad.lock" in calls[0]
    assert not (checkout[0] / ".venv" / "openroad").exists()


def test_openroad_has_an_older_zlib_where_the_systems_is_new(checkout):
    status, err, calls = system(checkout, ZLIB="1.10")
    assert (status, err, len(calls)) == (0, "", 1)
    assert (checkout[0] / ".venv" / "openroad" / "libc" / "loader").read_text(encoding="utf-8") == "--library zlib1g\n"


def test_openroad_is_unpacked_next_to_a_newer_glibc_on_an_older_system(checkout):
    status, err, calls = system(checkout, "2.9")
    assert (status, err, len(calls)) == (0, "", 1) and "--platform manylinux_2_38_x86_64" in calls[0]
    assert "--require-hashes" in calls[0] and "a.lock" not in calls[0]
    assert (checkout[0] / ".venv" / "openroad" / "libc" / "loader").read_text(encoding="utf-8") == "--library libc6\n"


@pytest.mark.parametrize("machine", ["Linux aarch64", "Darwin arm64"])
def test_openroad_is_left_out_in_one_line_where_it_has_no_package(machine, checkout):
    status, err, calls = system(checkout, machine=machine)
    assert (status, calls) == (0, []) and err == f"setup: openroad = no package for {machine}: left out\n"


@pytest.mark.parametrize("python, found", [("/bin/false", "nothing"), ("/nowhere/python", "nothing")])
def test_a_python_that_does_not_fit_is_refused_in_one_line(tmp_path, python, found):
    words = ["bash", SCRIPT, python, tmp_path / "venv", tmp_path / "ready", "x.lock"]
    done = subprocess.run(words, capture_output=True, encoding="utf-8")
    assert done.returncode == 2 and done.stderr.count("\n") == 1
    assert f"python = '{python}': must be Python 3.11 to 3.14, is {found} (make PYTHON=" in done.stderr
    assert not (tmp_path / "venv").exists()


@pytest.mark.slow
def test_another_python_of_the_system_is_found_and_named(tmp_path):
    """The first `python3` does not fit; one with a version in its name does."""
    (tmp_path / "python3").symlink_to("/bin/false")
    (tmp_path / f"python3.{sys.version_info.minor}").symlink_to(sys.executable)
    (tmp_path / "empty.lock").touch()
    done = subprocess.run(
        ["bash", SCRIPT, "python3", tmp_path / "venv", tmp_path / "ready", tmp_path / "empty.lock"],
        cwd=tmp_path,
        env=dict(os.environ, PATH=f"{tmp_path}:{os.environ['PATH']}"),
        capture_output=True,
        text=True,
    )
    version = ".".join(map(str, sys.version_info[:3]))
    assert f"setup: making {tmp_path / 'venv'} with Python {version} at " in done.stdout
