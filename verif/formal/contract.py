"""The interface contract of docs/chip.md at run time: every assumption, in every cycle of whole frames of the chip.

The chip runs in PyMTL on the bench of its tests. What enters a block there enters the wrapper of its proof, simulated
by Verilator: its assumptions are checked with their own text, and its properties with them.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from operator import attrgetter
from typing import Any

from pymtl3 import Component, InPort, is_bitstruct_class

from talbot.rtl.asp_chip.test.chip_bench import ChipBench
from talbot.verif.formal import design, manifest, replay
from talbot.verif.formal.proof import Proof

FRONT = {  # input of front.sv -> where it is in the chip
    **{name: name for name in ("reset", "sclk", "csn", "mosi", "link_rdy")},
    "frame_msg": "encoder.send.msg",
    "frame_val": "encoder.send.val",
    "frame_sync": "encoder.frame_sync",
    "seq_busy": "seq.busy",
    "seq_err": "seq.cfg_err",
    "amp_start": "seq.amp_start",
    "amp_err": "amp.cfg_err",
}
BLOCKS = {  # proof -> the block in the chip, '' for the chip itself
    "asp_chip_front": "",
    "readout_seq_7x31_2": "seq",
    "reset_pointer_7x31_2": "seq",
    "adc_bank": "bank",
    "edge_adc": "bank.lane0",
    "phase_path": "phase",
    "byte_queue": "encoder.queue",
    "payload": "encoder.packer",
}


@dataclass
class Recorder:
    """The inputs of the blocks of a chip, cycle by cycle. sensor: rows, cols, lanes of the chip."""

    sensor: Mapping[str, int]
    cycles: dict[str, list[dict[str, int]]] = field(default_factory=dict)
    read: dict[str, Callable[[], dict[str, int]]] = field(default_factory=dict)

    def connect(self, chip: Component) -> None:
        """Look up the inputs of every block of an elaborated chip."""
        for name, place in BLOCKS.items():
            self.cycles[name] = []
            pins = _inputs(chip, attrgetter(place)(chip)) if place else FRONT
            self.read[name] = _reader(chip, pins)

    def sample(self) -> None:
        """Record one cycle, in which every signal has settled."""
        for name, read in self.read.items():
            self.cycles[name].append(read())

    def violations(self) -> Iterator[str]:
        """Yield 'proof: label in cycle n' for each assumption and property that does not hold in the chip."""
        for proof in manifest.every():
            if proof.name in BLOCKS:
                for number, row in enumerate(self.rows(proof)):
                    yield from (f"{proof.name}: {label} in cycle {number}" for label in row)

    def rows(self, proof: Proof) -> list[list[str]]:
        """Return the violated labels of a proof in each cycle, at the size of the chip."""
        lanes = {"LANES": self.sensor["lanes"]} if "LANES" in proof.defines else {}
        proof = replace(proof, sensor=dict(self.sensor), defines=proof.defines | lanes)
        return replay.violations(proof, design.exported(proof), design.wrapper(proof), self.cycles[proof.name], {})


class RecordingBench(ChipBench):
    """ChipBench that records the inputs of the chip's blocks."""

    def __init__(self, sim: Component, recorder: Recorder, **options: Any) -> None:
        recorder.connect(sim)
        self.recorder = recorder
        super().__init__(sim, recorder.sensor["lanes"], **options)

    def reset(self) -> None:
        """Reset the chip for four cycles, which the synchronizer of its release takes."""
        self.sim.reset @= 1
        for _ in range(4):
            self.tick()
        self.sim.reset @= 0

    def watch(self) -> None:
        """Record, after the checks of the bench."""
        super().watch()
        self.recorder.sample()


def _inputs(chip: Component, block: Component) -> dict[str, str]:
    """Return the inputs of a block of the chip: name in the Verilog -> path in the chip."""
    pins = {}
    for signal in chip.get_all_object_filter(lambda x: isinstance(x, InPort)):
        if signal.get_host_component() is block and signal.is_top_level_signal():
            path, kind = repr(signal).removeprefix("s."), signal._dsl.Type
            name = path.removeprefix(repr(block).removeprefix("s.") + ".").replace(".", "__")
            pins[name] = f"{path}.to_bits()" if is_bitstruct_class(kind) else path
    return pins


def _reader(chip: Component, pins: Mapping[str, str]) -> Callable[[], dict[str, int]]:
    """Return a function that reads ``pins`` (name -> path) of a chip."""
    items = ", ".join(f"{name!r}: int(chip.{path})" for name, path in pins.items())
    return eval(f"lambda: {{{items}}}", {"chip": chip})
