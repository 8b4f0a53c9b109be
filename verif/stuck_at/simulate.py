"""Fault simulation of a netlist by simulate.c, 512 faults at a time."""

import ctypes
import tempfile
from collections.abc import Sequence
from functools import cache
from pathlib import Path

import numpy as np
import numpy.typing as npt

from talbot.base.tools import run
from talbot.verif.stuck_at.faults import OUTPUT, Fault
from talbot.verif.stuck_at.netlist import ONE, Gates

WORDS = 8
LANES = 64 * WORDS
ALL = ~np.uint64(0)


@cache
def library() -> ctypes.CDLL:
    """Return the compiled simulate.c. Raises ToolError."""
    source = Path(__file__).with_suffix(".c")
    with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
        out = Path(folder) / "simulate.so"
        run(["gcc", "-O3", "-march=native", "-Wno-psabi", "-shared", "-fPIC", "-o", out, source])
        return ctypes.CDLL(str(out))


class Simulator:
    """The netlist and a test. stimulus: bool (cycles, input bits), in the order of ``gates.inputs`` without clk.

    settled: cycles, at the beginning, in which outputs are not compared. Registers start at random values.
    """

    def __init__(self, gates: Gates, stimulus: npt.NDArray[np.bool_], settled: int, seed: int) -> None:
        self.gates, self.stimulus, self.settled = gates, np.ascontiguousarray(stimulus, np.uint8), settled
        self.inputs = np.array([n for name, nets in gates.inputs.items() if name != "clk" for n in nets], np.int32)
        self.outputs = np.array([n for nets in gates.outputs.values() for n in nets], np.int32)
        flip_flops = gates.out[gates.gates :]
        self.start = np.zeros((gates.nets, WORDS), np.uint64)
        self.start[ONE] = ALL
        high = np.random.default_rng(seed).random(len(flip_flops)) < 0.5
        self.start[flip_flops] = np.where(high, ALL, np.uint64(0))[:, None]
        self.good = np.zeros((len(stimulus), len(self.outputs)), np.uint8)
        self._simulate((), len(stimulus), len(stimulus))

    def output(self, name: str) -> npt.NDArray[np.int64]:
        """Return the values of an output without a fault, cycle by cycle."""
        names = [port for port, nets in self.gates.outputs.items() for _ in nets]
        values = self.good[:, [i for i, port in enumerate(names) if port == name]]
        return values @ (1 << np.arange(values.shape[1]))

    def detected(self, faults: Sequence[Fault]) -> npt.NDArray[np.bool_]:
        """Return which faults make an output differ. Only faults not detected early get the whole test."""
        differs = np.zeros(len(faults), np.bool_)
        for cycles in (len(self.stimulus) // 4, len(self.stimulus)):
            remaining = np.flatnonzero(~differs)
            for at in range(0, len(remaining), LANES):
                chosen = remaining[at : at + LANES]
                differs[chosen] = self._simulate([faults[i] for i in chosen], cycles, self.settled)[: len(chosen)]
        return differs

    def _simulate(self, faults: Sequence[Fault], cycles: int, compare_from: int) -> npt.NDArray[np.bool_]:
        """Simulate one group. Bits without a fault count as detected, so the group ends with its last fault."""
        gates = self.gates
        sites = sorted({fault.gate for fault in faults})
        site = np.full(len(gates.names), -1, np.int32)
        site[sites] = np.arange(len(sites))
        stuck = np.zeros((len(sites) + 1, OUTPUT + 1, 2, WORDS), np.uint64)
        for lane, fault in enumerate(faults):
            stuck[site[fault.gate], fault.pin, fault.value, lane // 64] |= np.uint64(1 << lane % 64)
        values = self.start.copy()
        for place, gate in enumerate(sites):
            if gate >= gates.gates:  # a flip-flop's output is stuck before the first edge
                low, high = stuck[place, OUTPUT]
                values[gates.out[gate]] = values[gates.out[gate]] & ~low | high
        table = np.column_stack((gates.kinds, gates.ins, gates.out, site)).astype(np.int32)
        differs = np.packbits(np.arange(LANES) >= max(1, len(faults)), bitorder="little").view(np.uint64)
        room = np.zeros((len(gates.names) - gates.gates, WORDS), np.uint64)
        sizes = len(gates.names), cycles, len(self.inputs), len(self.outputs)
        total, length, n_in, n_out = map(ctypes.c_int64, sizes)
        library().simulate(
            *(table.ctypes, ctypes.c_int64(gates.gates), total, values.ctypes, stuck.ctypes),
            *(self.stimulus.ctypes, length, self.inputs.ctypes, n_in, self.outputs.ctypes, n_out),
            *(self.good.ctypes, ctypes.c_int64(compare_from), room.ctypes, differs.ctypes),
        )
        return np.unpackbits(differs.view(np.uint8), bitorder="little").astype(np.bool_)
