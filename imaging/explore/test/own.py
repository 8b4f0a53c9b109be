"""Error of a formula: nothing is simulated, so that the search itself is tested."""

import os
import time
from pathlib import Path

import numpy as np

from talbot.imaging.explore.task import Outcome
from talbot.models.parameters import ParameterError

SPACE = {"array.rows": [24, 36, 48], "chip.lanes": [1, 2, 4, 8], "threshold": (2, 40), "gain": (0.5, 2.0)}
FIGURES = ("sharpness",)
THESIS = {"array.rows": 48, "chip.lanes": 8, "threshold": 10, "gain": 1.0}


def evaluate(point, fidelity, seed):
    """Return a formula of the point. What a file of the folder TROUBLE says happens at one threshold."""
    trouble(point.settings["threshold"])
    rows, lanes = point.sensor.array.rows, point.sensor.chip.lanes
    threshold, gain = point.settings["threshold"], point.settings["gain"]
    error = abs(threshold - 17) / 40 + 4 / rows + 0.1 * (fidelity.name == "small") + 0.01 * seed
    figures = {"error": error, "energy_uj": rows * gain + lanes, "bytes": rows * rows / threshold}
    figures |= {"frames_per_s": 100.0 * lanes, "sharpness": gain}
    return Outcome(figures, np.full((8, 8), threshold, float))


def trouble(threshold):
    """Raise, die, hang or refuse, as the file TROUBLE/<threshold> says."""
    folder = os.environ.get("TROUBLE")
    file = Path(folder) / str(threshold) if folder else None
    if folder:
        with (Path(folder) / "log").open("a") as log:
            log.write(f"{threshold}\n")
    if file is None or not file.exists():
        return
    kind = file.read_text()
    if kind.startswith("once "):
        file.unlink()
        kind = kind.removeprefix("once ")
    if kind == "die":
        os._exit(9)
    if kind == "hang":
        time.sleep(600)
    if kind == "refuse":
        raise ParameterError(f"threshold = {threshold}: must be another")
    raise RuntimeError(f"trouble at {threshold}")
