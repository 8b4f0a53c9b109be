"""The measured frames evaluated: the fit, its residuals, the held-back frame, and what glitches add."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from talbot.flow.layout.energy.fit import Fit, fit
from talbot.flow.layout.energy.frames import EnergyFrame
from talbot.models.parameters.energy import DigitalEvents

WORST = 0.1  # share by which the held-back frame may be off


@dataclass(frozen=True)
class Frame:
    """A measured frame. pj: of the part while the chip is busy; run_pj, run_cycles: of the whole run, SPI too.

    by_block: pJ, of that part. host_pj_cycle: while a host writes the configuration.
    """

    name: str
    varies: str
    events: DigitalEvents
    pj: float
    by_block: Mapping[str, float]
    run_pj: float
    run_cycles: int
    host_pj_cycle: float

    @classmethod
    def of(cls, frame: EnergyFrame, counted: Mapping[str, Any], measured: Mapping[str, Any]) -> "Frame":
        """From the metrics of `Transitions`, and what `Measure` has of the frame."""
        pj, cycles = measured["pj"], counted["cycles"]
        own = DigitalEvents(**counted["events"]), pj["frame"], measured["by_block"]
        run = sum(pj.values()), sum(cycles.values()), pj["host"] / cycles["host"]
        return cls(frame.name, frame.varies, *own, *run)

    def row(self, found: Fit, left_out: float | None = None) -> dict[str, Any]:
        """What it took beside what ``found`` says. residual, left_out: shares."""
        said = found.predict(self.events)
        return {
            "name": self.name,
            "varies": self.varies,
            "events": self.events._asdict(),
            "pj": self.pj,
            "pj_cycle": round(self.pj / self.events.cycles, 4),
            "predicted_pj": round(said, 3),
            "residual": round(said / self.pj - 1, 5),
            "left_out": None if left_out is None else round(left_out, 5),
            "by_block": dict(self.by_block),
        }


def evaluate(fitted: Sequence[Frame], held_back: Frame, recorded: Frame, delayed: Mapping[str, Any]) -> dict[str, Any]:
    """Fit the frames ``fitted`` and predict the others.

    recorded: the frame that was also simulated with delays, ``delayed``: the record of that power. glitches: energy a
    cycle of that, leakage taken off, over that of ``recorded``, both with SPI.
    """
    found = fit([frame.events for frame in fitted], [frame.pj for frame in fitted])
    period, metrics = delayed["parameters"]["period_ns"], delayed["metrics"]
    switched = metrics["energy_pj_cycle"] - metrics["by_kind"]["leakage"] * period / 1000
    settled = recorded.run_pj / recorded.run_cycles
    return {
        "pj": found.pj,
        "host_pj_cycle": round(recorded.host_pj_cycle, 4),
        "frames": [frame.row(found, off) for frame, off in zip(fitted, found.left_out, strict=True)],
        "held_back": held_back.row(found),
        "recorded": recorded.row(found),
        "glitches": {"pj_cycle": round(switched, 4), "settled_pj_cycle": round(settled, 4)}
        | {"ratio": round(switched / settled, 4)},
    }
