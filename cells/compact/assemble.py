"""Gates and diffusions of a placement, and the routing task that they make."""

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

from talbot.cells.compact.canvas import Canvas
from talbot.cells.compact.grid import Vertex
from talbot.cells.compact.place import Column, breaks
from talbot.cells.compact.route import Task


@dataclass
class Diffusion:
    """A stretch of diffusion between gates. kind: 'n' or 'p'; columns: its contact columns (half sites)."""

    kind: str
    net: str
    columns: list[int]


@dataclass
class Assembly:
    """A placement in half-site columns: their number, the gates with their column, the diffusions."""

    columns: int
    gates: list[tuple[int, Column]]
    diffusions: list[Diffusion] = field(default_factory=list)


def assemble(columns: Sequence[Column], spread: Iterable[int] = ()) -> Assembly:
    """Put columns in their places. spread: indices k with a gap after column k that the nets do not need."""
    gaps = set(breaks(columns)) | set(spread)
    gates, h = [], 1
    for k, column in enumerate(columns):
        gates.append((h, column))
        h += 4 if k in gaps else 2
    assembly = Assembly(gates[-1][0] + 2, gates)
    for kind in "np":
        for (h, column), following in zip(gates, [*gates[1:], None], strict=True):
            left, right = column.ends(kind)
            last = assembly.diffusions[-1] if assembly.diffusions else None
            if not last or (last.kind, last.columns[-1], last.net) != (kind, h - 1, left):
                assembly.diffusions.append(Diffusion(kind, left, [h - 1]))
            assembly.diffusions.append(Diffusion(kind, right, [h + 1]))
            if following and following[0] == h + 4 and following[1].ends(kind)[0] == right:
                assembly.diffusions[-1].columns.append(h + 3)  # runs on through the gap
    return assembly


def task(assembly: Assembly, canvas: Canvas, ports: tuple[str, ...]) -> Task:
    """Make the routing task of an assembly."""
    count = Counter(d.net for d in assembly.diffusions)
    gate_nets = {net for _, c in assembly.gates for net in (c.n.gate, c.p.gate)}
    terminals: dict[str, list[set[Vertex]]] = {}
    blocked: dict[str, set[Vertex]] = {"vss": set(), "vdd": set()}
    for d in assembly.diffusions:
        row = 0 if d.kind == "n" else len(canvas.rows) - 1
        spots: set[Vertex] = {("li", h, row) for h in d.columns}
        if d.net in blocked:
            blocked[d.net] |= spots
        elif count[d.net] > 1 or d.net in gate_nets or d.net in ports:
            terminals.setdefault(d.net, []).append(spots)
    for h, column in assembly.gates:
        for switch, row in ((column.n, canvas.low), (column.p, canvas.high)):
            terminals.setdefault(switch.gate, []).append({("poly", h, row)})
    return Task(assembly.columns, canvas, terminals, tuple(p for p in ports if p not in blocked), blocked)
