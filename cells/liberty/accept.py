"""Check that Yosys and OpenSTA read a library without a warning."""

import tempfile
from pathlib import Path

from talbot.base.tools import finish, located, plain

SILENT, MISSING = "without a warning", "not installed"
GOOD = (SILENT, MISSING)


def readers(path: str | Path) -> dict[str, str]:
    """Return what Yosys and OpenSTA print on reading the Liberty file ``path``: SILENT, MISSING, or their output."""
    path = plain(Path(path).absolute())
    with tempfile.TemporaryDirectory() as folder:
        script = Path(folder) / "read.tcl"
        script.write_text(f"read_liberty {{{path}}}\nexit\n", encoding="utf-8")
        yosys, opensta = (
            ["yosys", "-q", "-p", f"read_liberty {path}"],
            ["sta", "-no_splash", "-no_init", "-exit", str(script)],
        )
        return {"yosys": _output(yosys), "opensta": _output(opensta)}


def _output(command: list[str]) -> str:
    if not located(command[0]):
        return MISSING
    done = finish(command)
    output = (done.stdout + done.stderr).strip()
    return output[-500:] if output else SILENT if done.returncode == 0 else f"status {done.returncode}"
