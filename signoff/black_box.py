"""A drawn block against its black box: the pins of its LEF."""

from pathlib import Path

from talbot.base.lef.read import read_macro
from talbot.models.parameters import ParameterError


def extra_pins(path: Path, black_box: Path) -> list[str]:
    """Names of the pins that only the LEF ``path`` has: references and biases, which lead to pins of the die.

    Raises ParameterError unless it has the pins of ``black_box`` with their directions.
    """
    own, wanted = (
        {
            pin.name: pin.direction.upper()
            for pin in read_macro(file.read_text(errors="replace", encoding="utf-8")).pins.values()
        }
        for file in (path, black_box)
    )
    if lacking := [pin for pin in wanted if pin not in own]:
        more = f" and {len(lacking) - 5} more" if len(lacking) > 5 else ""
        raise ParameterError(f"analog = {path}: must have the pins {', '.join(lacking[:5])}{more}")
    if other := [pin for pin in wanted if own[pin] != wanted[pin]]:
        raise ParameterError(f"analog = {path}: its pin {other[0]} must be of DIRECTION {wanted[other[0]]}")
    return [pin for pin in own if pin not in wanted]
