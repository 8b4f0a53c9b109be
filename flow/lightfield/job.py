"""Scene -> chip's Verilog in raw mode -> stream -> light field and depth -> page."""

from collections.abc import Callable
from typing import Any

from talbot.flow.frame.job import golden_result, simulate_frame
from talbot.flow.frame.reading import write
from talbot.flow.frame.request import FrameRequest
from talbot.models.reconstruct.bayes import FieldPrior

from .fields import read_back
from .methods import METHODS

STEPS = ("setup", "capture", "build", "rtl", "decode", *METHODS, "report")


def run(
    request: FrameRequest, prior: FieldPrior, note: Callable[[str], None] = lambda text: None, golden: bool = False
) -> dict[str, Any]:
    """Run everything and write the page and summary.json into ``request.folder``; returns the summary.

    note: called with the name of each of `STEPS` as it starts. golden: by the golden chip alone, without Verilog.
    Raises ParameterError, ToolError, OSError.
    """
    from . import page  # Matplotlib: not before it is needed

    read = golden_result if golden else simulate_frame
    return write(request.folder, page.NAMES, lambda: read_back(read(request, note), prior, note), page, note)
