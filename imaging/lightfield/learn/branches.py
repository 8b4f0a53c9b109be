"""Training of the two-branch network of `models.reconstruct.branches` by PyTorch: each branch alone, then together."""

import importlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np
import numpy.typing as npt
from numpy.lib.stride_tricks import sliding_window_view

from talbot.base.progress import each
from talbot.base.tools import ToolError
from talbot.imaging.lightfield.learn.samples import Shot, noisy, sensor, shots
from talbot.models.pixel.weights import view_weights
from talbot.models.reconstruct.branches import AFTER, CHANNELS, DENSE, KINDS, NOISE, PATCH, VIEWS, Seen, shapes

PATCHES = 6  # of a crop, along each side
RATE = 2e-3  # of Adam, falling to 0 as a cosine
# Of the steps, and crops at each. dense: the autoencoder's layers before its convolutions, which cost ten times as much
SHARES = {"dense": 0.9, "autoencoder": 0.03, "convolutions": 0.05, "both": 0.02}
BATCH = {"dense": 16, "autoencoder": 4, "convolutions": 4, "both": 4}
LAST = 0.1  # scale of the last layers at the start: the sum image as it is
Weights = Mapping[str, Any]


def torch() -> Any:
    """Return the module of PyTorch, which only this training needs. Raises ToolError where it is not installed."""
    try:
        return importlib.import_module("torch")
    except ImportError as error:
        raise ToolError("torch is not installed (needed for training): pip install 'talbot[nn]'") from error


def dense(weights: Weights, patches: Any) -> Any:
    """Return the dense layers' correction of each patch: from (..., 163) to (..., 2025)."""
    nn = torch().nn.functional
    for number in range(len(DENSE) - 1):
        patches = nn.linear(patches, weights[f"dense_{number}"], weights[f"dense_{number}_bias"])
        patches = nn.relu(patches) if number < len(DENSE) - 2 else patches
    return patches


def encoded(weights: Weights, patches: Any) -> Any:
    """Return the autoencoder's correction: from (n, PATCHES, PATCHES, 163) to (n, 1, 5, 5, rows, cols)."""
    nn, pt = torch().nn.functional, torch()
    values = dense(weights, patches).reshape(*patches.shape[:3], VIEWS**2, PATCH, PATCH)
    tile = sensor().tile
    rows, cols = (PATCH + (PATCHES - 1) * period for period in (tile.rows, tile.cols))
    out, count = pt.zeros(len(values), VIEWS**2, rows, cols), pt.zeros(rows, cols)
    for i, j in np.ndindex(PATCHES, PATCHES):
        at = slice(i * tile.rows, i * tile.rows + PATCH), slice(j * tile.cols, j * tile.cols + PATCH)
        out[:, :, *at] += values[:, i, j]
        count[at] += 1
    out = (out / count).reshape(len(out), 1, VIEWS, VIEWS, rows, cols)
    return out + convolved(weights, nn.relu(convolved(weights, out, "after_0")), f"after_{len(AFTER) - 2}")


def convolved(weights: Weights, values: Any, name: str) -> Any:
    """Return a 4-D convolution of (n, channels, 5, 5, rows, cols)."""
    nn, kernel = torch().nn.functional, weights[name]
    rows, cols = values.shape[-2:]
    near = nn.pad(values.flatten(4), (0, 0, 1, 1, 1, 1)).unfold(2, 3, 1).unfold(3, 3, 1)  # (n, c, 5, 5, px, 3, 3)
    near = near.permute(0, 2, 3, 1, 5, 6, 4).reshape(-1, 9 * values.shape[1], rows, cols)
    flat = kernel.reshape(len(kernel), -1, 3, 3)
    values_out = nn.conv2d(near, flat, weights[f"{name}_bias"], padding=1)
    return values_out.reshape(-1, VIEWS, VIEWS, len(kernel), rows, cols).permute(0, 3, 1, 2, 4, 5)


def turned(weights: Weights, back: Any) -> Any:
    """Return the other branch's correction: from (n, 3, 5, 5, rows, cols) to (n, 1, 5, 5, rows, cols)."""
    last = len(CHANNELS) - 2
    for number in range(last):
        back = torch().nn.functional.relu(convolved(weights, back, f"conv_{number}"))
    return convolved(weights, back, f"conv_{last}")


def forward(weights: Weights, kind: str, patches: Any, back: Any) -> Any:
    """Return what is added to the sum image, (n, 25, rows, cols); by dense layers (n, 25, PATCHES**2 * rows, cols)."""
    if kind == "dense":
        patches_out = dense(weights, patches).reshape(len(patches), PATCHES**2, VIEWS**2, PATCH, PATCH)
        return patches_out.transpose(1, 2).flatten(2, 3)
    parts = [encoded(weights, patches)] if kind != "convolutions" else []
    parts += [turned(weights, back)] if kind != "autoencoder" else []
    return torch().stack(parts).mean(0).flatten(1, 3)


def importance() -> npt.NDArray[np.float32]:
    """Weight of each view's error, (25, 1, 1): more towards the rim [Jayasuriya2017, Eq. 3.8]."""
    away = np.abs(np.arange(VIEWS) - VIEWS // 2)
    return np.sqrt(1 + away[:, None] + away).reshape(-1, 1, 1).astype(np.float32)


def crop(shot: Shot, kind: str, rng: np.random.Generator) -> tuple[npt.NDArray[np.float32], ...]:
    """Return patches, back-projection and target of `forward` for a noisy crop that begins with a tile."""
    tile = sensor().tile
    firsts = [np.arange(PATCHES) * period for period in (tile.rows, tile.cols)]
    at = []
    for length, period, first in zip(shot.pair.shape[1:], (tile.rows, tile.cols), firsts, strict=True):
        high = int(first[-1]) + PATCH
        start = period * int(rng.integers(0, (length - high) // period + 1))
        at.append(slice(start, start + high))
    noise = float(np.exp(rng.uniform(*np.log(NOISE))))
    seen = Seen(noisy(shot.pair[:, *at], noise, rng), sensor(), noise)
    truth = shot.truth[:, :, *at].reshape(VIEWS**2, *seen.total.shape)
    reached = np.asarray(truth.any((1, 2)))[:, None, None]
    target = ((truth - seen.total) * reached).astype(np.float32)
    patches = seen.patches(*firsts).reshape(PATCHES, PATCHES, -1)
    if kind == "dense":
        windows = sliding_window_view(target, (PATCH, PATCH), (1, 2))[:, firsts[0][:, None], firsts[1]]
        return patches, np.zeros(0, np.float32), windows.reshape(VIEWS**2, -1, PATCH)
    return patches, seen.back.astype(np.float32), target


@dataclass(frozen=True, eq=False)
class Learned:
    """Weights of the network and of each branch alone, and how they were learned."""

    weights: dict[str, npt.NDArray[np.float16]]
    summary: dict[str, Any]

    @property
    def text(self) -> str:
        """Their figures in a line."""
        s = self.summary
        errors = ", ".join(f"{kind} {s['error'][kind]:.3f}" for kind in KINDS)
        return f"{s['parameters']} weights in {s['seconds']:.0f} s; of the sum image's mean square error: {errors}"

    def save(self, path: Path) -> None:
        """Write the weights."""
        np.savez_compressed(path, **self.weights)  # type: ignore[arg-type]


def learned(seeds: Sequence[int], steps: int, seed: int) -> Learned:
    """Weights from scenes of ``seeds`` in ``steps`` in all. Raises ToolError without PyTorch."""
    pt, rng, start = torch(), np.random.default_rng(seed), perf_counter()
    pt.manual_seed(seed)
    taken = list(each(shots(seeds), "scenes", total=len(seeds)))
    chip, arrays, error = sensor(), {}, {}
    weights = {kind: _first(kind, pt) for kind in KINDS[:2]}
    weights["dense"] = {name: value for name, value in weights["autoencoder"].items() if name.startswith("dense")}
    for kind, share in SHARES.items():
        if kind == "both":
            weights[kind] = {
                name: value.detach().clone().requires_grad_()
                for part in KINDS[:2]
                for name, value in weights[part].items()
            }
        error[kind] = _train(weights[kind], kind, taken, max(round(share * steps), 1), rng)
        if kind in KINDS:
            arrays |= {f"{kind}/{n}": value.detach().numpy().astype(np.float16) for n, value in weights[kind].items()}
    arrays["phi"] = view_weights(chip.tile, chip.optics).astype(np.float16)
    count = sum(value.size for key, value in arrays.items() if key.startswith("both/"))
    summary = {"scenes": len(seeds), "first_scene": seeds[0], "steps": steps, "shares": SHARES, "seed": seed}
    return Learned(arrays, summary | {"parameters": count, "seconds": perf_counter() - start, "error": error})


def _first(kind: str, pt: Any) -> dict[str, Any]:
    """Random weights of one branch."""
    out = {}
    for name, shape in shapes().items():
        if name.startswith("conv") != (kind == "convolutions"):
            continue
        last = name.startswith((f"conv_{len(CHANNELS) - 2}", f"after_{len(AFTER) - 2}", f"dense_{len(DENSE) - 2}"))
        size = (2 / np.prod(shape[1:])) ** 0.5 * (LAST if last else 1)
        out[name] = (0 * pt.randn(shape) if name.endswith("bias") else size * pt.randn(shape)).requires_grad_()
    return out


def _train(weights: Weights, kind: str, taken: Sequence[Shot], steps: int, rng: np.random.Generator) -> float:
    """Train in place; returns the last tenth's mean square error over that of the sum image."""
    pt, weight, losses = torch(), importance(), []
    optimizer = pt.optim.Adam(weights.values(), RATE / 2 if kind == "both" else RATE)
    schedule = pt.optim.lr_scheduler.CosineAnnealingLR(optimizer, steps)
    for _ in each(range(steps), kind, total=steps):
        crops = [crop(taken[number], kind, rng) for number in rng.integers(len(taken), size=BATCH[kind])]
        patches, back, target = (pt.from_numpy(np.stack(part)) for part in zip(*crops, strict=True))
        missed = forward(weights, kind, patches, back) - target
        loss = (missed**2 * pt.from_numpy(weight)).mean()
        optimizer.zero_grad()
        loss.backward()
        optimizer.step()
        schedule.step()
        reached = (target != 0).any(3, keepdim=True).any(2, keepdim=True)
        losses.append(((missed * reached) ** 2).sum().item() / (target**2).sum().item())
    return float(np.mean(losses[-max(len(losses) // 10, 1) :]))
