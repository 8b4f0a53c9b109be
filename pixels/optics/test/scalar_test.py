"""Scalar waves: against geometry, against one another, and against the rigorous solution where that must agree."""

from dataclasses import replace

import numpy as np
import pytest

from talbot.pixels.optics.closed_form import angular_frequency
from talbot.pixels.optics.field import field_between
from talbot.pixels.optics.geometry import PixelGeometry
from talbot.pixels.optics.scalar import crosstalk, scalar_shares
from talbot.platforms.materials import refractive_index

WIDE = PixelGeometry(period_um=2.0)


def test_the_shadow_of_wide_lines_moves_as_in_the_closed_form():
    angles = np.deg2rad(np.linspace(-3, 3, 13))
    shifts = np.arange(16) / 16
    signal = np.exp(2j * np.pi * shifts) @ scalar_shares(WIDE, angles, 0.4, shifts)  # its fundamental
    slope = abs(np.polyfit(angles, np.unwrap(np.angle(signal)), 1)[0])
    between = WIDE.gap_um + (0.845 + 0.36) / 2
    index = float(refractive_index("silica", 0.4).real)
    assert slope == pytest.approx(angular_frequency(between, 2.0, index), rel=0.02)


def test_all_shifts_together_pass_what_the_spaces_share():
    shares = scalar_shares(replace(WIDE, period_um=5.0), np.deg2rad([0.0, 10.0]), 0.55, np.arange(16) / 16)
    np.testing.assert_allclose(shares.mean(0), 0.5 * 0.5 / 2, rtol=0.05)  # of half: both gratings pass half


def test_light_that_leaves_a_pixel():
    """A slanted ray takes as much of the pixel with it as it moves on its way down; diffraction adds to that."""
    found = crosstalk(PixelGeometry(period_um=0.74), np.deg2rad([0.0, 10.0, 20.0]), 0.55)
    index = float(refractive_index("silica", 0.55).real)
    depth = PixelGeometry().stack.metal("", "met4").bottom_um + 0.845 / 2 - 0.323
    moved = depth * np.tan(np.arcsin(np.sin(np.deg2rad(20.0)) / index)) / 10.0
    assert 0.9 * moved < found[2] < 2 * moved and 0.02 < found[0] < 2 * moved
    wide = crosstalk(PixelGeometry(period_um=0.74, pitch_um=40.0), [0.0], 0.55)
    assert wide[0] == pytest.approx(found[0] / 4, rel=0.3)  # an edge's, over four times the width


def test_mirrored_shift_is_mirrored_angle():
    shares = scalar_shares(PixelGeometry(), [-0.2, 0.2], 0.55)
    np.testing.assert_allclose(shares[1], shares[3, ::-1], atol=1e-12)


def test_the_field_between_the_gratings():
    """Mirrored with the angle; dark below the lines, where light has just passed between them."""
    geometry = PixelGeometry(period_um=0.74)
    x, up = np.linspace(-0.37, 0.37, 41), np.linspace(0, geometry.gap_um, 31)
    left, right = (field_between(geometry, angle, 0.575, x, up) for angle in (-0.1, 0.1))
    np.testing.assert_allclose(left, right[:, ::-1], rtol=1e-6, atol=1e-9)
    below = field_between(geometry, 0.0, 0.575, x, up)[-1]
    assert np.isfinite(below).all() and below[20] < below[0] / 5
