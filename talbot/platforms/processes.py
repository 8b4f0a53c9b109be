"""The processes by name."""

from collections.abc import Sequence

from talbot.models.parameters import ParameterError

PROCESSES = "sky130", "ihp-sg13g2"


def package(pdk: str, choices: Sequence[str] = PROCESSES, use: str = "") -> str:
    """Name of the folder of ``pdk``. Raises ParameterError for one not in ``choices``; use: end of its message."""
    if pdk not in choices:
        raise ParameterError(f"pdk = {pdk!r}: must be one of {', '.join(choices)}{use}")
    return pdk.replace("-", "_")
