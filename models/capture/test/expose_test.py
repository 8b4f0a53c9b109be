"""Exposure: SI units computed manually, noise by its statistics, wells, seeds."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import poisson

from talbot.models.capture import Exposure, expose
from talbot.models.capture.expose import full_wells
from talbot.models.capture.shot import photon_count
from talbot.models.parameters import ELEMENTARY_CHARGE, AmpTiming, ElectricalParameters, ParameterError

NO_COLUMNS = {"column_fpn": 0, "flicker_noise": 0}
QUIET = ElectricalParameters(dark_current=0, read_noise=0, gain_fpn=0, offset_fpn=0, **NO_COLUMNS)
WHITE_ELECTRONS = 0.25e-9 * 512 / 10e6 / ELEMENTARY_CHARGE


def _pair(a, b, shape=(8, 12), dtype=np.float64):
    return np.stack([np.full(shape, a, dtype), np.full(shape, b, dtype)])


def test_units_by_hand():
    out = expose(_pair(1.0, 0.5), Exposure(QUIET, AmpTiming(), noise=0))
    assert out.shape == (8, 12, 2)
    np.testing.assert_allclose(out[..., 0], WHITE_ELECTRONS / 1e5 * 127.5)
    np.testing.assert_allclose(out[..., 1], out[..., 0] / 2)


def test_full_wells_make_255():
    out = expose(_pair(50.0, 50.0), Exposure(QUIET, AmpTiming(), noise=0))
    np.testing.assert_allclose(out.sum(-1), 255)


def test_dark_current_adds_its_charge():
    electrical = ElectricalParameters(dark_current=1e-11)
    out = expose(_pair(0.0, 0.0), Exposure(electrical, AmpTiming(), noise=0))
    np.testing.assert_allclose(out, 1e-11 * 512 / 10e6 / ELEMENTARY_CHARGE / electrical.lsb_electrons)


@pytest.mark.parametrize("n_cm", [0, 1, 7, 255])
def test_common_mode_resets_keep_the_difference(n_cm):
    """Strong ambient light: the difference of n_cm + 1 intervals, in wells that would have filled long ago."""
    a, b, g = 0.602, 0.5, 1.2
    out = expose(_pair(a, b), Exposure(QUIET, AmpTiming(n_cm=n_cm), noise=0), np.full((8, 12), g))
    np.testing.assert_allclose(
        out[..., 0] - g * out[..., 1], (n_cm + 1) * (a - g * b) * WHITE_ELECTRONS / QUIET.lsb_electrons, rtol=1e-9
    )
    assert out.max() < 127.5


def test_well_clips_in_every_interval():
    out = expose(_pair(3.0, 0.2), Exposure(QUIET, AmpTiming(n_cm=3), noise=0))
    np.testing.assert_allclose(out[..., 0], 127.5)


def test_shot_noise_is_poisson():
    out = expose(_pair(0.5, 0.5, (200, 200)), Exposure(QUIET, AmpTiming(), noise=1)) * QUIET.lsb_electrons
    electrons = WHITE_ELECTRONS / 2
    np.testing.assert_allclose(out.mean(), electrons, rtol=1e-3)
    np.testing.assert_allclose(out.std(), np.sqrt(electrons), rtol=0.02)


@pytest.mark.parametrize("mean", [0.0, 0.3, 5.0, 59.0, 61.0, 1e4])
@pytest.mark.parametrize("dtype", ["float32", "float64"])
def test_photon_counts_are_poisson(mean, dtype):
    z = np.random.default_rng(0).standard_normal(200_000)
    counts = photon_count(np.full(z.shape, mean, dtype), z.astype(dtype))
    assert counts.dtype == dtype and (counts == np.floor(counts)).all() and counts.min() >= 0
    assert abs(counts.mean() - mean) <= 4 * np.sqrt(mean / len(z))
    assert abs(counts.var() - mean) <= 0.02 * mean
    exact = poisson.cdf(np.quantile(counts, 0.9) + np.array([-1, 0]), mean)
    assert exact[0] <= 0.902 and exact[1] >= 0.898


@pytest.mark.parametrize("noise", [1.0, 3.0])
def test_read_noise_and_offset_scale(noise):
    electrical = ElectricalParameters(dark_current=0, read_noise=40, gain_fpn=0, offset_fpn=30, **NO_COLUMNS)
    out = expose(_pair(0.0, 0.0, (200, 200)), Exposure(electrical, AmpTiming(), noise=noise)) * electrical.lsb_electrons
    np.testing.assert_allclose(out.std(), 50 * noise, rtol=0.02)


def test_fixed_pattern_is_fixed_and_the_rest_moves():
    electrical = ElectricalParameters(read_noise=0, gain_fpn=0.1, dark_current=0)
    first, second = (
        expose(_pair(0.5, 0.5, (50, 60)), Exposure(electrical, AmpTiming(), noise=1), tap=tap) for tap in (0, 1)
    )
    assert np.corrcoef(first.ravel(), second.ravel())[0, 1] > 0.95 and (first != second).mean() > 0.99


def test_seed_decides_everything():
    same = [expose(_pair(0.5, 0.4), Exposure(ElectricalParameters(), AmpTiming(), seed=s)) for s in (3, 3, 4)]
    np.testing.assert_array_equal(same[0], same[1])
    assert (same[0] != same[2]).all()


def test_float32_follows_float64():
    wide, narrow = (
        expose(_pair(0.7, 0.5, dtype=d), Exposure(ElectricalParameters(), AmpTiming(), noise=0))
        for d in (np.float64, np.float32)
    )
    assert narrow.dtype == np.float32
    np.testing.assert_allclose(narrow, wide, rtol=1e-5)


@settings(max_examples=40, deadline=None)
@given(
    st.floats(0, 1e6),
    st.floats(0, 1e6),
    st.floats(0, 100),
    st.integers(0, 2**32 - 1),
    st.integers(0, 3),
    st.sampled_from(["float32", "float64"]),
)
def test_never_nan_never_a_warning(a, b, noise, seed, n_cm, dtype):
    exposure = Exposure(ElectricalParameters(gain_fpn=0.5), AmpTiming(n_cm=n_cm), noise=noise, seed=seed)
    with np.errstate(all="raise", under="ignore"):
        out = expose(_pair(a, b, (3, 4), dtype), exposure)
    assert np.isfinite(out).all() and out.dtype == dtype


@pytest.mark.parametrize(
    "pair",
    [
        np.full((2, 3, 4), np.nan),
        np.full((2, 3, 4), np.inf),
        np.full((2, 3, 4), -1.0),
        np.zeros((3, 4)),
        np.zeros((3, 3, 4)),
    ],
)
def test_bad_pairs(pair):
    with pytest.raises(ParameterError, match="pair"):
        expose(pair, Exposure(QUIET, AmpTiming()))


@pytest.mark.parametrize("change", [{"noise": -1}, {"noise": 101}, {"noise": float("nan")}, {"seed": -1}, {"f_clk": 0}])
def test_bad_exposures(change):
    with pytest.raises(ParameterError, match=next(iter(change))):
        Exposure(QUIET, AmpTiming(), **change)


@pytest.mark.parametrize("n_cm", [1, 16])
def test_every_common_mode_reset_leaves_ktc_noise(n_cm):
    """51 electrons at 1 V a reset, on top of the shot noise of the light."""
    timing = AmpTiming(n_cm=n_cm, t_int=16)
    pair = _pair(0.5, 0.5, (200, 200))
    found = []
    for swing in (1.0, 10.0):
        a, b = np.moveaxis(expose(pair, Exposure(replace(QUIET, swing=swing), timing)), -1, 0)
        found.append(np.var((a - b) * QUIET.lsb_electrons))
    ktc = 1.380649e-23 * 300 * 1e5 / 1.602176634e-19
    np.testing.assert_allclose(QUIET.ktc_noise, np.sqrt(ktc))
    assert 50 < QUIET.ktc_noise < 52
    np.testing.assert_allclose(found[0] - found[1], 2 * n_cm * (ktc - ktc / 10), rtol=0.05)


def test_columns_have_offsets_and_pink_noise():
    electrical = replace(QUIET, column_fpn=50, flicker_noise=20)
    out = expose(_pair(0.0, 0.0, (256, 300)), Exposure(electrical, AmpTiming()))[..., 0] * electrical.lsb_electrons
    np.testing.assert_allclose(out.mean(0).std(), 50, rtol=0.15)
    pink = out - out.mean(0)
    power = (np.abs(np.fft.rfft(pink, axis=0)) ** 2).mean(1)
    assert 10 < pink.std() <= 21 and power[2:6].mean() > 8 * power[60:].mean()


def test_exposures_of_a_sequence_have_the_pattern_in_common():
    quiet = {"read_noise": 0.0, "flicker_noise": 0.0, "dark_current": 0.0}
    electrical = replace(ElectricalParameters(), gain_fpn=0.05, offset_fpn=40.0, **quiet)
    pair = np.full((2, 30, 40), 0.5)
    several = [expose(pair, Exposure(electrical, AmpTiming(), number=n)) for n in range(30)]
    np.testing.assert_array_equal(several[0], expose(pair, Exposure(electrical, AmpTiming())))
    each = np.std(several, axis=0).mean()
    assert each > 0.1 and np.mean(several, axis=0).std() > 5 * each / np.sqrt(30)
    assert np.corrcoef((several[0] - several[1]).ravel(), (several[2] - several[3]).ravel())[0, 1] < 0.1


@pytest.mark.parametrize("n_cm", [0, 3])
def test_full_wells_are_those_that_an_interval_fills(n_cm):
    """A reset takes what both wells have in common: what filled one before it is still known"""
    exposure = Exposure(QUIET, AmpTiming(n_cm=n_cm, exposure=20))
    full = QUIET.full_well * ELEMENTARY_CHARGE / QUIET.white_current / exposure.intervals[0]
    light = full * np.array([0.5, 0.97, 1.0, 3.0])
    pair = np.stack([light, light])[:, None]
    np.testing.assert_array_equal(full_wells(pair, exposure), [[False, False, True, True]])
    assert (expose(pair, exposure)[0, 2:].max() > 127) == (n_cm == 0)  # LSB: after resets the samples do not tell it
