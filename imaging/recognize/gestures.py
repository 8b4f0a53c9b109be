"""Gestures: the kind of movement of a rendered shape, classified from a clip of binary gradients or of images."""

from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
from threadpoolctl import threadpool_limits

from talbot.imaging.recognize import chip, study
from talbot.imaging.recognize.data import Pictures
from talbot.imaging.recognize.study import Seen, Setting, in_focus
from talbot.imaging.recognize.wake import DRIFT, SIZE, background
from talbot.models.recognition import gradient
from talbot.models.recognition.statistics import first_layer_flops

MOVES = ("left", "right", "up", "down", "clockwise", "counterclockwise", "growing", "shrinking")
AHEAD = ("right", "down", "clockwise", "growing")  # along +x, along +y, from +x to +y
CLIPS, FRAMES = 400, 8  # clips; frames of one
CONTRAST = 0.3  # of the shape, of white
THRESHOLD = 12  # codes, of the gradient
COARSE = 5  # px, of small images
Floats = npt.NDArray[np.float32]


def clips(count: int, seed: int) -> tuple[Floats, npt.NDArray[np.int64]]:
    """Clips (count, frames, height, width) in linear radiance, and the number of each one's movement in MOVES.

    A bar or a square, darker or brighter than a smooth background, moves by 0.7 to 1.3 px a frame, or turns by 0.25
    rad or grows by 13 % for each such px, under light that drifts from frame to frame.
    """
    rng = np.random.default_rng([seed, 60])
    labels = np.arange(count) % len(MOVES)
    y, x = np.mgrid[:SIZE, :SIZE] - (SIZE - 1) / 2
    out = np.empty((count, FRAMES, SIZE, SIZE), np.float32)
    for clip, move in zip(out, labels):
        back, aspect, (down, right) = background(rng), rng.choice((1.0, 1.5, 2.0)), rng.uniform(-1.5, 1.5, 2)
        radius, angle, speed = rng.uniform(3, 5), rng.uniform(0, 2 * np.pi), rng.uniform(0.7, 1.3)
        step = CONTRAST * rng.choice((-1, 1))
        for t, light in enumerate(1 + DRIFT * rng.standard_normal(FRAMES)):
            way = np.zeros(4)  # along x, along y, turn, growth
            way[move // 2] = speed * (t - (FRAMES - 1) / 2) * (1 if MOVES[move] in AHEAD else -1)
            across, along, turn = x - right - way[0], y - down - way[1], angle + 0.25 * way[2]
            u, v = across * np.cos(turn) + along * np.sin(turn), along * np.cos(turn) - across * np.sin(turn)
            inside = radius * 1.13 ** way[3] - np.maximum(np.abs(u), aspect * np.abs(v))
            clip[t] = (back + step * np.clip(inside + 0.5, 0, 1)) * light
    return np.clip(out, 0.02, 1), labels


def classify(base: Setting, count: int = CLIPS) -> dict[str, dict[str, Any]]:
    """Evaluate every input, by name: figures of a row as `study.figures`. Raises ParameterError."""
    base = replace(base, front="image")
    shown, labels = clips(count, base.seed)
    flat = shown.reshape(-1, SIZE, SIZE)
    images = chip.read(in_focus(base.sensor, (SIZE, SIZE)), flat, "image", 0, base.noise, base.seed)
    small = study.reduced(flat, COARSE)
    coarse = chip.read(in_focus(base.sensor, small.shape[1:]), small, "image", 0, base.noise, base.seed)
    codes, few = (r.codes.reshape(count, FRAMES, *r.codes.shape[1:]).astype(np.float32) for r in (images, coarse))
    active = gradient.spatial(codes, THRESHOLD)
    changes = gradient.temporal(active[:, 1:], active[:, :-1])
    level = codes / codes.mean((2, 3), keepdims=True)
    middle = FRAMES // 2
    inputs = {
        "temporal binary gradients (Eq. A.2)": (changes, *_sent(changes, FRAMES)),
        "spatial binary gradients (Eq. A.1), all frames": (active, *_sent(active, FRAMES)),
        "spatial binary gradient, one frame": (active[:, middle, None], *_sent(active[:, middle, None], 1)),
        "plain images, all frames": (codes, *_read(images, FRAMES)),
        "differences of plain images": (np.diff(codes, axis=1), *_read(images, FRAMES)),
        "differences, brightness removed": (np.diff(level, axis=1), *_read(images, FRAMES)),
        f"plain images of {COARSE} x {COARSE} px, all frames": (few, *_read(coarse, FRAMES)),
        "plain image, one frame": (codes[:, middle, None], *_read(images, 1)),
    }
    data = Pictures("gestures", codes[:, middle].astype(np.uint8), labels)
    out = {}
    with threadpool_limits(1):
        for name, (channels, size, energy) in inputs.items():
            _, depth, height, width = channels.shape
            first = 0
            if base.classifier != "kernel":
                first = first_layer_flops(height, width, study.KERNEL, study.FILTERS, depth)
            seen = Seen(np.moveaxis(channels, 1, -1).astype(np.float32), size, energy, first=first)
            out[name] = study.scored(base, data, seen, seen)
    out["chance: the most frequent class"] = study.evaluate(replace(base, front="chance"), data)
    return {name: study.figures(row) for name, row in out.items()}


def _sent(active: npt.NDArray[np.bool_], frames: int) -> tuple[float, tuple[float, float]]:
    """Bytes and energy of a clip of bit maps (n, maps, height, width), of which ``frames`` frames are scanned."""
    pixels = active.shape[2] * active.shape[3]
    share = active.sum() / (len(active) * frames * pixels)
    joules = frames * gradient.energy(1, pixels, float(share))
    return active.shape[1] * gradient.packed_bytes(pixels, 1), (joules, joules)


def _read(reading: chip.Reading, frames: int) -> tuple[float, tuple[float, float]]:
    low, high = reading.energy
    return frames * reading.bytes, (frames * low, frames * high)
