"""One test bench for every level of a block: FL, CL, RTL, the translated Verilog in Verilator and in Icarus.

A block's tests drive a component through its ports only. `build` prepares any level of it for
simulation; a test class for the Verilog levels overrides one attribute, ``verilog = True`` or ``verilog = "icarus"``.
"""

import contextlib
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from typing import Any

from pymtl3 import Component, DefaultPassGroup
from pymtl3.passes.backends.verilog import VerilogTBGenPass

from talbot.rtl.harness.activity import quicken
from talbot.rtl.harness.bits import quicken_bits
from talbot.rtl.harness.driven import Simulation, driven_level
from talbot.rtl.harness.icarus import in_icarus
from talbot.rtl.harness.ports import ports_of
from talbot.rtl.harness.translate import translate_component
from talbot.rtl.harness.verilated import in_verilator

quicken_bits()

Level = bool | str  # True: the translated Verilog in Verilator; "icarus": in Icarus; False: PyMTL
Observe = Callable[[Any, Any, Level], Callable[[], None] | None]  # Any: PyMTL3 has no types
Substitute = Callable[[Any, Level, str], Simulation | None]


@dataclass(frozen=True)
class _Hooks:
    observe: Observe | None
    substitute: Substitute | None


_hooks: list[_Hooks] = []  # what `hooked` has entered and not left


@contextlib.contextmanager
def hooked(observe: Observe | None = None, substitute: Substitute | None = None) -> Iterator[None]:
    """Within this context, `build` calls these for every simulator, before its reset.

    observe(top, dut, verilog): what is simulated, the elaborated component under test and the level; returns what is
    called ahead of each clock edge, or None. substitute(dut, verilog, name): returns the simulation that replaces the
    elaborated component under test, or None.
    """
    hooks = _Hooks(observe, substitute)
    _hooks.append(hooks)
    try:
        yield
    finally:
        _hooks.remove(hooks)


def build(top: Component, verilog: Level = False, name: str | None = None) -> Any:
    """Elaborate ``top`` and prepare it for simulation; returns the simulator, reset.

    verilog: replace ``top.dut`` (or ``top`` itself, if it has none) by its translated Verilog in Verilator (True) or
    in Icarus ('icarus': slower, but with X, and a netlist can take the place of the translation).
    name: of what is compiled, and of the netlist that may take its place; the class's by default.
    """
    top.elaborate()
    dut = getattr(top, "dut", top)
    name = name or type(dut).__name__
    if simulation := _simulation(dut, verilog, name):
        top = _in_place(top, dut, driven_level(dut, simulation))
    observers = [hooks.observe for hooks in _hooks if hooks.observe]
    each_cycle = [call for observe in observers if (call := observe(top, dut, verilog))]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        if each_cycle:
            top.set_metadata(VerilogTBGenPass.vtbgen_hooks, each_cycle)
        top.apply(DefaultPassGroup(linetrace=False))
        quicken(top)
    top.sim_reset()
    return top


def _simulation(dut: Component, verilog: Level, name: str) -> Simulation | None:
    """Return the simulation that replaces PyMTL for the elaborated ``dut``, or None where PyMTL simulates."""
    for hooks in _hooks:
        if hooks.substitute and (simulation := hooks.substitute(dut, verilog, name)):
            return simulation
    if not verilog:
        return None
    cls = type(dut)
    text = _translated(cls, dut._dsl.args, tuple(dut._dsl.kwargs.items()))
    if verilog == "icarus":
        return in_icarus(name, cls.__name__, ports_of(dut), texts=[text])
    return in_verilator(name, cls.__name__, ports_of(dut), text)


@cache
def _translated(cls: type[Component], arguments: tuple[Any, ...], named: tuple[tuple[str, Any], ...]) -> str:
    return translate_component(cls(*arguments, **dict(named)), cls.__name__)


def _in_place(top: Component, dut: Component, module: Component) -> Component:
    if dut is top:
        module.elaborate()
        return module
    top.replace_component_with_obj(dut, module)
    return top
