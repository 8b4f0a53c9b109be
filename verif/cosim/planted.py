"""The faults that are planted in the circuit, and what the codes say of each."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from talbot.verif.cosim.accuracy import Accuracy
from talbot.verif.cosim.diagnose import diagnose
from talbot.verif.cosim.faults import Fault
from talbot.verif.cosim.row import RowRequest, read_row

PLANTED = (Fault("comparator", (0,)), Fault("capacitor", (1, 6)), Fault("diodes", (6,)), Fault("row", (1,)))
COARSE = Accuracy(reltol=1e-3, chgtol=1e-15)  # codes that a fault moves by far more
FAULTY = RowRequest(mode="edge", cols=12, lanes=2, types=2, amplifier=True, columns=True, accuracy=COARSE)


def faults(note: Callable[[str], None]) -> list[dict[str, Any]]:
    """Return the diagnosis of each of PLANTED in the circuit of FAULTY. Raises ToolError."""
    lines = []
    for fault in (None, *PLANTED):
        diagnosis = diagnose(read_row(replace(FAULTY, fault=fault)))
        lines.append({"planted": fault.name if fault else "no fault", **diagnosis._asdict()})
        note(f"{lines[-1]['planted']}: found: {diagnosis.name}")
    return lines
