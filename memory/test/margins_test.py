"""Margins of curves that are known, and of a cell in ngspice."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from talbot.memory import margins, measured, tables
from talbot.memory.parameters import SramParameters
from talbot.models.parameters import ParameterError

CELL = """.subckt bit bl br wl vdd vss q qn
X0 q wl bl vss sky130_fd_pr__nfet_01v8 w=0.42 l=0.15
X1 qn wl br vss sky130_fd_pr__nfet_01v8 w=0.42 l=0.15
X2 q qn vss vss sky130_fd_pr__nfet_01v8 w=0.63 l=0.15
X3 qn q vss vss sky130_fd_pr__nfet_01v8 w=0.63 l=0.15
X4 q qn vdd vdd sky130_fd_pr__pfet_01v8 w=0.42 l=0.15
X5 qn q vdd vdd sky130_fd_pr__pfet_01v8 w=0.42 l=0.15
.ends
"""
INPUT = np.linspace(0, 1.8, 61)


def inverter(threshold, low=0.0):
    """A curve that falls from 1.8 V to ``low`` over 1 mV at ``threshold``, V."""
    return np.interp(INPUT, (threshold - 5e-4, threshold + 5e-4), (1.8, low))


@given(st.floats(0.5, 1.3), st.floats(0.5, 1.3))
def test_of_ideal_inverters_the_margin_is_the_smaller_lobe(first, second):
    curves = np.stack([INPUT, inverter(first), inverter(second)], axis=-1)[None]
    lobes = min(first, 1.8 - second), min(second, 1.8 - first)
    assert margins.noise_margins(curves)[0] == pytest.approx(min(lobes), abs=0.04)


@given(st.floats(0.5, 1.3), st.floats(0.0, 0.3))
def test_a_level_above_ground_costs_its_height(threshold, low):
    def margin(level):
        curve = inverter(threshold, level)
        return margins.noise_margins(np.stack([INPUT, curve, curve], axis=-1)[None])[0]

    assert margin(low) <= margin(0.0) + 1e-9


def test_the_bit_line_at_which_a_cell_changes():
    fall = np.arange(1.0, 0.09, -0.02)
    q = np.where(fall < 0.41, 0.0, 1.8)
    both = np.stack([np.stack([fall, q, 1.8 - q], -1), np.stack([fall, fall + 1, fall], -1)])
    assert margins.write_margins(both) == pytest.approx([0.40, 0.0])


@pytest.mark.needs("ngspice", "layout")
def test_a_cell_holds_better_than_it_is_read():
    one = margins.nominal(CELL, "tt_025C_1v80")
    assert 0.3 < one.read < one.hold < 0.9
    assert 0.4 < one.write < 0.8
    assert 5e-5 < one.current < 2e-4


def test_spreads_are_drawn_at_the_worst_corner(monkeypatch, tmp_path):
    jobs = []
    monkeypatch.setattr(
        measured, "run", lambda given, *_: jobs.extend(given) or [[0.1] * j.arguments[3] for j in given]
    )
    found = {"a": margins.Margins(1, 0.2, 0.9, 1e-4), "b": margins.Margins(1, 0.5, 0.3, 1e-4)}
    spreads = measured.spreads("", found, 60, tmp_path, 1)
    assert [(kind, one.corner, one.cells) for kind, one in spreads.items()] == [("read", "a", 60), ("write", "b", 60)]
    assert len({job.name for job in jobs}) == 6  # each with a seed of its own


def test_density_is_of_the_cells_alone():
    summary = {
        "cell_um": [2.0, 3.0],
        "words": 512,
        "bits": 32,
        "array_mm2": 0.1,
        "margins": {},
        "mismatch": {},
        "column": {},
    }
    rows = tables.tables(summary)["density"][1]
    assert rows[0][1:] == ("1", "6e-06", "166,667")
    assert rows[1][1:] == ("16,384", "0.1", "163,840")


@pytest.mark.parametrize(
    "values, text",
    [
        ((200,), "words = 200: must be a power of two"),
        ((64,), "words = 64"),
        ((512, 0), "bits = 0"),
        ((512, 32, 4), "mux"),
    ],
)
def test_sizes_out_of_range_are_refused(values, text):
    with pytest.raises(ParameterError, match=text):
        SramParameters(*values)


def test_sizes_of_the_default():
    sram = SramParameters()
    assert (sram.rows, sram.columns, sram.address_bits) == (64, 256, 9)
