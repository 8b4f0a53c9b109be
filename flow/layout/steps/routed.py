"""Names of the steps that also run on the routed layout, from which `thresholds` chooses its cells."""

from collections.abc import Mapping

PREFIX = "routed_"
TWICE = "stream_out", "fill", "extraction"


def of_routed(inputs: Mapping[str, str]) -> dict[str, str]:
    """The inputs of a step of TWICE on the routed layout. inputs: those of the step on the final one."""
    return {name: _of_routed(source) for name, source in inputs.items()}


def _of_routed(source: str) -> str:
    if source == "finish.def":
        return "mend.def"
    return f"{PREFIX}{source}" if source.partition(".")[0] in TWICE else source
