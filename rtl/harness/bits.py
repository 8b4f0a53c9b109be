"""PyMTL's Bits with a fast path through its most called methods.

PyMTL3 3.1.17 learns from an AttributeError that an operand is an int, which takes ten times as long as a look at its
class. What a fast path does not handle (another width, a number out of range, a bit struct) goes to PyMTL's method,
which converts or raises.
"""

from collections.abc import Callable
from typing import Any

from pymtl3.datatypes import PythonBits
from pymtl3.datatypes.PythonBits import Bits

METHOD = """
def {name}(s, other):
  kind = other.__class__
  if kind is int or kind is bool:
    uint = other & upper[s._nbits]
    if uint != other:
      return slow(s, other)
  else:
    try:
      if other._nbits != s._nbits:
        return slow(s, other)
      uint = other._uint
    except AttributeError:
      return slow(s, other)
"""
ASSIGN = "  s.{field} = uint\n  return s\n"
OPERATE = "  made = new(Bits)\n  made._nbits, made._uint = {nbits}, s._uint {sign} uint{within}\n  return made\n"
INIT = """
def __init__(s, nbits, v=0, trunc_int=False):
  if v.__class__ is int and nbits.__class__ is int and 0 < nbits < 1024:
    uint = v & upper[nbits]
    if trunc_int or uint == v:
      s._nbits, s._uint = nbits, uint
      return
  slow(s, nbits, v, trunc_int)
"""
NUMBER = "def __int__(s):\n  return +s._uint  # a comparison's is a bool\n"
GETITEM = """
def __getitem__(s, place):
  if place.__class__ is slice:
    low, end = place.start, place.stop
    if place.step is not None or not (low.__class__ is int is end.__class__ and 0 <= low < end <= s._nbits):
      return slow(s, place)
  elif place.__class__ is int and 0 <= place < s._nbits:
    low, end = place, place + 1
  else:
    return slow(s, place)
  made = new(Bits)
  made._nbits, made._uint = end - low, s._uint >> low & upper[end - low]
  return made
"""

COMPARED = {"__eq__": "==", "__ne__": "!=", "__lt__": "<", "__le__": "<=", "__gt__": ">", "__ge__": ">="}
OPERATORS = {"__and__": "&", "__or__": "|", "__xor__": "^", "__add__": "+", "__sub__": "-"}
SOURCES = (
    {name: METHOD + ASSIGN.format(field=field) for name, field in (("__imatmul__", "_uint"), ("__ilshift__", "_next"))}
    | {
        name: METHOD + OPERATE.format(nbits="s._nbits", sign=sign, within=" & upper[s._nbits]" * (sign in "+-"))
        for name, sign in OPERATORS.items()
    }
    | {name: METHOD + OPERATE.format(nbits=1, sign=sign, within="") for name, sign in COMPARED.items()}
    | {"__init__": INIT, "__int__": NUMBER, "__getitem__": GETITEM}
)
SLOW = {name: getattr(Bits, name) for name in SOURCES}  # PyMTL's own


def _short(name: str) -> Callable[..., Any]:
    scope: dict[str, Any] = {"upper": tuple(PythonBits._upper), "new": object.__new__, "Bits": Bits, "slow": SLOW[name]}
    exec(SOURCES[name].format(name=name), scope)
    return scope[name]


SHORT = {name: _short(name) for name in SOURCES}


def quicken_bits() -> None:
    """Give Bits the fast paths."""
    for name, method in SHORT.items():
        setattr(Bits, name, method)
