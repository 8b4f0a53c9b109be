import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from talbot.models.afe import Converter
from talbot.models.parameters import ConverterParameters, ParameterError


def test_ideal_levels_are_half_a_code_under_the_code():
    c = Converter.ideal(3)
    assert (c.levels[0] == np.arange(256) - 128.5).all() and (c.levels[1] == np.arange(256) - 0.5).all()
    assert c.levels.shape == (2, 3, 256) and not c.offset.any() and c.noise_scale == c.ktc_scale == 0


def test_bow_peaks_at_inl_and_ends_at_zero():
    error = Converter.draw(ConverterParameters(inl=1.5), 8).levels - Converter.ideal(8).levels
    assert np.allclose(error[0], error[1], rtol=0, atol=1e-12)
    assert np.allclose(error[..., [0, 255]], 0) and np.allclose(np.abs(error).max(axis=-1), 1.5, atol=1e-3)
    assert len(np.unique(np.sign(error[0, :, 128]))) == 2


def test_step_errors_have_the_drawn_rms():
    error = Converter.draw(ConverterParameters(dnl=0.25, seed=5), 32).levels[1] - Converter.ideal(32).levels[1]
    assert abs(np.diff(error, axis=1).std() - 0.25) < 0.01
    assert np.allclose(error[:, [0, 255]], 0)


def test_unit_mismatch_is_that_of_binary_capacitors():
    """The step at mid-scale is 255 units; the code below it has all bits but one. Ends stay."""
    drawn = [Converter.draw(ConverterParameters(unit_mismatch=0.004, seed=n), 32) for n in range(40)]
    error = np.concatenate([c.levels[1] - Converter.ideal(32).levels[1] for c in drawn])
    assert np.allclose(error[:, [0, 255]], 0)
    assert abs((error[:, 128] - error[:, 127]).std() / (0.004 * 255**0.5) - 1) < 0.06
    # Weights are the same wherever a bit is switched
    assert np.allclose(error[:, 192] - error[:, 128], error[:, 64] - error[:, 0])


def test_offset_kTC_and_noise_have_the_drawn_rms():
    c = Converter.draw(ConverterParameters(offset=2, noise=0.5, ktc=3, seed=9), 32)
    assert abs(c.offset.std() - 2) < 0.7
    held = c.held(np.zeros(50_000), 4, np.arange(50_000)) - c.offset[4]
    assert abs(held.std() - 3) < 0.05
    share = np.mean(c.compare(np.full(50_000, 0.5), 1, True, 4, np.arange(50_000), 3))
    assert abs(share - 0.5) < 0.01  # level(1) = 0.5
    share = np.mean(c.compare(np.full(50_000, 1.0), 1, True, 4, np.arange(50_000), 3))
    assert abs(share - 0.841) < 0.01  # one sigma above it


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(1, 31))
def test_a_wider_bank_keeps_the_first_lanes(seed, lanes):
    p = ConverterParameters(inl=1, dnl=0.1, offset=1, seed=seed)
    narrow, wide = Converter.draw(p, lanes), Converter.draw(p, 32)
    assert (narrow.levels == wide.levels[:, :lanes]).all() and (narrow.offset == wide.offset[:lanes]).all()


@pytest.mark.parametrize("lanes", [0, 33])
def test_refuses_lanes_out_of_range(lanes):
    with pytest.raises(ParameterError, match="lanes = "):
        Converter.draw(ConverterParameters(), lanes)


def test_the_amplifier_adds_its_polynomial_from_its_zero():
    c = Converter.draw(
        ConverterParameters(amplifier_offset=0.5, amplifier_gain=-2, amplifier_square=0.25, amplifier_cube=1), 2
    )
    assert c.amplified([0.0, 128.0, -64.0], False).tolist() == [0.5, 127.75, -64.0 + 0.5 + 1 + 0.0625 - 0.125]
    assert c.amplified([128.0, 255.0], True)[0] == 128.5
    ideal = np.random.default_rng(1).uniform(-300, 300, 1000)
    assert (Converter.ideal(2).amplified(ideal, True) == ideal).all()
