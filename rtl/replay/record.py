"""The tests of a block, run once with its ports recorded."""

import sys
from pathlib import Path

from talbot.base.paths import ROOT
from talbot.base.tools import ToolError, finish
from talbot.models.parameters import SensorParameters
from talbot.rtl.tops import build_top

VERILOG_ONLY = "AspChip"  # a frame of the chip takes too long in PyMTL: only the Verilog level runs all tests


class RecordError(ToolError):
    """The tests of a block fail; the message holds the end of pytest's output."""


def tests_of(block: str) -> tuple[str, Path]:
    """Return the class of a block of rtl.tops and the folder of its tests. Raises ParameterError."""
    cls = type(build_top(block, SensorParameters()))
    return cls.__name__, Path(sys.modules[cls.__module__].__file__).parent / "test"


def whole_level(block: str) -> str:
    """Return the level that runs all tests of a block: 'RTL' or 'Verilog'."""
    return "Verilog" if block == VERILOG_ONLY else "RTL"


def record(block: str, folder: Path | str, level: str | None = None) -> list[Path]:
    """Run the block's tests and save a trace a parameter set in ``folder``; returns the .json paths, longest first.

    level: 'RTL' or 'Verilog', by default `whole_level`. Raises ParameterError, RecordError.
    """
    cls, tests = tests_of(block)
    folder = Path(folder).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    level = level or whole_level(block)
    program = (
        "import sys, pytest; from talbot.rtl.replay.recorder import Plugin; "
        "sys.exit(pytest.main(sys.argv[4:], [Plugin(*sys.argv[1:4])]))"
    )
    # PyMTL is a pytest plugin, which the program imports before pytest starts. A seed: the same traces every time.
    options = ["-p", "no:cacheprovider", "-W", "ignore::pytest.PytestAssertRewriteWarning", "--hypothesis-seed=1"]
    result = finish([sys.executable, "-c", program, cls, folder, level, *options, tests], cwd=ROOT)
    if result.returncode:
        raise RecordError(f"{block}: its tests fail:\n{(result.stdout + result.stderr).strip()[-2000:]}")
    files = sorted(folder.glob(f"{cls}.trace")) + sorted(folder.glob(f"{cls}.????????.trace"))
    return [path.with_suffix(".json") for path in sorted(files, key=lambda path: -path.stat().st_size)]
