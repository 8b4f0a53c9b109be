"""The stimulus of a block: its ports in a real frame, recorded in the chip's RTL; else in its own tests.

A wrapper's is recorded behind its host.
"""

import json
import sys
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from talbot.base.paths import ROOT
from talbot.base.steps import Files, Step, StepError
from talbot.base.tools import ToolError, finish, run
from talbot.imaging.simulate.build import Build
from talbot.imaging.simulate.icarus import icarus_program
from talbot.rtl.sensor_options import sensor_with
from talbot.rtl.tinytapeout.golden import EXAMPLES
from talbot.rtl.tinytapeout.host import simulate as simulate_host
from talbot.rtl.verilog import export_verilog
from talbot.signoff.netlist.verilog import modules

if TYPE_CHECKING:
    from talbot.models.parameters import Window

CHIP = "AspChip"
TAP = """module Tap;
  integer file;
  reg [8*512-1:0] name;
  initial begin
    if (!$value$plusargs("tap=%s", name)) $fatal(1, "+tap=FILE is missing");
    file = $fopen(name, "w");
  end
  reg fresh = 1;
  always @(posedge {clock}) begin
    $fwrite(file, "%b %b %b\\n", fresh, {{{inputs}}}, {{{outputs}}});
    fresh <= 0;
  end
endmodule
"""
OF_A_TRACE = "import sys; from talbot.rtl.replay import load; print(load(sys.argv[1]).verilog())"
SCENE = "motorcycle"  # of `make sim`
SMALL = "--rows=12", "--cols=18"  # the chip around a block


@dataclass(frozen=True)
class StimulusParameters:
    """The block, and the chip in which it is looked for.

    top: module. folder: of the block in rtl/. options: of the chip, as of rtl.export. tiles: number of tiles read, in
    the middle of the array; None for all.
    """

    top: str = ""
    folder: str = ""
    options: tuple[str, ...] = SMALL
    tiles: int | None = None


class Stimulus(Step[StimulusParameters]):
    """A time-of-flight frame of the scene of `make sim`, with phases where the chip has them: it uses every block.

    The chip has a small array; for AspChip itself a few tiles are read. A block that is not in that chip with the same
    Verilog has the trace of its own tests. A wrapper has that of an example behind its host.
    """

    name = "stimulus"
    inputs = {"rtl": "rtl"}
    outputs = {"head": "stimulus.json", "trace": "stimulus.trace"}
    metrics = {"source": "", "cycles": "", "results": ""}
    tools = ("iverilog", "yosys")

    def starts(self) -> tuple[str, ...]:
        """The tests that `rtl.replay` runs."""
        return (f"rtl/{self.parameters.folder}/test",)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        top = self.parameters.top
        with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
            folder = Path(folder)
            export_verilog(folder, [CHIP], self.parameters.options)
            chip, own = (folder / f"{CHIP}.sv").read_text(encoding="utf-8"), inputs["rtl"].read_text(encoding="utf-8")
            if top in EXAMPLES:
                head = in_host(self.parameters, inputs["rtl"], folder, outputs["trace"])
            elif set(modules(own).items()) <= set(modules(chip).items()):
                head = in_frame(self.parameters, folder, outputs["trace"])
            else:
                head = in_tests(top, own, folder, outputs["trace"])
        outputs["head"].write_text(json.dumps(head, indent=1) + "\n", encoding="utf-8")
        return {name: head[name] for name in self.metrics}


def in_frame(parameters: StimulusParameters, folder: Path, trace: Path) -> dict[str, Any]:
    """Record the block's first instance in the chip in ``folder`` through a frame, to the file ``trace``; the head."""
    from talbot.imaging.frame.hardware import simulate
    from talbot.imaging.frame.job import expose, see
    from talbot.imaging.frame.request import request
    from talbot.models.chip import golden_frame

    design = folder / "hierarchy.json"
    run(["yosys", "-q", "-p", f"read_verilog -sv {folder / CHIP}.sv; hierarchy -top {CHIP}; proc; write_json {design}"])
    tree = json.loads(design.read_text(encoding="utf-8"))["modules"]
    path = instance_of(tree, CHIP, parameters.top) or ()
    ports = ports_of(tree, parameters.top)
    (folder / "tap.v").write_text(tap("Clock.clk", ".".join(("Clock.bench.chip", *path)), ports), encoding="utf-8")
    window = partial(middle, tiles=parameters.tiles) if parameters.tiles else None
    sensor = sensor_with(parameters.options)
    asked = request(sensor=sensor, scene=SCENE, mode="tof", phase=sensor.chip.has_phase_path, window=window)
    exposed = expose(asked, *see(asked))
    program = icarus_program(Build.of(asked.sensor), folder, [folder / f"{CHIP}.sv", folder / "tap.v"], ("Tap",))
    more = (f"+tap={folder / 'tap.trace'}",)
    seen = simulate(program, asked.sensor, asked.frame, exposed.samples, exposed.front_end, more=more)
    if seen.stream != golden_frame(exposed.samples, asked.sensor, asked.frame, exposed.front_end).stream:
        raise StepError("stimulus: the chip's frame is not the golden chip's")
    lines = recorded((folder / "tap.trace").read_text(encoding="utf-8"))
    trace.write_text("\n".join(lines) + "\n", encoding="utf-8")
    head = {"source": "frame", "scene": SCENE, "instance": ".".join(path)}
    return head | {"ports": ports, "cycles": len(lines), "results": results(lines, ports)}


def ports_of(tree: Mapping[str, Any], module: str) -> list[dict[str, Any]]:
    """Ports of a module in Yosys's JSON, without the clock, as the head of a trace has them."""
    found = next(found for name, found in tree.items() if name.lstrip("\\") == module)
    return [
        {"path": name, "width": len(port["bits"]), "output": port["direction"] == "output"}
        for name, port in found["ports"].items()
        if name != "clk"
    ]


def tap(clock: str, instance: str, ports: Sequence[Mapping[str, Any]]) -> str:
    """Verilog that writes the values of an instance's ``ports`` at every rising edge of ``clock``."""
    names = [(f"{instance}.{port['path']}", port["output"]) for port in reversed(ports)]
    inputs, outputs = (", ".join(name for name, output in names if output == wanted) for wanted in (False, True))
    return TAP.format(clock=clock, inputs=inputs, outputs=outputs)


def in_host(parameters: StimulusParameters, rtl: Path, folder: Path, trace: Path) -> dict[str, Any]:
    """Record a wrapper whose Verilog is the file ``rtl`` behind its host, to the file ``trace``; the head."""
    design, top = folder / "wrapper.json", parameters.top
    run(["yosys", "-q", "-p", f"read_verilog -sv {rtl}; hierarchy -top {top}; proc; write_json {design}"])
    ports = ports_of(json.loads(design.read_text(encoding="utf-8"))["modules"], top)
    written = folder / "tap.trace"
    simulate_host(top, EXAMPLES[top], [rtl], folder, tap("host.clk", "host.dut", ports), [f"+tap={written}"])
    lines = recorded(written.read_text(encoding="utf-8"))
    trace.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return {"source": "host", "ports": ports, "cycles": len(lines), "results": results(lines, ports)}


def recorded(tap: str) -> list[str]:
    """The lines of a trace; the first is fresh, since what was before it is unknown."""
    first, *lines = map(settled, tap.splitlines())
    return ["1" + first[1:], *lines]


def settled(line: str) -> str:
    """A line of the tap, in bits, as one of a trace: fresh where an output is X, so that a reset lasts.

    An input that is X, as data are during a reset, is 0.
    """
    fresh, *vectors = line.split()
    packed = (f"{int(bits.replace('x', '0').replace('z', '0'), 2):0{-(-len(bits) // 4)}x}" for bits in vectors)
    return " ".join(["1" if "x" in vectors[1] else fresh, *packed])


def middle(full: "Window", tiles: int) -> "Window":
    """``tiles`` tiles of the middle row of a window."""
    tiles = min(tiles, full.col1 - full.col0 + 1)
    row, col = (full.row0 + full.row1) // 2, (full.col0 + full.col1 + 1 - tiles) // 2
    return replace(full, row0=row, row1=row, col0=col, col1=col + tiles - 1)


def results(lines: Sequence[str], ports: Sequence[Mapping[str, Any]]) -> int:
    """Messages that left at the port `send` of a trace: cycles with send.val and send.rdy."""
    places, low = {}, {False: 0, True: 0}
    for port in ports:
        places[port["path"].replace(".", "__")] = port["output"], low[port["output"]]
        low[port["output"]] += port["width"]
    if not {"send__val", "send__rdy"} <= set(places):
        return 0
    wanted = [(1 + output, at) for output, at in (places["send__val"], places["send__rdy"])]
    return sum(all(int(line.split()[column], 16) >> at & 1 for column, at in wanted) for line in lines)


def instance_of(tree: Mapping[str, Any], module: str, wanted: str) -> tuple[str, ...] | None:
    """Instance names from ``module`` to its first instance of ``wanted`` in Yosys's JSON, or None."""
    if module == wanted:
        return ()
    for name, cell in sorted(tree[module]["cells"].items()):
        if cell["type"] in tree:
            below = instance_of(tree, cell["type"], wanted)
            if below is not None:
                return (name, *below)
    return None


def in_tests(top: str, own: str, folder: Path, trace: Path) -> dict[str, Any]:
    """Record the tests of the block, that with the Verilog ``own`` to the file ``trace``; the head."""
    done = finish(
        [sys.executable, "-m", "talbot.rtl.replay.command", "record", top, "--out", folder / "traces"], cwd=ROOT
    )
    if done.returncode:
        raise ToolError(done.stderr.strip().splitlines()[-1])
    heads = sorted((folder / "traces").glob("*.json"), key=lambda path: -path.with_suffix(".trace").stat().st_size)
    for path in heads:
        text = run([sys.executable, "-c", OF_A_TRACE, path], cwd=ROOT)
        if modules(text) == modules(own):
            trace.write_bytes(path.with_suffix(".trace").read_bytes())
            head = json.loads(path.read_text(encoding="utf-8"))
            found = results(trace.read_text(encoding="utf-8").splitlines(), head["ports"])
            return {"source": "tests", "ports": head["ports"], "cycles": head["cycles"], "results": found}
    raise StepError(f"stimulus: no test of {top} builds it with the parameters that are laid out")
