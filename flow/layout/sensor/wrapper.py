"""The sensor in a shuttle's wrapper, whose fixed pins take the place of the ring of pads; in nm.

Digital signals have pins in the west and the east, references in the north, above the array. Along the edge are two
lines a side with the levels of the pins that are constant. A supply's pin meets its bar, in the north its line.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from talbot.base.gds import read_gds
from talbot.base.steps import StepError
from talbot.flow.layout.sensor import shapes
from talbot.flow.layout.sensor.plan import SUPPLIES, Block, Box, DieParameters, Terminal, bar
from talbot.flow.layout.sensor.routing import BRANCH, STUB, Branch, Found, Nets, Tracks
from talbot.flow.layout.sensor.rules import RoutingRules
from talbot.flow.layout.sensor.shapes import Shape
from talbot.flow.layout.sensor.supplies import in_north, vias
from talbot.flow.layout.sensor.verilog import INSIDE, buses, inside
from talbot.models.parameters import ParameterError
from talbot.platforms.die import TopMetal, top_metal
from talbot.platforms.layout import layout_platform
from talbot.platforms.wrapper import Wrapper, wrappers

RING_UM = 30.0  # from the edge to what is inside: room for the lines of constant levels
LINE, FIRST, STEP = 2_000, 6_000, 5_000  # of these lines: width, distance of the first from the edge, of the second
CROSS, CLEAR = 40_000, 3_000  # from the north edge to their ways to the bars, at least; from pins to these
NORTH, NORTH_STEP, DROP = 10_000, 2_000, 2_500  # of ways to pins in the north: from the edge, apart, half of a drop
INTO = 5_000  # how far a drop reaches into its pin
Shapes = Iterator[Shape]


@dataclass(frozen=True)
class Surround:
    """A wrapper's outline and pins. pins: name -> its (level in RoutingRules.layers, box)."""

    wrapper: Wrapper
    width: int
    height: int
    pins: Mapping[str, Sequence[tuple[int, Box]]]

    @classmethod
    def read(cls, gds: Path, pdk: str) -> "Surround":
        """Read the empty wrapper's GDS. Raises ParameterError for one that is not known."""
        layout, tech = read_gds(gds), layout_platform(pdk)
        known = wrappers(pdk)
        names = [cell.name for cell in layout.top_cells()]
        if len(names) != 1 or names[0] not in known:
            raise ParameterError(
                f"wrapper = {gds.name} with the top cells {', '.join(names)}: must be {', '.join(known)}"
            )
        top, found = layout.top_cell(), dict[str, list[tuple[int, Box]]]()
        for level, metal in enumerate([*tech.metals, top_metal(pdk).metal]):
            texts = top.shapes(layout.layer(*metal.pin))
            boxes = [shape.bbox() for shape in texts.each() if shape.is_box()]
            for text in (shape for shape in texts.each() if shape.is_text()):
                box = next((box for box in boxes if box.contains(text.text.position())), None)
                if box:
                    found.setdefault(text.text.string, []).append((level, (box.left, box.bottom, box.right, box.top)))
        edges = [shape.bbox() for shape in top.shapes(layout.layer(*tech.outline)).each()]
        if not found or len(edges) != 1:
            raise ParameterError(f"wrapper = {gds.name}: must have an outline, and pins with their names")
        return cls(known[names[0]], edges[0].right, edges[0].top, found)

    def die(self, die: DieParameters) -> DieParameters:
        """Return the parameters of a die in this outline."""
        return replace(die, width_um=self.width / 1000, height_um=self.height / 1000, ring_um=RING_UM)

    def side(self, box: Box) -> str:
        """Side of the outline that a pin is at."""
        left, bottom, right, top = box
        reached = {"west": left <= 0, "east": right >= self.width, "north": top >= self.height, "south": bottom <= 0}
        return next(side for side, there in reached.items() if there)

    def pin(self, name: str) -> tuple[int, Box, str]:
        """Level, box and side of a pin, of its first piece. Raises StepError where the wrapper has none."""
        if name not in self.pins:
            raise StepError(f"wrapper: {self.wrapper.cell} has no pin {name}")
        level, box = self.pins[name][0]
        return level, box, self.side(box)

    def track(self, net: str, side: str, level: int, ends: tuple[int, int]) -> None:
        """Return None: lines end at the bars."""

    def reach(self, net: str, side: str) -> list[tuple[int, int]]:
        """Ends in y of what the bar of a supply meets on a side: its pins, and the way from its constant level."""
        found = [(box[1], box[3]) for box in self._supply(net, side)]
        found += [(y - LINE // 2, y + LINE // 2) for _, of, y, _ in self._lines(side) if of == net]
        return found

    def _supply(self, net: str, side: str) -> list[Box]:
        """Pins of a supply on a side."""
        name = self.wrapper.supplies.get(side, {}).get(net)
        return [box for level, box in self.pins.get(name or "", ()) if level == STUB and self.side(box) == side]

    def _lines(self, side: str) -> Iterator[tuple[int, str, int, list[Box]]]:
        """Of both lines of constant levels on a side: (middle x, net, y of the way to the bar, boxes of the pins)."""
        taken = [box for pieces in self.pins.values() for _, box in pieces if self.side(box) == side]
        y = self.height - CROSS
        for place, (net, names) in enumerate(
            zip(self.wrapper.levels[side], (self.wrapper.low, self.wrapper.high), strict=True)
        ):
            boxes = [box for name in names for level, box, of in [self.pin(name)] if of == side and level == STUB]
            while any(box[1] - CLEAR - LINE < y < box[3] + CLEAR + LINE for box in taken):
                y -= CLEAR
            x = FIRST + place * STEP
            yield (x if side == "west" else self.width - x), net, y, boxes
            y -= 2 * CLEAR

    def branches(
        self, made: Found, routed: Nets, blocks: Mapping[str, Block], *, die: DieParameters, tracks: Tracks
    ) -> Iterator[tuple[str, Branch]]:
        """Pairs (net, Branch) of the signals' pins. Raises StepError for a signal without one.

        In the west and the east the lowest pin has the branch nearest to the edge: its stub meets the fewest trunks.
        """
        nets = [net for net, ends in routed.items() if ("die", net) in ends]
        named = {net: self.pin(self.wrapper.signals[net]) for net in nets if net in self.wrapper.signals}
        west, east, north = (
            sorted((box[1] + box[3], net) for net, (_, box, of) in named.items() if of == side)
            for side in ("west", "east", "north")
        )
        (west_low, west_high), (east_low, east_high) = bar("vdda", "west", die), bar("vdd", "east", die)
        half = tracks.branch_pitch // 2
        columns = {net: west_low + half + k * tracks.branch_pitch for k, (_, net) in enumerate(west)}
        columns |= {net: east_high - half - k * tracks.branch_pitch for k, (_, net) in enumerate([*east, *north])}
        if not all(west_low < x < west_high or east_low < x < east_high for x in columns.values()):
            raise StepError(f"wrapper: no room for the branches of {len(columns)} pins")
        for net, x in columns.items():
            level, box, side = named[net]
            end = (box[1] + box[3]) // 20 * 10
            if side == "north":
                end = self.height - NORTH - NORTH_STEP * [other for _, other in north].index(net)
            yield net, Branch("die", net, x // 10 * 10, end, box, side, level)
        yield from self._spare([net for net in nets if net not in named], made, tracks)

    def _spare(self, nets: Sequence[str], made: Found, tracks: Tracks) -> Iterator[tuple[str, Branch]]:
        """Pairs (net, Branch) of signals without a pin of their own. Raises StepError where no pin is left."""
        taken = [branch.x for found in made.values() for branch in found]
        pins = [pieces[0] for name, pieces in self.pins.items() if name.startswith(self.wrapper.spare)]
        for net in nets:
            middles = (((box[0] + box[2]) // 10 * 5, level, box) for level, box in pins)
            free = (one for one in middles if all(abs(one[0] - other) >= tracks.branch_pitch for other in taken))
            if (found := next(free, None)) is None:
                raise StepError(f"wrapper: no pin {self.wrapper.spare} is free for {net}")
            x, level, box = found
            taken.append(x)
            yield net, Branch("die", net, x, box[3] // 20 * 10, box, "south", level)

    def carried(self, routes: Found) -> dict[str, list[str]]:
        """Pins of the wrapper that each net is on."""
        at = {box: name for name, pieces in self.pins.items() for _, box in pieces}
        found = {net: [at[b.box] for b in one if b.block == "die" and b.box] for net, one in routes.items()}
        for pins in self.wrapper.supplies.values():
            for net, name in pins.items():
                found[net] = sorted({*found.get(net, ()), name})
        for side, levels in self.wrapper.levels.items():
            for net, names in zip(levels, (self.wrapper.low, self.wrapper.high), strict=True):
                found.setdefault(net, []).extend(name for name in names if self.pin(name)[2] == side)
        return {net: names for net, names in found.items() if names}

    def nets(
        self, inner: Mapping[str, Sequence[Terminal]], carried: Mapping[str, Sequence[str]]
    ) -> dict[str, list[Terminal]]:
        """Terminals of the nets; those of the die are the wrapper's pins."""
        return {
            net: [("die", name) for name in carried.get(net, ())] + [end for end in ends if end[0] != "die"]
            for net, ends in inner.items()
        }

    def metal(self, die: DieParameters, rules: RoutingRules, top: TopMetal, routes: Found) -> Shapes:
        """Shapes of supplies' pins, of constant levels, and of the ways to pins in the north."""
        for net in self.wrapper.supplies["north"]:
            low, high = in_north(net, die)
            for left, bottom, right, _ in self._supply(net, "north"):
                yield shapes.drawn(rules.layers[BRANCH], net, (left, low, right, bottom + INTO))
                yield from self._cuts(net, (left, bottom, right, bottom + INTO), rules)
                yield from vias(net, (left, low, right, high), top)
        for side in self.wrapper.levels:
            for net in SUPPLIES:
                for box in self._supply(net, side):
                    yield from self._to_bar(net, side, box, die, rules)
            for x, net, y, boxes in self._lines(side):
                ys = [y, *((box[1] + box[3]) // 2 for box in boxes)]
                line = x - LINE // 2, min(ys) - LINE // 2, x + LINE // 2, max(ys) + LINE // 2
                yield shapes.drawn(rules.layers[BRANCH], net, line)
                for left, low, right, high in boxes:
                    ends = (left, x + LINE // 2) if side == "west" else (x - LINE // 2, right)
                    yield shapes.drawn(rules.layers[STUB], net, (ends[0], low, ends[1], high))
                    yield from shapes.via(net, x, (low + high) // 20 * 10, STUB, rules)
                way = x - LINE // 2, y - LINE // 2, x + LINE // 2, y + LINE // 2
                yield from self._to_bar(net, side, way, die, rules)
                yield from self._cuts(net, way, rules)
        for net, branches in routes.items():
            for branch in branches:
                if branch.block == "die" and branch.side == "north" and branch.box:
                    yield from self._drop(net, branch, rules, top)

    def _to_bar(self, net: str, side: str, box: Box, die: DieParameters, rules: RoutingRules) -> Shapes:
        """Metal from a box at the edge to the far end of a bar, and vias."""
        low, high = bar(net, side, die)
        yield shapes.drawn(rules.layers[STUB], net, (min(box[0], low), box[1], max(box[2], high), box[3]))
        yield from self._cuts(net, (low, box[1], high, box[3]), rules)

    def _cuts(self, net: str, box: Box, rules: RoutingRules) -> Shapes:
        """As many vias between stubs and branches as fit into ``box``."""
        via = rules.vias[STUB]
        rooms = (max(via.below[0], via.above[0]) - via.size // 2, max(via.below[1], via.above[1]) - via.size // 2)
        yield from shapes.cuts(net, box, via, via.size, via.space, rooms)

    def _drop(self, net: str, branch: Branch, rules: RoutingRules, top: TopMetal) -> Shapes:
        """From the end of a branch a way on the stubs' metal below a pin in the north, and up into its pieces."""
        pieces = next(pieces for pieces in self.pins.values() if (branch.level, branch.box) in pieces)
        boxes = [box for level, box in pieces if level == branch.level]
        y, via = branch.end, rules.vias[STUB]
        wide, pad = max(via.below[1], via.above[1], rules.layers[STUB].width // 2), via.below[0]
        drops = [((box[0] + box[2]) // 20 * 10, box[1]) for box in boxes]
        lefts, rights = ([x + way * DROP for x, _ in drops] + [branch.x + way * pad] for way in (-1, 1))
        yield shapes.drawn(rules.layers[STUB], net, (min(lefts), y - wide, max(rights), y + wide))
        yield from shapes.stack(net, branch.x, y, rules)
        for x, bottom in drops:
            yield shapes.drawn(rules.layers[BRANCH], net, (x - DROP, y - wide, x + DROP, bottom + INTO))
            yield from self._cuts(net, (x - DROP, y - wide, x + DROP, y + wide), rules)
            yield from self._cuts(net, (x - DROP, bottom, x + DROP, bottom + INTO), rules)
            if any(level > BRANCH for level, _ in pieces):  # the pin is on the top metal, too
                yield from vias(net, (x - DROP, bottom, x + DROP, bottom + INTO), top)

    def verilog(self, name: str, blocks: Mapping[str, Block], nets: Nets, carried: Mapping[str, Sequence[str]]) -> str:
        """Text of the wrapper's module, with one of the blocks in it; supplies are left out."""
        w, inner = self.wrapper, f"{name}_{INSIDE}"
        outer = {bus: bits for bus, bits in buses(self.pins).items() if not bus.startswith(w.power)}
        ports = buses(net for net, ends in nets.items() if ("die", net) in ends and net not in SUPPLIES)

        def way(bus: str) -> str:
            return "output" if bus.startswith(w.outputs) else "inout" if bus.startswith(w.inouts) else "input"

        def pins(bus: str, bits: int | None) -> str:
            names = [bus] if bits is None else [f"{bus}[{k}]" for k in reversed(range(bits))]
            return f"{{{', '.join(carried[net][0] for net in names)}}}"

        lines = [f"module {w.cell} ({', '.join(outer)});"]
        lines += [f"  {way(bus)} {'' if bits is None else f'[{bits - 1}:0] '}{bus};" for bus, bits in outer.items()]
        lines += [f"  assign {pin} = 1'b{level};" for level, names in enumerate((w.low, w.high)) for pin in names]
        lines.append(f"  {inner} {INSIDE} (")
        lines.append(",\n".join(f"    .{bus}({pins(bus, bits)})" for bus, bits in ports.items()))
        return "\n".join([inside(inner, blocks, nets), *lines, "  );", "endmodule", ""])

    def table(self, carried: Mapping[str, Sequence[str]]) -> str:
        """The pin map as Markdown."""
        rows = [f"| {pin} | {net} |" for net, names in carried.items() for pin in names]
        head = [
            f"# Pin map: {self.wrapper.name}, `{self.wrapper.cell}`",
            "",
            "| pin | net of the sensor |",
            "|---|---|",
        ]
        return "\n".join([*head, *sorted(rows, key=_natural), ""])


def check_wrapper(gds: Path, pdk: str) -> None:
    """Raise ParameterError for a file that is not a wrapper whose pins are known."""
    if not gds.is_file():
        raise ParameterError(f"wrapper = {gds}: no such file")
    try:
        Surround.read(gds, pdk)
    except RuntimeError as error:
        raise ParameterError(f"wrapper = {gds}: must be GDS: {error}") from None


def _natural(row: str) -> list[Any]:
    """Sort key with numbers as such."""
    return [int(part) if part.isdigit() else part for part in re.split(r"(\d+)", row)]
