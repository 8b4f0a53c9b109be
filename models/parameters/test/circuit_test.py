"""The table that `make analog TABLE=` writes: every value has its source, and what it says is in range."""

import json
from dataclasses import fields, replace
from math import hypot

import numpy as np
import pytest

from talbot.models.parameters import (
    DIODE,
    DRAWN,
    ColumnCurves,
    ConverterParameters,
    ElectricalParameters,
    ParameterError,
    circuit_columns,
    circuit_converter,
    circuit_electrical,
)
from talbot.models.parameters.circuit import TABLE
from talbot.models.parameters.drawn import PIXEL
from talbot.models.parameters.electrical import AMPLIFIER

WRITTEN = json.loads(TABLE.read_text())


def test_every_value_has_a_source():
    names = {field.name for field in fields(ConverterParameters)} - {"seed"}
    assert WRITTEN["parameters"].keys() == names
    assert WRITTEN["sources"].keys() == names | WRITTEN["columns"].keys() | WRITTEN["diodes"].keys()
    assert all(WRITTEN["sources"].values()) and WRITTEN["command"].startswith("make analog")
    assert all(0 <= error < 1 for error in WRITTEN["errors"].values())


def test_every_value_of_the_drawing_has_a_source():
    drawn = json.loads(DRAWN.read_text())
    assert drawn["parameters"].keys() == set(AMPLIFIER) and drawn["command"].startswith("make analog-layout")
    assert drawn["sources"].keys() == {*AMPLIFIER, *drawn["columns"]}
    assert all(0 <= error < 1 for error in drawn["errors"].values())
    assert circuit_converter(DRAWN).amplifier_offset != circuit_converter().amplifier_offset


def test_the_circuit_is_what_it_was_sized_for():
    """Offset, noise and sampled noise within the limits of its specification; steps by its capacitors alone.

    Comparator and lane have 0.5 LSB of offset and INL, 0.25 of noise, 0.15 of kT/C; the amplifier 1 and 0.25 in
    addition.
    """
    found = circuit_converter()
    assert 0 < found.noise <= 0.25 and 0 < found.ktc <= hypot(0.15, 0.25)
    assert 0 < found.offset <= hypot(0.5, 1) and found.inl <= 0.5
    assert 0.1 < -found.amplifier_gain / 128 * 100 < 5 and abs(found.amplifier_cube) < 1  # 1 % of gain, no sharp bend
    assert found.dnl == 0 and 3 * 255**0.5 * found.unit_mismatch <= 0.5


def test_a_value_out_of_range_is_refused_by_name(tmp_path):
    file = tmp_path / "circuit.json"
    file.write_text(json.dumps(WRITTEN | {"parameters": WRITTEN["parameters"] | {"ktc": -1}}))
    with pytest.raises(ParameterError, match="ktc = -1"):
        circuit_converter(file)
    file.write_text(json.dumps(WRITTEN | {"columns": WRITTEN["columns"] | {"a": [1] * 9}}))
    with pytest.raises(ParameterError, match="a = "):
        circuit_columns(file)


def test_the_default_sensors_noise_is_the_circuits():
    """Of a full well of 1e5 electrons; another run of `make analog` may differ by its interval."""
    usual = ElectricalParameters()
    pixel = json.loads(PIXEL.read_text())["parameters"]
    found = circuit_electrical(replace(usual, read_noise=pixel["read_noise"]))
    assert usual.read_noise == pytest.approx(found.read_noise, rel=0.02) and usual.gain_fpn == pixel["gain_fpn"]
    assert found.read_noise > pixel["read_noise"] > 2**0.5 * 0.7 * usual.ktc_noise  # kT/C twice, of a smaller well
    for name in ("column_fpn", "offset_fpn"):
        error = 1.5 * WRITTEN["errors"][name] * usual.lsb_electrons
        assert getattr(usual, name) == pytest.approx(getattr(found, name), abs=error)


def test_columns_are_within_the_slope_that_they_were_sized_for():
    found = circuit_columns()
    half = found.delivered(np.array([[0.5, 0.0], [0.0, 0.5]]))
    assert half == pytest.approx(0.5 * np.eye(2), abs=0.5 * 0.05) and (half[[0, 1], [1, 0]] != 0).all()
    first, later = found.summed(np.array([0.5, 0.5])), found.summed(np.array([0.5, 0.5]), later=True)
    assert first == pytest.approx([0.5, 0.5], rel=0.02)
    # The second diode's holder takes none later: at most twice EXPOSED, 1.5 %, more has come; the first's is as it was
    assert 0.005 < later[1] / first[1] - 1 < 0.03 and later[0] == pytest.approx(first[0], rel=1e-3)


def test_a_diode_has_its_own_curve_and_what_the_other_leaves():
    straight, none = (0.0, 0.5, 1.0), (0.0, 0.0, 0.0)
    sums = straight, (0.0, 0.4, 0.7), straight, (0.0, 0.6, 1.1)
    curves = ColumnCurves(straight, (0.0, 0.5, 0.9), (0.0, 0.4, 0.8), (0.0, 0.01, 0.02), none, *sums)
    found = curves.delivered(np.array([[[1.0, 0.0], [0.0, 1.0]], [[0.5, 0.5], [0.0, 0.0]]]))
    assert found == pytest.approx(np.array([[[0.9, 0.0], [0.02, 0.8]], [[0.51, 0.4], [0.0, 0.0]]]))
    assert curves.summed(np.array([0.5, 0.5])) == pytest.approx([0.5, 0.4])
    taps = DIODE * np.full((3, 1, 1, 2), 0.5)
    assert curves.samples(taps, "edge") == pytest.approx(DIODE * np.broadcast_to([0.51, 0.4], (3, 1, 1, 2)))
    assert curves.samples(taps, "tof")[:, 0, 0] == pytest.approx(DIODE * np.array([[0.5, 0.4], *2 * [[0.5, 0.6]]]))


@pytest.mark.parametrize(
    "wrong",
    [
        {"fills": (0.1, 0.5)},
        {"fills": (0.0, 0.0)},
        {"a": (0.0,)},
        {"b": (0.1, 0.5)},
        {"a_other": (0.0, 0.6)},
        {"later_b": (0.0, 1.6)},
    ],
)
def test_a_curve_that_is_none_is_refused_by_name(wrong):
    names = "fills", "a", "b", "a_other", "b_other", "sum_a", "sum_b", "later_a", "later_b"
    sound = dict.fromkeys(names, (0.0, 0.5))
    ColumnCurves(**sound)
    (name,) = wrong
    with pytest.raises(ParameterError, match=f"{name} = "):
        ColumnCurves(**sound | wrong)
