"""Scene -> four taps through the chip's Verilog -> depth field, unwrapped -> page."""

from collections.abc import Callable, Mapping
from typing import Any

from talbot.flow.frame.reading import write
from talbot.flow.frame.request import FrameRequest
from talbot.models.reconstruct.bayes import FieldPrior

from .capture import capture
from .measure import Depth, read_depth

STEPS = ("setup", "capture", "build", "rtl", "decode", "field", "unwrap", "report")


def run(
    request: FrameRequest,
    prior: FieldPrior,
    note: Callable[[str], None] = lambda text: None,
    golden: bool = False,
    arguments: Mapping[str, Any] | None = None,
) -> dict[str, Any]:
    """Run everything and write the page and summary.json into ``request.folder``; returns the summary.

    note: called with the name of each of `STEPS` as it starts. golden: by the golden chip alone, without Verilog.
    arguments: of the command line, kept in the summary. Raises ParameterError, ToolError, OSError.
    """
    from . import page  # Matplotlib: not before it is needed

    def found() -> Depth:
        return read_depth(capture(request, note, golden), prior, note)

    return write(request.folder, page.NAMES, found, page, note, arguments)
