"""A block of Coriolis with power straps: pins, then the clock trunk, then straps beside both, then the cells."""

import time
from collections.abc import Callable, Sequence
from typing import Any

from coriolis.helpers import u
from coriolis.Hurricane import Box
from coriolis.plugins.block.block import Block
from coriolis.plugins.block.configuration import BlockConf, IoPin

from talbot.flow.layout.netlist.names import CLOCK

from .leaves import balance
from .macros import fix_macros
from .straps import PIN_CLEARANCE_UM, Strap, Straps

SIDES = {"west": IoPin.WEST, "east": IoPin.EAST, "south": IoPin.SOUTH, "north": IoPin.NORTH}


def make_block(cell: Any, request: dict[str, Any]) -> "TalbotBlock":
    """Configure the TalbotBlock of ``cell`` by ``request``."""
    conf: Any = BlockConf(cell, ioPins=[])
    conf.coreSize = u(request["width_um"]), u(request["height_um"])
    cfg = conf.cfg
    cfg.etesian.bloat = "disabled"
    cfg.etesian.uniformDensity = True
    cfg.etesian.densityVariation = 0.05
    cfg.etesian.aspectRatio = 1.0
    # One of the diodes that Coriolis adds against antennas stays open; the antenna step checks the result
    cfg.etesian.antennaGateMaxWL = u(40000.0)
    cfg.etesian.antennaDiodeMaxWL = u(80000.0)
    cfg.anabatic.topRoutingLayer = request["metals"][-1]["name"]
    cfg.block.spareSide = u(request["leaf_um"])
    conf.useSpares = conf.useClockTree = request["clock_tree"]
    conf.useHFNS = False
    conf.bColumns = conf.bRows = 2
    if request["clock_tree"]:
        conf.useHTree(CLOCK)
    fix_macros(cell, request)
    return TalbotBlock(conf, request)


class TalbotBlock(Block):
    """A block with straps. times: seconds of the phases; straps, pins: where they are."""

    def __init__(self, conf: Any, request: dict[str, Any]) -> None:
        super().__init__(conf)
        self.request = request
        self.times: dict[str, float] = {}
        self.straps: list[Strap] = []
        self.pins: list[list[Any]] = []
        self.power = Straps(conf.cell, request)
        self.setUnexpandPins(IoPin.WEST | IoPin.EAST | IoPin.SOUTH | IoPin.NORTH)  # else some come off their segments

    def _timed(self, phase: str, call: Callable[[], Any]) -> Any:
        begin = time.perf_counter()
        result = call()
        self.times[phase] = time.perf_counter() - begin
        return result

    def placeIoPins(self) -> None:
        """Spread the pins over the tracks of their sides, unless their places are given."""
        self.pins += self.request["places"]
        for side, nets in {} if self.pins else self.request["pins"].items():
            self.pins += spread(side, nets, self.request, [x for _, x, _ in self.power.even()])
        self.conf.ioPins = [IoPin(SIDES[side], net, u(at), 0, 1) for side, net, at in self.pins]
        super().placeIoPins()
        self.conf.placeArea = Box(*map(u, self.request["tree"]))  # of the clock tree, which is built next

    def addHTrees(self) -> None:
        """Build the clock tree, then place the straps beside its trunk.

        Sinks beyond the tree's area hang from its leaves too, except macros: these have a tree of their own and hang
        from the root. Ports whose places are given are outside of the core.
        """
        self.conf.placeArea = None
        macros = {macro["name"] for macro in self.request["macros"]}
        tree: Any = self.spares.quadTree
        if tree:
            tree.isUnderArea = lambda plug: plug.getEntity().getInstance().getMasterCell().getName() not in macros
            balance(tree)
        self._timed("clock_tree", super().addHTrees)
        beside = [] if self.request["places"] else [at for side, _, at in self.pins if side in ("north", "south")]
        self.straps = self.power.positions(beside)

    def place(self) -> None:
        """Place the cells."""
        self._timed("placement", super().place)

    def route(self) -> bool:
        """Draw the straps, and no more: Coriolis's router is not used, since it opens what `route` closes."""
        self._timed("power", self.power.create)
        return True


def spread(side: str, nets: Sequence[str], request: dict[str, Any], straps: Sequence[float]) -> list[list[Any]]:
    """[side, net, offset_um] of the pins on one side, evenly on tracks and clear of the straps at x in ``straps``."""
    across = side in ("west", "east")
    length = request["height_um" if across else "width_um"]
    pitch = request["pin_pitch_um"]["horizontal" if across else "vertical"]
    tracks = range(6, int(length / pitch) - 6)
    tracks = [k for k in tracks if across or all(abs(k * pitch - x) >= PIN_CLEARANCE_UM for x in straps)][::2]
    if len(nets) > len(tracks):
        raise SystemExit(f"coriolis: {len(nets)} pins do not fit on the {side} side of {length:.1f} um")
    step = len(tracks) / max(1, len(nets))
    return [[side, net, round(pitch * tracks[int((i + 0.5) * step)], 3)] for i, net in enumerate(nets)]
