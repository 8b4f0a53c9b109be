"""Figures of each frame of a sequence, and of all together: each measured or counted in this run."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from talbot.imaging.frame.figures import energy_of, exposure_of, mismatches
from talbot.imaging.frame.quality import decoding_error, ideal_samples, snr
from talbot.imaging.frame.result import FrameResult
from talbot.models.parameters import SIGNED


def of_frame(result: FrameResult) -> dict[str, Any]:
    """Figures of a frame, as of summary.json of `talbot sim` (imaging/frame/figures.py); SNR against nothing sent."""
    golden, chip, frame, ideal = result.golden, result.chip, result.request.frame, result.exposed.ideal
    error = decoding_error(result.decoded.samples, ideal, result.counted, frame)
    signal = ideal_samples(ideal, frame)[result.counted]
    signal = signal if frame.mode in SIGNED else signal - signal.mean(0)
    energy = energy_of(result)
    return {
        "frame_number": frame.frame_number,
        "stream_bytes": len(chip.stream),
        "stream_mismatches": mismatches(chip.stream, golden.stream),
        "decoded_mismatches": int((result.decoded.samples != golden.sent).sum()),
        "conversions_made": chip.status["conversions_made"],
        "conversions_left_out": chip.status["conversions_left_out"],
        "cycles": chip.status["cycles"],
        "deviating_rows": exposure_of(result)["deviating_rows"],
        "snr_db": snr(error[:, -1:], signal[:, -1:]) if frame.phase else snr(error, signal),
        "energy_uj": [energy["total"], energy["total_high"]],
        "views": result.exposed.views.most,
        "rtl_s": chip.seconds,
        "rtl_cycles": chip.cycles,
    }


def of_all(frames: Sequence[dict[str, Any]], result: FrameResult, wall: dict[str, float]) -> dict[str, Any]:
    """Figures of the sequence. result: its last frame. wall: s by step.

    frames_per_s: of all frames by all wall clock but that of the setup (trims, first choice of views, weights) and of
    the simulator's compilation; frames_per_s_in_all: by all of it. rtl_s: wall clock of the simulator, which runs
    while other steps do.
    """
    golden, f_clk = result.golden, result.request.sensor.chip.f_clk
    raw = int(golden.read.sum()) * golden.sent.shape[2]
    sent = sum(frame["stream_bytes"] for frame in frames)
    total = sum(wall.values())
    ready = total - wall.get("build", 0.0) - wall.get("setup", 0.0)
    snrs = [frame["snr_db"] for frame in frames if frame["snr_db"] is not None]
    wrong = sum(bool(frame["stream_mismatches"] or frame["decoded_mismatches"]) for frame in frames)
    return {
        "frames": len(frames),
        "frames_that_differ": wrong,
        "stream_bytes": sent,
        "raw_bytes": raw * len(frames),
        "compression_ratio": raw * len(frames) / sent,
        "snr_db_mean": float(np.mean(snrs)) if snrs else None,
        "frame_s_at_clock": float(np.mean([frame["cycles"] for frame in frames])) / f_clk,
        "energy_uj": [float(np.mean([frame["energy_uj"][i] for frame in frames])) for i in (0, 1)],
        "frames_per_s": len(frames) / ready,
        "frames_per_s_in_all": len(frames) / total,
        "rtl_cycles_per_s": sum(f["rtl_cycles"] for f in frames) / sum(f["rtl_s"] for f in frames),
        "rtl_s": sum(frame["rtl_s"] for frame in frames),
        "wall_s": wall,
    }
