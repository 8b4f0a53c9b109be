"""Process data of a shuttle's wrapper: a block of fixed outline and pins, whose pads and package are the shuttle's."""

from collections.abc import Mapping
from dataclasses import dataclass
from importlib import import_module

from talbot.platforms.processes import package

PROCESSES = ("sky130",)


@dataclass(frozen=True, kw_only=True)
class Wrapper:
    """A wrapper and what its pins carry.

    name: of the shuttle's product. cell: top cell of its empty GDS. signals: signal of the sensor -> pin. spare: prefix
    of the pins in the south that take a signal without a pin. supplies: side -> supply of the sensor -> pin. low, high:
    pins with a constant level. levels: side -> supplies of these two. outputs: prefixes of the pins that the sensor
    drives; inouts: of those without a direction; power: of supplies; the others are inputs. files: name -> text of what
    the shuttle's repository needs with the layout.
    """

    name: str
    cell: str
    signals: Mapping[str, str]
    spare: str
    supplies: Mapping[str, Mapping[str, str]]
    low: tuple[str, ...]
    high: tuple[str, ...]
    levels: Mapping[str, tuple[str, str]]
    outputs: tuple[str, ...]
    inouts: tuple[str, ...]
    power: tuple[str, ...]
    files: Mapping[str, str]


def wrappers(pdk: str) -> Mapping[str, Wrapper]:
    """Return the wrappers of shuttles in ``pdk`` by their cells. Raises ParameterError for a process without one."""
    return import_module(f"talbot.platforms.{package(pdk, PROCESSES, ' for a wrapper')}.chipignite").WRAPPERS
