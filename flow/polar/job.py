"""Scene -> chip's Verilog in raw mode -> stream -> polarization -> page."""

from collections.abc import Callable, Mapping
from typing import Any

from talbot.flow.frame.job import golden_result, simulate_frame
from talbot.flow.frame.reading import write
from talbot.flow.frame.request import FrameRequest

from .measure import PolarFrame, read_polarization

STEPS = ("setup", "capture", "build", "rtl", "decode", "polarization", "report")


def run(
    request: FrameRequest,
    highlight: float,
    note: Callable[[str], None] = lambda text: None,
    golden: bool = False,
    arguments: Mapping[str, Any] | None = None,
) -> dict[str, Any]:
    """Run everything and write the page and summary.json into ``request.folder``; returns the summary.

    highlight: its polarized light, of white. note: called with the name of each of `STEPS` as it starts. golden: by
    the golden chip alone, without Verilog. arguments: of the command line, kept in the summary.
    Raises ParameterError, ToolError, OSError.
    """
    from . import page  # Matplotlib: not before it is needed

    def found() -> PolarFrame:
        return read_polarization((golden_result if golden else simulate_frame)(request, note), highlight, note)

    return write(request.folder, page.NAMES, found, page, note, arguments)
