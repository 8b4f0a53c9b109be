"""Training of the network of `models.reconstruct.network` by PyTorch, which nothing else needs."""

import importlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from talbot.base.progress import each
from talbot.base.tools import ToolError
from talbot.models.reconstruct.network import LAYERS, VIEWS

from .samples import NOISES, Lesson, lessons

CROP = 40  # px, of a lesson at a step
BATCH = 8
RATE = 2e-3  # of Adam, falling to 0 as a cosine
LAST = 0.1  # scale of the last layer at the start: the mixture as it is


def torch() -> Any:
    """PyTorch; ToolError where it is not installed."""
    try:
        return importlib.import_module("torch")
    except ImportError as error:
        raise ToolError("torch = not installed: must be, to learn (pip install 'talbot[nn]')") from error


def forward(weights: Mapping[str, Any], seen: Any) -> Any:
    """The network on a batch of tensors (n, 54, rows, cols), as `Network` has it in NumPy."""
    nn = torch().nn.functional

    def layers(values: Any, *names: str) -> Any:
        for name in names:
            values = nn.conv2d(values, weights[name], weights[f"{name}_bias"], padding=1)
            values = values if name == "full_4" else nn.relu(values)
        return values

    full = layers(seen, "full_1", "full_2")
    half = layers(nn.avg_pool2d(full, 2), "half_1", "half_2")
    quarter = layers(nn.avg_pool2d(half, 2), "quarter_1", "quarter_2")
    half = layers(half + nn.interpolate(quarter, scale_factor=2, mode="nearest"), "half_3", "half_4")
    return layers(full + nn.interpolate(half, scale_factor=2, mode="nearest"), "full_3", "full_4")


def train(
    lessons: Sequence[Lesson], steps: int, seed: int, start: Mapping[str, npt.NDArray[Any]] | None = None
) -> tuple[dict[str, npt.NDArray[np.float16]], list[float]]:
    """Weights after ``steps`` of Adam on crops of the lessons, turned at random, and the loss at every step.

    The loss is the mean square error over that of the mixture: below 1 it is an improvement. All noises weigh alike.
    start: weights to go on from, at half the rate; None is random ones.
    """
    pt, rng = torch(), np.random.default_rng(seed)
    pt.manual_seed(seed)
    weights = {}
    for name, (inside, out) in LAYERS.items():
        size = (2 / (9 * inside)) ** 0.5 * (LAST if name == "full_4" else 1)
        weights[name] = (size * pt.randn(out, inside, 3, 3)).requires_grad_()
        weights[f"{name}_bias"] = pt.zeros(out).requires_grad_()
    for name, value in (start or {}).items():
        weights[name] = pt.from_numpy(value.astype(np.float32)).requires_grad_()
    optimizer = pt.optim.Adam(weights.values(), RATE / 2 if start else RATE)
    schedule = pt.optim.lr_scheduler.CosineAnnealingLR(optimizer, steps)
    scale = np.array([np.square(lesson.wanted, dtype=np.float32).mean() ** -0.5 for lesson in lessons])
    losses = []
    for _ in each(range(steps), "training", total=steps):
        chosen = rng.integers(len(lessons), size=BATCH)
        crops = [_crop(lessons[number], rng) for number in chosen]
        seen, wanted = (pt.from_numpy(np.stack(part)) for part in zip(*crops, strict=True))
        weight = pt.from_numpy(scale[chosen].astype(np.float32))[:, None, None, None]
        loss = (((forward(weights, seen) - wanted) * weight) ** 2).mean()
        optimizer.zero_grad()
        loss.backward()
        optimizer.step()
        schedule.step()
        losses.append(loss.item())
    return {name: value.detach().numpy().astype(np.float16) for name, value in weights.items()}, losses


def _crop(lesson: Lesson, rng: np.random.Generator) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]]:
    """A crop of a lesson, mirrored or its axes exchanged: of the views as of the pixels, a light field again."""
    top, left = rng.integers(0, np.array(lesson.seen.shape[1:]) - CROP + 1)
    views, down, across, turned = VIEWS**2, *rng.integers(0, 2, 3)
    out = []
    for values in lesson:
        part = values[:, top : top + CROP, left : left + CROP].astype(np.float32)
        fields = part[: len(part) // views * views].reshape(-1, VIEWS, VIEWS, CROP, CROP)
        rest = part[len(part) // views * views :]
        if down:
            fields, rest = fields[:, ::-1, :, ::-1], rest[:, ::-1]
        if across:
            fields, rest = fields[:, :, ::-1, :, ::-1], rest[:, :, ::-1]
        if turned:
            fields, rest = fields.transpose(0, 2, 1, 4, 3), rest.transpose(0, 2, 1)
        out.append(np.concatenate([fields.reshape(-1, CROP, CROP), rest]))
    return out[0], out[1]


@dataclass(frozen=True, eq=False)
class Learned:
    """Weights of the network, and how they were learned."""

    weights: dict[str, npt.NDArray[np.float16]]
    summary: dict[str, Any]

    @property
    def text(self) -> str:
        """Their figures in a line."""
        s = self.summary
        return f"{s['parameters']} weights leave {s['error']:.3f} of the mixture's mean square error"

    def save(self, path: Path) -> None:
        """Write the weights."""
        np.savez_compressed(path, **self.weights)  # type: ignore[arg-type]


def learned(seeds: Sequence[int], steps: int, seed: int, start: Path | None) -> Learned:
    """Weights from scenes of ``seeds``, on from those in ``start``. Raises ToolError without PyTorch, OSError."""
    torch()  # before minutes of samples
    before = None if start is None else dict(np.load(start))
    weights, losses = train(lessons(seeds, seed), steps, seed, before)
    last = losses[-max(len(losses) // 10, 1) :]
    summary = {
        "scenes": len(seeds),
        "first_scene": seeds[0],
        "steps": steps,
        "seed": seed,
        "start": str(start or ""),
        "noises": NOISES,
    }
    count = sum(value.size for value in weights.values())
    figures = {"parameters": count, "error": float(np.mean(last)), "losses": losses}
    return Learned(weights, summary | figures)
