"""Corners: process, temperature and supply, by the names that foundries give them."""

import re
from dataclasses import dataclass
from typing import Self

from talbot.models.parameters import ParameterError

PROCESSES = ("tt", "ss", "ff", "sf", "fs")


@dataclass(frozen=True)
class Corner:
    """A process of PROCESSES (n then p), a temperature (-100 to 200 degrees Celsius) and a supply (0.1 to 10 V)."""

    process: str
    temperature: float
    supply: float

    @classmethod
    def parse(cls, name: str) -> Self:
        """The corner of a name like tt_025C_1v80 or ff_n40C_1v95. Raises ParameterError for any other form."""
        match = re.fullmatch(r"([a-z]{2})_(n?)(\d+)C_(\d+)v(\d+)", name)
        if not match or match[1] not in PROCESSES:
            must = f"must be like tt_025C_1v80 or ff_n40C_1v95, its process one of {', '.join(PROCESSES)}"
            raise ParameterError(f"corner = {name!r}: {must}")
        return cls(match[1], -float(match[3]) if match[2] else float(match[3]), float(f"{match[4]}.{match[5]}"))

    def __post_init__(self) -> None:
        if not -100 <= self.temperature <= 200:
            raise ParameterError(f"temperature = {self.temperature}: must be -100 to 200 degrees Celsius")
        if not 0.1 <= self.supply <= 10:
            raise ParameterError(f"supply = {self.supply}: must be 0.1 to 10 V")

    @property
    def name(self) -> str:
        """The name, like tt_025C_1v80."""
        sign = "n" if self.temperature < 0 else ""
        degrees = abs(round(self.temperature))
        return f"{self.process}_{sign}{degrees:0{2 if sign else 3}d}C_{self.supply:.2f}".replace(".", "v")
