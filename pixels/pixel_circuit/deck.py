"""The pixel's netlist for ngspice, with the diffusions, junctions and wires that are drawn, and analyses of it."""

import tempfile
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from talbot.base.tools import ToolError, run
from talbot.cells.corner import Corner
from talbot.models.parameters import ArrayParameters, check_real, drawn_lines
from talbot.pixels.drawn import DUMMIES, check_pitch
from talbot.pixels.layout.pixel import DIFFUSION, PixelLayout
from talbot.platforms.pixel import pixel_models

Floats = npt.NDArray[np.float64]
NODES = "photo_a", "photo_b"
PORTS = "pixel_reset", "read", "column_a", "column_b", "vdda", "vssa"

SINK_ENDS, SINK_OHM = 0.02, 1e9  # V, ohm
# abstol is below a diode's dark current, 0.2 fA, and what gmin carries is 1 % of that
OPTIONS = ".option gmin=1e-18 abstol=1e-19 chgtol=1e-20 reltol=1e-5 itl1=500 itl2=300 itl4=200"
LINEAR = ".option gmin=1e-18 abstol=1e-13 reltol=1e-4 itl1=500"  # of analyses at a point, with currents of 1 uA


@dataclass(frozen=True)
class Bench:
    """Surroundings of a pixel; assumed, since there is no column amplifier in transistors.

    sink_a: of each column, 1e-7..1e-3 A. low_v: least voltage that the sink needs, 0..1 V. rows: of pixels on a column,
    1..4096. gate_v: of an active reset line, 1..5.5 V; the select line has the process's own. pitch_um: of the pixels.
    """

    sink_a: float = 5e-6
    low_v: float = 0.3
    rows: int = ArrayParameters.rows + 2 * DUMMIES
    gate_v: float = 5.0
    pitch_um: float = ArrayParameters().pitch_um

    def __post_init__(self) -> None:
        check_real("sink_a", self.sink_a, 1e-7, 1e-3)
        check_real("low_v", self.low_v, 0, 1)
        check_real("rows", self.rows, 1, 4096)
        check_real("gate_v", self.gate_v, 1, 5.5)
        check_pitch(self.pitch_um)


def subcircuit(made: PixelLayout) -> list[str]:
    """Lines of the pixel that LVS compares (`pixels.layout.circuit`), both diodes' nodes as ports too.

    Each transistor has the area and the edge of its drawn diffusions; a shared one is halved.
    """
    process, models = made.process, pixel_models(made.process.name)
    left, right, _ = DIFFUSION
    gates, length, width = made.gates_um, made.l_um, made.w_um
    between = [b - a - length for a, b in zip(gates, gates[1:], strict=False)]
    node, column = gates[0] - left, right - gates[2] - length
    halves = [(gap / 2 * width, gap) for gap in between]
    ends = [(end * width, 2 * end + width) for end in (node, column)]
    # (drain, source) of reset, follower, select: (area, perimeter)
    sizes = (halves[0], ends[0]), (halves[0], halves[1]), (halves[1], ends[1])
    lines = [f".subckt pixel {' '.join((*PORTS, *NODES))}"]
    for one in made.circuit.transistors:
        place = ("reset", "follower", "select").index(one.name.rpartition("_")[0])
        (ad, pd), (as_, ps) = sizes[place]
        sa, sb = gates[place] - left, right - gates[place] - length
        lines.append(
            f"X{one.name} {one.drain} {one.gate} {one.source} vssa {process.transistor} w={one.w_um:g} l={one.l_um:g} "
            f"ad={ad:g} as={as_:g} pd={pd:g} ps={ps:g} sa={sa:g} sb={sb:g} sd=0"
        )
    area, edge = made.node_wire_um
    local = process.metals[0]
    for well in made.circuit.diodes:
        lines += models.diode(well.name, well.node, "vssa", well.area_um2, well.perimeter_um)
        farads = (area * local.area_af_um2 + edge * local.fringe_af_um) * 1e-18
        lines.append(f"C{well.name} {well.node} vssa {farads:.6g}")
    return [*lines, ".ends pixel"]


def pixel_deck(made: PixelLayout, corner: Corner, bench: Bench, mismatch: int | None = None) -> list[str]:
    """Models, supplies, one pixel, and columns with their sinks and the select transistors of all other rows.

    mismatch: seed with which every transistor is drawn. Nodes are the pixel's ports.
    """
    process, models = made.process, pixel_models(made.process.name)
    sizes = {(one.w_um, one.l_um) for one in made.circuit.transistors}
    lines = [f".option seed={mismatch}"] if mismatch is not None else []
    lines += models.cards(corner.process, sizes, mismatch is not None)
    lines += [OPTIONS, f".temp {corner.temperature:g}", *subcircuit(made)]
    lines += [f"Vdda vdda 0 {corner.supply:g}", "Vssa vssa 0 0", f"Xpixel {' '.join((*PORTS, *NODES))} pixel"]
    one, end = made.circuit.transistors[0], DIFFUSION[1] - made.gates_um[2] - made.l_um
    junction = f"ad={end * one.w_um:g} pd={2 * end + one.w_um:g} as={end * one.w_um:g} ps={2 * end + one.w_um:g}"
    for side in "ab":
        lines += [
            # a sink ends at the ground
            f"Bsink_{side} column_{side} 0 I={bench.sink_a:g}*tanh(v(column_{side})/{SINK_ENDS:g})",
            f"Rsink_{side} column_{side} 0 {SINK_OHM:g}",
            f"Cline_{side} column_{side} 0 {bench.rows * drawn_lines(bench.pitch_um).column_farad:.6g}",
            f"Xothers_{side} column_{side} 0 0 vssa {process.transistor} w={one.w_um:g} l={one.l_um:g} {junction} "
            f"sa=0.3 sb=0.3 sd=0 m={bench.rows - 1}",
        ]
    return lines


def analyse(deck: Iterable[str], commands: Sequence[str], wanted: Sequence[str]) -> Floats:
    """Vectors ``wanted`` (expressions of ngspice) of the last of ``commands``, (n, points). Raises ToolError."""
    with tempfile.TemporaryDirectory(prefix="pixel-") as name:
        folder = Path(name)
        write = ["set wr_singlescale", "set wr_vecnames", f"wrdata found.txt {' '.join(wanted)}"]
        text = ["* a drawn pixel", *deck, ".control", *commands, *write, "quit", ".endc", ".end", ""]
        (folder / "deck.sp").write_text("\n".join(text), encoding="utf-8")
        output = run(["ngspice", "-n", "-b", "deck.sp"], {"OMP_NUM_THREADS": "1"}, cwd=folder, seconds=3600)
        file = folder / "found.txt"
        if not file.exists():
            wrong = [line for line in output.splitlines() if "rror" in line or "aborted" in line]
            raise ToolError(f"ngspice: {' '.join(commands)} gave nothing: {'; '.join(wrong[:3])}")
        return np.atleast_2d(np.loadtxt(file, skiprows=1)).T[1:]


def pulses(events: Iterable[tuple[float, float]], start: float, edge: float = 1e-8) -> str:
    """Return a source's PWL text: (s, V) from which time on it has which value. start: V at first."""
    points, value = [(0.0, start)], start
    for at, level in events:
        points += [(at, value), (at + edge, level)]
        value = level
    return f"PWL({' '.join(f'{t:.9g} {v:.9g}' for t, v in points)})"
