"""Pixels as they are drawn: their gratings, read from the polygons, and what is refused."""

from dataclasses import replace

import numpy as np
import pytest

from talbot.base.gds import db
from talbot.models.parameters import ParameterError, TileParameters
from talbot.pixels.designs import gratings
from talbot.pixels.layout.pixel import COLUMNS, ROWS_ON, UPPER, PixelLayout, draw, grating_polygons, openings
from talbot.pixels.optics.geometry import QUADRATURE, PixelGeometry

TYPES = TileParameters().types
ROWS = {0.0: (0, 2), np.pi / 2: (3, 1)}  # of the designs that are kept, whose turn is -1: designs' tests


def pixel(number: int) -> PixelLayout:
    kind = TYPES[number]
    return PixelLayout(gratings("sky130").geometries[kind.beta], kind, ROWS[kind.alpha])


def phase(made: PixelLayout, side: int | None) -> float:
    """Phase of a half's analyzer, or of the upper grating, along the type's direction, in periods: from all lines."""
    half, grid = made.geometry.pitch_um / 2, made.process.grid_um
    p, q = made.gratings()[0].direction
    normal = np.array([-q, p]) / np.hypot(p, q)
    if normal @ [np.cos(made.kind.gamma), -np.sin(made.kind.gamma)] < 0:
        normal = -normal
    total = 0j
    for metal, corners in grating_polygons(made):
        points = grid * np.array(corners)
        if (metal == UPPER) == (side is None) and side in (None, int(points[:, 0].mean() > half)):
            length = np.linalg.norm(points[1] - points[0])
            total += length * np.exp(2j * np.pi * (points.mean(0) @ normal) / made.drawn.period_um)
    return float(np.angle(total) / (2 * np.pi))


@pytest.mark.parametrize("number", range(len(TYPES)))
def test_analyzers_are_where_the_optics_has_them(number):
    made = pixel(number)
    for side, diode in enumerate(made.diodes):
        off = phase(made, side) - phase(made, None)
        wanted = made.geometry.shift + QUADRATURE[diode]
        assert abs((off - wanted + 0.5) % 1 - 0.5) < 0.01


@pytest.mark.parametrize("number", range(len(TYPES)))
def test_light_reaches_a_well_through_its_analyzer_alone(number):
    """Openings lie inside the wells' rows and columns; lines next to an opening's edge leave at most a period open."""
    made = pixel(number)
    _, *frame = openings(made)
    lines = [np.array(corners) * made.process.grid_um for metal, corners in grating_polygons(made) if metal != UPPER]
    for side, (level, (left, bottom, right, top)) in enumerate(frame):
        assert level == ROWS_ON
        assert 5 * side + 0.6 < left < right < 5 * side + 4.4 and 2.9 < bottom < top < 9.9
        inside = [points for points in lines if int(points[:, 0].mean() > 5) == side]
        for axis, (low, high) in enumerate(((left, right), (bottom, top))):
            reach = made.drawn.period_um * 1.5
            assert min(points[:, axis].min() for points in inside) < low + reach
            assert max(points[:, axis].max() for points in inside) > high - reach


def test_every_type_has_a_cell_and_keeps_the_optics_parameters():
    made = [pixel(number) for number in range(len(TYPES))]
    assert len({one.name for one in made}) == len(TYPES)
    for one in made:
        assert one.drawn.period_um == pytest.approx(one.geometry.period_um, rel=0.01)
        assert one.drawn.fill == pytest.approx(one.geometry.fill, abs=0.04)
        assert one.drawn.analyzer_fill == pytest.approx(one.geometry.analyzer_fill, abs=0.03)
        assert abs(one.gratings()[0].off) < np.deg2rad(0.25)


@pytest.mark.needs("layout")
def test_a_cell_has_its_masks_inside_its_outline():
    layout = db.Layout()
    layout.dbu = 0.001
    made = pixel(0)
    cell = draw(layout, made).cell
    process = made.process
    assert cell.dbbox().enlarged(-0.1).inside(db.DBox(0, 0, 10, 10))  # only the tap's implant stands out
    wells = db.Region(cell.shapes(layout.layer(*process.well))).merged()
    width, height = made.well_um
    assert wells.count() == 2
    assert wells.area() == pytest.approx(2e6 * width * height)
    gates = db.Region(cell.shapes(layout.layer(*process.active))) & db.Region(cell.shapes(layout.layer(*process.poly)))
    sizes = {(gate.bbox().width(), gate.bbox().height()) for gate in gates.merged()}
    assert gates.merged().count() == len(made.circuit.transistors)
    assert sizes == {(round(1000 * made.l_um), round(1000 * made.w_um))}
    for level in (ROWS_ON, COLUMNS):
        assert not cell.shapes(layout.layer(*process.metals[level].gds)).is_empty()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            {"kind": "photogate", "analyzer": "poly", "analyzer_fill": 0.45, "period_um": 0.8},
            "kind = 'photogate': must be amplitude",
        ),
        ({"diffraction": "met3"}, "diffraction, analyzer = met3, met1: must be met4 over met1 or met2"),
        ({"analyzer": "met3", "period_um": 0.8}, "diffraction, analyzer = met4, met3: must be met4 over met1 or met2"),
        ({"pitch_um": 8.0}, "pitch_um = 8.0: must be a number in .10.0, 15.0."),
        ({"pitch_um": 12.005}, "pitch_um = 12.005: must be a multiple of 0.01"),
        ({"process": "ihp-sg13g2", "diffraction": "Metal4", "analyzer": "Metal1"}, "pdk = 'ihp-sg13g2': must be"),
    ],
)
def test_what_is_not_drawn_is_refused(change, message):
    geometry = replace(PixelGeometry(), **change)
    with pytest.raises(ParameterError, match=message):
        PixelLayout(geometry, TYPES[0], (0, 2))


def test_a_transistor_that_is_not_made_is_refused():
    with pytest.raises(ParameterError, match="w_um = 0.3: must be"):
        replace(pixel(0), w_um=0.3)
