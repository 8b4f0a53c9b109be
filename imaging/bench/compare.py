"""Readings compared with the types as drawn: angles and pads that are exchanged, which table of heights fits."""

from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np

from talbot.imaging.bench.pads import Figure
from talbot.imaging.bench.readings import Floats
from talbot.models.parameters import STANDARD, TileParameters
from talbot.pixels.designs import DRAWN, RAISED, gratings
from talbot.pixels.tabled import tabled

LEAST = 20  # readings of a type: five values are fitted to them
NEAR_NM = 10.0  # of the wavelength for which heights are compared
ALIKE = 0.5  # correlation with a table that fits
CERTAIN = 3.0  # standard errors
REVERSED = 0.3  # of a correlation: by how much turned angles agree better with the types as drawn


def difference_over_sum(signals: Floats) -> Floats:
    """Return (a - b) / (a + b) of signals (..., 2), NaN without light."""
    sums = signals.sum(-1)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(sums > 0, (signals[..., 0] - signals[..., 1]) / sums, np.nan)


def orientation(signals: Floats, theta: Floats) -> str:
    """Return the exchange of angles and pads with which readings agree best with the drawn types, '' for none."""
    q = difference_over_sum(signals)
    types = TileParameters().types
    scores = {}
    for swapped, down, across, pads in product((False, True), (1, -1), (1, -1), (1, -1)):
        y, x = (theta[:, ::-1] if swapped else theta).T * [[down], [across]]
        score = []
        for k, kind in enumerate(types):
            good = np.isfinite(q[:, k])
            if good.sum() >= LEAST and q[good, k].std() > 0:
                turn = kind.beta * (x * np.cos(kind.gamma) + y * np.sin(kind.gamma)) + kind.alpha
                score.append(pads * np.corrcoef(np.cos(turn[good]), q[good, k])[0, 1])
        words = [
            "both angles exchanged" * swapped,
            "inner_deg negated" * (down < 0),
            "outer_deg negated" * (across < 0),
            "the pads a and b exchanged" * (pads < 0),
        ]
        scores[", ".join(filter(None, words))] = float(np.mean(score)) if score else 0.0
    best = max(scores, key=lambda name: scores[name])
    return best if scores[best] > scores[""] + REVERSED else ""


def heights_of(signals: Floats, tangents: Floats, wavelength: float) -> dict[str, dict[str, float]] | None:
    """Compare the readings with the drawn pixel at both tables of heights; None at another wavelength.

    correlation: of (a - b) / (a + b), mean over the types. error: standard error of its difference to the other's.
    """
    if abs(wavelength - 1e3 * gratings(DRAWN[0]).wavelength_um) > NEAR_NM:
        return None
    q = difference_over_sum(signals)
    y, x = np.arctan(tangents).T
    out, each = {}, []
    for name in (DRAWN[0], DRAWN[0] + RAISED):
        drawn = tabled(replace(STANDARD, tile=TileParameters()), name).tile.types
        agreement = np.full(len(drawn), np.nan)
        for k, kind in enumerate(drawn):
            assert kind.response is not None
            a, b = np.asarray(kind.response(x, y))
            good = np.isfinite(q[:, k])
            if good.sum() >= LEAST and q[good, k].std() > 0:
                agreement[k] = np.corrcoef(((a - b) / (a + b))[good], q[good, k])[0, 1]
        each.append(agreement)
        out[name] = {"correlation": float(np.nanmean(agreement))}
    difference = Figure.mean(each[0] - each[1])
    if difference is None or difference.error is None:
        return None
    for entry in out.values():
        entry["error"] = difference.error
    return out


def fitting_heights(summary: dict[str, Any]) -> str:
    """Return a sentence about the heights that fit."""
    heights = summary["heights"]
    if heights is None:
        return "not compared: another wavelength than that of the gratings, or too few readings"
    (first, a), (second, b) = heights.items()
    apart = a["correlation"] - b["correlation"]
    words = f"correlation {a['correlation']:.3f} with {first}, {b['correlation']:.3f} with {second}"
    if abs(apart) < CERTAIN * a["error"] or max(a["correlation"], b["correlation"]) < ALIKE:
        return f"{words}: not decided"
    return f"{words}: {first if apart > 0 else second} fits"
