"""A drawn pixel by scalar waves: power, a shadow by geometry, and what wider pixels keep."""

from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("klayout.db", reason="klayout: not installed; make layout installs it")

from talbot.models.parameters import ParameterError, TileParameters
from talbot.pixels.designs import gratings
from talbot.pixels.layout.finite import ANGLES, depth, drawn_shares, finite
from talbot.pixels.layout.pixel import BAR, PixelLayout

TYPES = TileParameters().types
UPRIGHT = next(kind for kind in TYPES if kind.gamma_deg == 0 and kind.beta == 24)


def made(pitch_um=10.0, kind=UPRIGHT):
    geometry = replace(gratings("sky130").geometries[kind.beta], pitch_um=pitch_um)
    return PixelLayout(geometry, kind, (0, 2))


def test_light_that_reaches_the_wells():
    """Never more than falls between the bars; of equal halves alike, mirrored in the angle."""
    shares = drawn_shares(made(), ANGLES, 0.575)
    assert 0.02 < shares.sum(0).min() <= shares.sum(0).max() < 1 - 4 * BAR / 10
    both = drawn_shares(replace(made(), diodes=(0, 0)), np.array([0.0]), 0.575)
    assert both[0, 0] == pytest.approx(both[1, 0], rel=0.05)


def test_a_wide_pixel_is_an_endless_one():
    """Light walks about 3 um to the side on its way down: of 5 um that is most, of 40 um little."""
    small, large = (finite(made(pitch), 0.575) for pitch in (10.0, 80.0))
    assert small.m < 0.5 < 0.75 < large.m < 1.1
    assert large.light == pytest.approx(1, abs=0.15)


def test_the_depth_of_a_wave():
    q = 0.4 * np.cos(17 * ANGLES + 1)
    assert depth(np.stack([1 + q, 1 - q])) == pytest.approx(0.4, rel=0.01)


def test_lines_that_are_not_upright():
    kind = next(kind for kind in TYPES if kind.gamma_deg == 90)
    with pytest.raises(ParameterError, match="gamma_deg = 90: must be 0"):
        drawn_shares(made(kind=kind), ANGLES, 0.575)
