"""What a simulated bench has put in is measured from its readings, also where something went wrong on the bench."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from talbot.imaging.bench.chip import directions, measured
from talbot.imaging.bench.compare import fitting_heights, heights_of, orientation
from talbot.imaging.bench.readings import joined
from talbot.imaging.bench.simulated import angles, desk_lamp, relative, simulate, stage, tangents_of
from talbot.models.parameters import STANDARD, ParameterError, PixelType, TileParameters
from talbot.pixels.tabled import tabled
from talbot.pixels.test_chip.places import COLS, ROWS, by_type

HOLES = 9  # 64 angles
BOUNDS = {"beta": 0.1, "gamma_deg": 0.4, "alpha": 0.02, "m": 0.02}  # of any type, with noise


def sensor_of(m=0.7):
    types = tuple(
        PixelType(kind.beta * 1.02, kind.gamma_deg, kind.alpha, m - 0.01 * k)
        for k, kind in enumerate(TileParameters().types)
    )
    return replace(STANDARD, tile=TileParameters(types=types))


@cache
def session(seed=1, noise=1.0):
    return simulate(sensor_of(), desk_lamp(500), angles(HOLES), noise, seed)


def pixel(readings, row, col, kind="light"):
    return (readings.kind == kind) & (readings["row"] == row) & (readings["col"] == col)


def of_type(number):
    return divmod(TileParameters().order.index(number), COLS)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_what_was_put_in(seed):
    readings, truth = session(seed)
    s = measured(readings).summary
    pairs = [*zip(s["types"], sensor_of().tile.types, strict=True)]
    for name, bound in BOUNDS.items():
        wrong = [entry[name] - getattr(kind, name) for entry, kind in pairs]
        assert np.abs(wrong).max() < bound, name
    wrong = [(entry["m"] - kind.m) / entry["m_error"] for entry, kind in pairs]
    assert np.sqrt(np.mean(np.square(wrong))) < 2
    efficiency = np.array([entry["efficiency"]["value"] for entry in s["types"]])
    np.testing.assert_allclose(efficiency, truth.levels, rtol=0.02)
    assert s["dark_v_per_s"]["value"] == pytest.approx(truth.dark[0], rel=0.03)
    assert s["dark_doubling_k"] == pytest.approx(8, rel=0.05)
    assert s["crosstalk"]["value"] == pytest.approx(truth.crosstalk, rel=0.05)
    assert s["follower_gain"]["value"] == pytest.approx(truth.gain, rel=0.01)
    assert s["capacitance_rise"]["value"] == pytest.approx(truth.bend, abs=4 * s["capacitance_rise"]["error"])
    assert not s["notes"] and not s["dead"]


def test_without_noise_what_is_left_is_of_the_method():
    readings, _ = session(noise=0.0)
    s = measured(readings).summary
    for entry, kind in zip(s["types"], sensor_of().tile.types, strict=True):
        assert entry["m"] == pytest.approx(kind.m, abs=2e-3) and entry["beta"] == pytest.approx(kind.beta, abs=0.02)


def test_a_bench_on_which_much_went_wrong():
    """Lines in any order, a dead pixel, a broken follower, a type or a plain pixel not read, exposures too long."""
    readings, _ = session()
    values = {name: column.copy() for name, column in readings.values.items()}
    dead, broken, missing, bright = map(of_type, (3, 8, 12, 20))
    for kind in ("light", "dark"):
        lines = pixel(readings, *dead, kind)
        values["a1_v"][lines], values["b1_v"][lines] = values["a0_v"][lines], values["b0_v"][lines]
    stuck = pixel(readings, *broken, "sweep")
    values["a0_v"][stuck] = 0.4
    saturated = np.flatnonzero(pixel(readings, *bright))[::3]
    values["a1_v"][saturated], values["b1_v"][saturated] = 1.34, 1.34
    gone = pixel(readings, *missing) | pixel(readings, ROWS - 1, 0) | pixel(readings, 1, 1, "sweep")
    order = np.random.default_rng(0).permutation(np.flatnonzero(~gone))
    places = [f"line {i}" for i in order]
    bad = replace(readings, kind=readings.kind[order], values={n: v[order] for n, v in values.items()}, places=places)
    s = measured(bad).summary
    assert s["dead"] == sorted([[*dead], [*broken]])
    for number, (entry, kind) in enumerate(zip(s["types"], sensor_of().tile.types, strict=True)):
        if number in (3, 8, 12):
            assert entry["m"] == 0 and entry["efficiency"] is None
        else:
            assert entry["m"] == pytest.approx(kind.m, abs=0.03) and entry["beta"] == pytest.approx(kind.beta, abs=0.2)
    said = "\n".join(s["notes"])
    assert "types 3, 8, 12 have fewer than 20 usable readings: m = 0, not measured" in said
    assert f"pixel {bright[0]},{bright[1]}: " in said and "outside the reset sweep" in said
    assert said.count("is left out: its pads do not follow") == 2


def on_lines(*degrees):
    """Angles of a stage that is turned along lines, 2.5 degrees apart."""
    along = np.tan(np.deg2rad(np.arange(-25, 25.1, 2.5)))[:, None]
    return np.concatenate([along * [np.sin(turn), np.cos(turn)] for turn in np.deg2rad(degrees)])


def test_angles_on_lines_in_four_directions():
    s = measured(simulate(sensor_of(), desk_lamp(500), on_lines(0, 45, 90, 135))[0]).summary
    for entry, kind in zip(s["types"], sensor_of().tile.types, strict=True):
        assert entry["beta"] == pytest.approx(kind.beta, abs=0.1)
        assert entry["gamma_deg"] == pytest.approx(kind.gamma_deg, abs=0.4)
    assert not s["notes"]


@pytest.mark.parametrize("turns, count", [((0,), 1), ((0, 90), 2), ((0, 45, 90), 3), ((0, 45, 90, 135), 4)])
def test_two_lines_of_angles_do_not_tell_gamma(turns, count):
    assert directions(np.arctan(on_lines(*turns))) == count


def test_the_order_of_lines_does_not_matter():
    readings, _ = session(2)
    order = np.random.default_rng(1).permutation(len(readings))
    values = {name: column[order] for name, column in readings.values.items()}
    mixed = replace(readings, kind=readings.kind[order], values=values, places=[""] * len(order))
    for a, b in zip(measured(readings).fits, measured(mixed).fits, strict=True):
        assert a.kind.beta == pytest.approx(b.kind.beta, abs=1e-5) and a.kind.m == pytest.approx(b.kind.m, abs=1e-6)


@pytest.mark.parametrize(
    "kind, change, said",
    [
        ("sweep", {}, "kind = sweep: must be on lines"),
        ("dark", {}, "kind = dark: must be on lines inside"),
        ("light", {}, "kind = light: must be on lines"),
        (
            None,
            {"celsius": 80.0},
            r"celsius = 80 \(line .*: must be within 5 K of dark readings, which are at 25.0, 45.0",
        ),
        (None, {"wavelength_nm": 532.0}, r"wavelength_nm = 532 \(line .*: must be the same in all light readings, 575"),
        (None, {"a1_v": 0.2, "b1_v": 0.2}, "must have light readings inside the sweep, of a plain pixel"),
    ],
)
def test_refused(kind, change, said):
    readings, _ = session()
    if kind:
        readings = readings.where(readings.kind != kind)
    values = {name: column.copy() for name, column in readings.values.items()}
    chosen = np.flatnonzero(readings.kind == "light")
    chosen = chosen[-1:] if "v" not in "".join(change)[-1:] else chosen
    for name, value in change.items():
        values[name][chosen] = value
    with pytest.raises(ParameterError, match=said):
        measured(replace(readings, values=values))


def test_two_files_of_other_temperatures():
    """The dark current of each is separate; the light's is that of its own temperature."""
    readings, truth = session()
    cold = readings.where((readings.kind != "dark") | (readings["celsius"] < 30))
    warm = readings.where((readings.kind == "dark") & (readings["celsius"] > 30))
    alone, both = measured(cold).summary, measured(joined([cold, warm])).summary
    assert alone["dark_doubling_k"] is None and both["dark_doubling_k"] == pytest.approx(8, rel=0.05)
    assert alone["dark_current"] == pytest.approx(both["dark_current"], rel=1e-6)


def test_the_stage_has_two_axes():
    """The inner axis is carried by the outer one: a vector turned by both rotations."""
    rng = np.random.default_rng(4)
    for outer, inner in rng.uniform(-50, 50, (20, 2)):
        o, i = np.deg2rad([outer, inner])
        about_y = np.array([[np.cos(o), 0, np.sin(o)], [0, 1, 0], [-np.sin(o), 0, np.cos(o)]])
        about_x = np.array([[1, 0, 0], [0, np.cos(i), np.sin(i)], [0, -np.sin(i), np.cos(i)]])
        light = (about_y @ about_x).T @ [0, 0, 1]  # in the chip's frame
        y, x = tangents_of(np.array([outer]), np.array([inner]))[0]
        assert abs(light[0] / light[2]) == pytest.approx(abs(x)) and abs(light[1] / light[2]) == pytest.approx(abs(y))
        np.testing.assert_allclose(stage(np.array([[y, x]])), [[outer, inner]])


def signals_of(sensor, tangents):
    return by_type(relative(sensor, tangents))


@pytest.mark.parametrize("name", ["sky130", "sky130-raised"])
def test_the_table_of_heights_is_told_by_the_readings(name):
    tangents = angles(13)
    signals = signals_of(tabled(STANDARD, name), tangents)
    signals = signals * np.random.default_rng(1).normal(1, 0.03, signals.shape)
    heights = heights_of(signals, tangents, 575.0)
    assert fitting_heights({"heights": heights}).endswith(f": {name} fits")
    assert heights_of(signals, tangents, 532.0) is None
    noise = np.random.default_rng(2).uniform(1, 2, signals.shape)
    assert fitting_heights({"heights": heights_of(noise, tangents, 575.0)}).endswith("not decided")


@pytest.mark.parametrize(
    "turn, said",
    [
        (lambda t, s: (t, s), ""),
        (lambda t, s: (t * [1, -1], s), "outer_deg negated"),
        (lambda t, s: (t * [-1, 1], s), "inner_deg negated"),
        (lambda t, s: (t[:, ::-1], s), "both angles exchanged"),
        (lambda t, s: (t, s[..., ::-1]), "the pads a and b exchanged"),
    ],
)
def test_angles_and_pads_that_are_exchanged(turn, said):
    tangents = angles(13)
    theta, signals = turn(np.arctan(tangents), signals_of(sensor_of(), tangents))
    assert orientation(signals, theta) == said
