"""Frames in light with a spectrum, from the command line and Python to the bytes."""

from argparse import ArgumentParser

import numpy as np
import pytest

from talbot.imaging.frame.command import add_arguments, request_of
from talbot.imaging.frame.job import golden_result, see
from talbot.imaging.frame.request import request
from talbot.models.parameters import STANDARD, ParameterError, light, sensor_of


def asked(*words):
    parser = ArgumentParser()
    add_arguments(parser)
    return request_of(parser.parse_args([*words, "--rows=24", "--cols=30"]))


def test_without_a_light_nothing_changes():
    plain = asked()
    assert plain.sensor.tile == STANDARD.tile and plain.room.spectrum is None and plain.wavelengths == ()
    assert plain == request(24, 30)


def test_a_light_sets_current_response_and_exposure():
    white = asked("--light=d65", "--lux=200")
    depth = white.sensor.spectral.depth(18, light("d65"))
    kinds = {kind.beta: kind.m for kind in white.sensor.tile.types}
    assert kinds[18.0] == pytest.approx(STANDARD.optics.m * depth)
    assert white.lit.electrical.white_current == pytest.approx(white.room.white(10e-6, STANDARD.optics.nu_max).current)
    assert sum(weight for _, weight in white.wavelengths) == pytest.approx(1)
    assert white == request(24, 30, light="d65", lux=200.0)


def test_differences_shrink_with_the_depth_of_the_fringes():
    """Of light that no noise disturbs: each group's differences have the share of m that is left."""
    scene = {"scene": "edge", "rows": 24, "cols": 48, "noise": 0.0, "threshold": 0, "views": 5}
    plain, white = (golden_result(request(**scene, light=name)) for name in ("laser:550", "d65"))
    kinds = STANDARD.tile.type_map(24, 48)
    for beta, share in ((12.0, 0.885), (18.0, 0.512)):
        of_group = np.isin(kinds, [n for n, kind in enumerate(STANDARD.tile.types) if kind.beta == beta])
        spread = [np.std(result.exposed.ideal[..., 0][of_group]) for result in (plain, white)]
        assert spread[1] / spread[0] == pytest.approx(share, rel=0.12)


def test_a_reflectance_and_an_irradiance_reach_the_frame():
    red, gray = (request(24, 30, light="d65", reflectance=name) for name in ("red", "gray"))
    assert red.lit.electrical.white_current < 0.6 * gray.lit.electrical.white_current
    near = golden_result(request(24, 30, scene="flat:50", mode="image", light="laser:850", irradiance=2.0))
    assert np.median(near.decoded.samples) > 50
    assert see(request(24, 30, scene="stress", light="d65"))[0].polarization.shape == (2, 24, 30)


@pytest.mark.parametrize(
    "words, error",
    [
        (["--light=d50"], "light = 'd50': must be one of d65, a, led, e, laser:NM"),
        (["--light=laser:850"], "lux = 500: must be left out with light = laser:850"),
        (["--irradiance=1"], "irradiance = 1.0: must be with a light"),
        (["--reflectance=red"], "reflectance = 'red': must be with a light"),
        (["--light=d65", "--reflectance=pink"], "reflectance = 'pink': must be one of gray"),
        (["--light=d65", "--mode=tof"], "light = 'd65': must be left out with mode = tof"),
        (["--light=d65", "--pixel=sky130"], "light = 'd65': must be left out with pixel = sky130"),
    ],
)
def test_what_does_not_go_together_is_refused(words, error):
    with pytest.raises(ParameterError, match=error):
        asked(*words)


def test_a_filter_needs_a_light():
    sensor = sensor_of({"spectral": {"filter_width": 40e-9}})
    with pytest.raises(ParameterError, match=r"spectral.filter_width = 4e-08: must be 0 without a light"):
        request(24, 30, sensor=sensor)
    assert request(24, 30, sensor=sensor, mode="tof").sensor.spectral == sensor.spectral
    assert request(24, 30, sensor=sensor, light="d65").lit.electrical.white_current > 0
