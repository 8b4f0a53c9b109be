import numpy as np
import pytest

from talbot.models.afe import Converter, FrontEnd, trim_codes, trim_gain
from talbot.models.afe.trim import TRIM_BITS, TRIM_MAX, TRIM_MIN
from talbot.models.parameters import ConverterParameters, ParameterError, TileParameters
from talbot.models.parameters.registers import register_map, trim_range

TRIM = tuple(range(-480, 480, 40))
RNG = np.random.default_rng(3)
SAMPLES = RNG.uniform(0, 127.5, (4, 9, 20, 2))


def test_trim_covers_the_flat_field_of_every_type_to_half_a_code():
    k = np.linspace(-0.3, 0.3, 1001)
    g = (1 + k) / (1 - k)
    assert np.abs(trim_gain(trim_codes(g)) - g).max() <= 1 / 1024
    assert 4 * 127.5 * np.abs(trim_gain(trim_codes(g)) - g).max() < 0.5


def test_trim_takes_the_end_of_its_range():
    assert trim_codes([np.inf, 2.5, -1, 0, 1]).tolist() == [511, 511, -512, -512, 0]
    assert trim_gain([-512, 0, 511]).tolist() == [0, 1, 1023 / 512]
    with pytest.raises(ParameterError, match="trim"):
        trim_codes(np.nan)
    with pytest.raises(ParameterError, match="trim"):
        trim_gain(512)


def test_the_registers_hold_every_trim():
    trims = register_map().trims
    assert {f.width for f in trims} == {TRIM_BITS} and all(f.signed for f in trims)
    assert trim_range() == (TRIM_MIN, TRIM_MAX)
    assert trim_gain(trims[0].reset) == 1


def test_values_of_every_mode():
    front_end = FrontEnd(gain=3.0, trim=TRIM)
    a, b = SAMPLES[0, ..., 0], SAMPLES[0, ..., 1]
    order = TileParameters().order
    edge = front_end.values(SAMPLES, "edge")
    for row, col in ((0, 0), (5, 13), (8, 19)):
        g = 1 + TRIM[order[row % 4 * 6 + col % 6]] / 512
        assert edge[0, row, col] == pytest.approx(3 * (a[row, col] - g * b[row, col]))
    assert (front_end.values(SAMPLES, "image") == (a + b)[None]).all()
    assert (front_end.values(SAMPLES, "raw") == np.stack([2 * a, 2 * b])).all()
    assert (front_end.values(SAMPLES, "tof") == SAMPLES.sum(axis=3)).all()


def test_full_wells_are_full_scale():
    full = FrontEnd(gain=1.0, trim=(0,) * 24).convert(np.full((1, 4, 6, 2), 127.5), "image")
    assert (full.codes == 255).all()
    raw = FrontEnd(gain=1.0, trim=(0,) * 24).convert(np.full((1, 4, 6, 2), 127.5), "raw")
    assert (raw.codes == 255).all()


def test_noise_does_not_depend_on_what_else_is_read():
    rough = Converter.draw(ConverterParameters(noise=3, offset=1, inl=1, seed=2), 2)
    front_end = FrontEnd(gain=2.0, trim=TRIM, lanes=2, converter=rough)
    all_taps = front_end.convert(SAMPLES, "edge", 5)
    one_tap = front_end.convert(SAMPLES[:1], "edge", 5)
    assert (all_taps.codes == one_tap.codes).all()
    columns = np.arange(20) // 6 % 2
    assert set(columns[:12]) == {0, 1}
    offset_free = FrontEnd(gain=2.0, trim=TRIM, lanes=2).convert(SAMPLES, "edge", 5)
    assert (offset_free.codes != all_taps.codes).any()


@pytest.mark.parametrize(
    "samples, mode, match",
    [
        (SAMPLES[0], "edge", "samples"),
        (SAMPLES.astype(np.float32), "edge", "samples"),
        (SAMPLES[:1], "tof", "taps"),
        (SAMPLES * np.nan, "image", "finite"),
        (SAMPLES, "colour", "mode"),
    ],
)
def test_refuses_bad_input(samples, mode, match):
    with pytest.raises(ParameterError, match=match):
        FrontEnd(gain=1.0, trim=TRIM).convert(samples, mode)


@pytest.mark.parametrize(
    "change, match",
    [
        ({"gain": 0}, "gain"),
        ({"trim": (0,)}, "trim"),
        ({"lanes": 0}, "lanes"),
        ({"converter": Converter.ideal(4)}, "converter"),
    ],
)
def test_refuses_bad_parameters(change, match):
    with pytest.raises(ParameterError, match=match):
        FrontEnd(**{"gain": 1.0, "trim": TRIM, **change})
