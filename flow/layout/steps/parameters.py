"""Parameters that several steps share."""

from dataclasses import dataclass


@dataclass(frozen=True)
class PdkParameters:
    """Parameters of a step that depends on the process alone. pdk: process."""

    pdk: str = "sky130"
