"""Where a layout breaks rules that `mend` keeps: wires too near to others, wires too large for their gates."""

from dataclasses import dataclass

from ..steps.antenna import violations


@dataclass(frozen=True)
class Marks:
    """close: [(level, box, box), ...], two edges (nm) nearer than wires must be. charged: [(level, polygon), ...], wires too
    large for their gates; a polygon as KLayout writes it. Levels are those of ``Wiring.layers``."""

    close: tuple
    charged: tuple

    def __add__(self, other):
        return Marks(self.close + other.close, self.charged + other.charged)

    def nets(self, board, there, among=None):
        """(names of nets that are too near to others or to themselves, of two the first in the list; names of nets with
        an antenna), both sorted, of the names ``among`` alone if given. there: of the ``board`` as it was then."""
        numbers = range(len(board.nets)) if among is None else [board.numbers[net] for net in among]
        close = set()
        for level, *edges in self.close:
            owners = {number for box in edges for number in board.owners(there, level, box)}.intersection(numbers)
            close |= {board.nets[min(owners)]} if owners else set()
        charged = {net for level, polygon in self.charged for net in board.at(there, level, polygon)}
        return sorted(close), sorted(charged if among is None else charged.intersection(among))


def marks(layout, wiring, known, levels=None):
    """Marks of KLayout's ``layout`` on ``levels``, all without; known: CoriolisPlatform."""
    import klayout.db as db

    top, close = layout.top_cell(), []
    levels = range(len(wiring.layers)) if levels is None else levels
    for level in filter(None, levels):  # the lowest is that of the cells' pins
        wire = wiring.layers[level]
        metal = db.Region(top.begin_shapes_rec(layout.layer(wire.layer, wire.datatype)))
        close += [(level, _ends(pair.first), _ends(pair.second)) for pair in metal.space_check(wire.space).each()]
    charged = [
        (level, str(polygon)) for level, bad in violations(layout, top, known, levels).items() for polygon in bad.each()
    ]
    return Marks(tuple(close), tuple(charged))


def marks_of(path, wiring, known, levels):
    """The same of the GDS file ``path``."""
    import klayout.db as db

    layout = db.Layout()
    layout.read(str(path))
    return marks(layout, wiring, known, levels)


def shared_out(wiring, jobs):
    """``jobs`` lists of levels that take about as long to look at: what lies higher joins all that is below."""
    levels, found = sorted(range(len(wiring.layers)), reverse=True), [[] for _ in range(jobs)]
    for level in levels:
        min(found, key=sum).append(level)
    return found


def _ends(edge):
    box = edge.bbox()
    return box.left, box.bottom, box.right, box.top
