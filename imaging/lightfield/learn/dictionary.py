"""The dictionary of sparse coding, learned from patches of dead leaves and of slanted planes of them."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from talbot.base.progress import each
from talbot.imaging.lightfield.learn.samples import light_fields
from talbot.models.reconstruct.sparse import Dictionary, learn

PATCH = 9, 9  # px, as the thesis's
PATCHES = 800  # of a scene
PENALTY = 0.05  # of the codes while it is learned
BATCH = 2048


@dataclass(frozen=True, eq=False)
class Learned:
    """A dictionary, and how it was learned."""

    dictionary: Dictionary
    summary: dict[str, Any]

    @property
    def text(self) -> str:
        """Figures in a line."""
        s = self.summary
        return f"{s['atoms']} atoms leave {s['error']:.4f} RMS of patches whose own is {s['rms']:.4f}"

    def save(self, path: Path) -> None:
        """Write the dictionary."""
        self.dictionary.save(path)


def learned(seeds: Sequence[int], atoms: int, rounds: int, seed: int) -> Learned:
    """Return a dictionary of ``atoms`` from scenes of ``seeds``, learned in ``rounds`` batches."""
    rng, parts = np.random.default_rng(seed), []
    for field in each(light_fields(seeds), "scenes", total=len(seeds)):
        windows = sliding_window_view(field.astype(np.float32), PATCH, (2, 3))
        y, x = rng.integers(0, windows.shape[2:4], (PATCHES, 2)).T
        parts.append(windows[:, :, y, x].transpose(2, 0, 1, 3, 4))
    patches = np.concatenate(parts)
    flat = patches.reshape(len(patches), -1)
    *errors, last = each(learn(flat, atoms, PENALTY, rounds, seed, BATCH), "batches", total=rounds)
    words, sizes, error = last
    summary = {"atoms": atoms, "scenes": len(seeds), "first_scene": seeds[0], "rounds": rounds, "seed": seed}
    level = flat - flat.mean(1, keepdims=True)
    figures = {
        "error": error,
        "errors": [*(part[2] for part in errors), error],
        "rms": float(np.sqrt((level**2).mean())),
    }
    return Learned(Dictionary(words.reshape(atoms, *patches.shape[1:]), sizes), summary | figures)
