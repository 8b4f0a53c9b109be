"""A sensor file through every command: taken, or refused in one line before anything is done."""

import pytest

from talbot.base.check import ONLY
from talbot.base.command import Parser
from talbot.base.sensor import Varied
from talbot.commands import command, main
from talbot.front import COMMANDS
from talbot.models.parameters import STANDARD
from talbot.models.parameters.sensor_file import keys, values

# Commands that make nothing of a sensor: scenes, cells, blocks of fixed sizes, tests of them
WITHOUT = {
    *("sensor", "index", "site"),
    *("stability",),  # its cases have sensors of their own
    *("cells", "cells-report", "cells-compact", "sram"),
    *("openroad-compare", "layout-compare", "layout-timing"),
    *("verify", "formal", "suite", "cocotb", "coverage", "mutate", "fuzz", "stuck-at", "replay"),
}
TAKING = [name for name in COMMANDS if name not in WITHOUT]
# What a command needs besides a sensor file
WORDS = {"sequence": ["--scene=missing"], "decode": ["missing.bin"], "footprints": ["--out=unused"]}
ODD = {
    "tile.rows": "2\ntile.cols = 3",  # with the first types
    "tile.cols": "3",
    "tile.types": f"[{', '.join(f'{{ beta = {10.0 + k}, gamma_deg = 0.0, alpha = 0.0 }}' for k in range(6))}]\n"
    "tile.rows = 2\ntile.cols = 3",
    "tile.order": f"{[*reversed(range(24))]}",
    "array.rows": "40",
    "array.cols": "60",
    "array.pitch": "12e-6",
    "optics.camera.exit_pupil": "0.05",
    "electrical.code": "31",
    "electrical.code_delay": "1e-9",
    "electrical.ambient_current": "1e-12",
    "chip.lanes": "4",
    "chip.divider": '"cordic"',
    "spectral.filter_width": "4e-8",
}


def odd(name):
    """The text of a file with another value of a field."""
    value = values(STANDARD)[name]
    return f"{name} = {ODD.get(name) or (value + 1 if isinstance(value, int) else 0.9 * value or 0.1)}\n"


@pytest.fixture
def refused(tmp_path, monkeypatch, capsys):
    """The line with which a command refuses the text of a sensor file, '' where it takes it."""
    monkeypatch.setenv(ONLY, "1")
    monkeypatch.chdir(tmp_path)

    def line(name, text, *words):
        (tmp_path / "odd.toml").write_text(text)
        status = main([name, *WORDS.get(name, ()), "--sensor=odd.toml", *words])
        out, err = capsys.readouterr()
        lines = [line for line in err.splitlines() if "error: " in line]
        assert status in (0, 2) and len(lines) == (status == 2) and not out, (status, out, err)
        assert [path.name for path in tmp_path.iterdir()] == ["odd.toml"], "a command wrote while it was to check"
        return "".join(lines)

    return line


@pytest.mark.parametrize("name", TAKING)
def test_every_command_takes_a_sensor_file(name):
    parser = Parser(prog=name)
    command(name).add_arguments(parser)
    assert "--sensor" in {option for action in parser.actions for option in action.option_strings}


@pytest.mark.parametrize("name", TAKING)
def test_what_a_command_varies_and_refuses_are_fields(name):
    varied = getattr(command(name), "VARIED", Varied())
    for field in (*varied.used, *varied.fixed):
        assert field in keys(), field
    for field in values(STANDARD):
        assert not (varied.uses(field) and varied.fixes(field)), f"{field}: used and fixed"


@pytest.mark.parametrize("name", [name for name in TAKING if hasattr(command(name), "VARIED")])
def test_a_field_that_a_command_cannot_vary_is_refused_by_its_name(name, refused):
    varied = command(name).VARIED
    for field in values(STANDARD):
        if varied.fixes(field):
            line = refused(name, odd(field))
            part = field.rpartition(".")[0] if field.startswith("tile") else field  # a tile has several fields changed
            assert line.startswith(f"talbot: error: {part}") and ": must be " in line, (field, line)
            assert "this command varies " in line


@pytest.mark.parametrize("name", TAKING)
@pytest.mark.parametrize(
    "text, said",
    [
        ("array.rows = 0", "array.rows = 0: must be an integer in 1..1024"),
        ("converter.bits = 10", "converter.bits = 10: must be a key of [converter]"),
        ("optics.wavelength = 6e-7", "optics.wavelength = 6e-07: must be a key of [optics]"),
        ("process.wafer_um = 300", "process = {'wafer_um': 300}: must be a key of a sensor"),
    ],
)
def test_what_no_sensor_has_is_refused_everywhere(name, text, said, refused):
    assert said in refused(name, text)
