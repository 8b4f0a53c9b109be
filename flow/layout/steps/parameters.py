"""Parameters that several steps share."""

from dataclasses import dataclass


@dataclass(frozen=True)
class PdkParameters:
    """pdk: process."""

    pdk: str = "sky130"
