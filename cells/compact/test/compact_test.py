"""Cells of the library: what they compute, that they are drawn as their schematics say, and that errors are caught."""

import dataclasses
import itertools

import pytest

from talbot.cells.compact.assemble import assemble, task
from talbot.cells.compact.canvas import Canvas
from talbot.cells.compact.catalogue import schematics
from talbot.cells.compact.draw import Drawing, Shape
from talbot.cells.compact.library import schematic_spice
from talbot.cells.compact.make import make, recipe
from talbot.cells.compact.place import breaks, place
from talbot.cells.compact.route import route
from talbot.cells.compact.rules import broken
from talbot.cells.compact.transistors import Schematic, Switch
from talbot.cells.extract.subcircuit import extract
from talbot.cells.extract.test.compare import differences
from talbot.cells.netlist import spice
from talbot.models.parameters import ParameterError
from talbot.platforms.extraction import extraction_platform

pytestmark = pytest.mark.needs("layout")

CELLS = schematics()
DRAWN = ("inv_x1", "nand3_x1", "and21nor_x1", "xor2_x1", "mux2_x1", "dff_x1")


def levels(schematic, inputs):
    """Level of every net (0, 1 or None: fought over or floating) with ``inputs`` (net -> level) in a switch-level

    model of its own: the value that reaches a net through conducting transistors.
    """
    state = {"vdd": 1, "vss": 0, **inputs}
    for _ in range(len(schematic.n) + 2):
        for switch in (*schematic.n, *schematic.p):
            on = state.get(switch.gate) == (1 if switch.kind == "n" else 0)
            for a, b in ((switch.a, switch.b), (switch.b, switch.a)):
                if on and a in state and b not in state:
                    state[b] = state[a]
    return state


def value(expression, inputs):
    python = expression.replace("!", " not ").replace("&", " and ").replace("|", " or ")
    return int(bool(eval(python, {}, dict(inputs))))


@pytest.mark.parametrize("name", [name for name, s in CELLS.items() if s.inputs and not s.storage])
def test_transistors_compute_the_function(name):
    schematic = CELLS[name]
    for bits in itertools.product((0, 1), repeat=len(schematic.inputs)):
        inputs = dict(zip(schematic.inputs, bits, strict=True))
        state = levels(schematic, inputs)
        for output in schematic.outputs:
            assert state[output] == value(schematic.functions[output], inputs), (inputs, output)


@pytest.mark.parametrize("name", CELLS)
def test_n_and_p_transistors_stand_in_pairs(name):
    assert len(CELLS[name].n) == len(CELLS[name].p)


def drawn_spice(tmp_path, name):
    """Extracted netlist of the drawn cell, from a GDS written here with plain KLayout."""
    import klayout.db as db

    gds = {
        "difftap": (65, 20),
        "poly": (66, 20),
        "licon": (66, 44),
        "li": (67, 20),
        "mcon": (67, 44),
        "m1": (68, 20),
        "nsdm": (93, 44),
        "psdm": (94, 20),
        "nwm": (64, 20),
        "li.pin": (67, 16),
        "m1.pin": (68, 16),
    }
    layout, made = db.Layout(), make(CELLS[name], Canvas(), recipe(name))
    cell = layout.create_cell(name)
    for shape in (Shape(*s) for s in made["shapes"]):
        if shape.layer not in gds:
            continue
        box = db.DBox(shape.left, shape.bottom, shape.right, shape.top)
        shapes = cell.shapes(layout.layer(*gds[shape.layer]))
        shapes.insert(box)
        if shape.layer.endswith(".pin"):
            shapes.insert(db.DText(shape.net, db.DTrans(box.center())))
    layout.write(str(tmp_path / "cell.gds"))
    return extract(tmp_path / "cell.gds", name, extraction_platform("sky130"), CELLS[name].ports, resistors=False)


@pytest.mark.parametrize("name", DRAWN)
def test_the_drawing_is_the_schematic(tmp_path, name):
    laid_out = spice.parse(drawn_spice(tmp_path, name))
    assert differences(laid_out, spice.parse(schematic_spice(CELLS[name], Canvas()))) == []


def test_another_schematic_is_seen(tmp_path):
    other = Schematic("nand3_x1", ("i0", "i1", "i2"), ("nq",)).gate("nq", ("or", "i0", "i1", "i2"))
    laid_out = spice.parse(drawn_spice(tmp_path, "nand3_x1"))
    assert differences(laid_out, spice.parse(schematic_spice(other, Canvas())))


def drawing(name="nand2_x1"):
    made = assemble(place(CELLS[name], 0))
    return Drawing(Canvas(), made, route(task(made, Canvas(), CELLS[name].ports)))


@pytest.mark.parametrize(
    "shape, rule",
    [
        (Shape("li", "i0", 0.3, 1.1, 0.4, 1.2), "li width"),
        (Shape("m1", "i0", 0.5, 1.0, 0.7, 1.2), "m1 area"),
        (Shape("li", "i1", 0.0, 0.0, 1.0, 3.0), "li short of"),
        (Shape("poly", "x", 0.0, 1.0, 1.5, 1.2), "short"),
    ],
)
def test_a_spoiled_drawing_breaks_a_rule(shape, rule):
    spoiled = drawing()
    assert broken(spoiled) == []
    spoiled.shapes.append(shape)
    assert any(rule in found for found in broken(spoiled))


def test_diffusions_are_shared_where_they_can_be():
    assert breaks(place(CELLS["nand4_x1"], 0)) == []
    apart = Schematic("two", ("a", "b"), ("x", "y"))
    apart.n += [Switch("n", "a", "x", "u"), Switch("n", "b", "y", "v")]
    apart.p += [Switch("p", "a", "x", "s"), Switch("p", "b", "y", "t")]
    assert len(breaks(place(apart, 0))) == 1


def test_no_two_nets_share_a_place():
    wiring = route(
        task(
            assemble(place(CELLS["mux2_x1"], recipe("mux2_x1").seed), recipe("mux2_x1").spread),
            Canvas(),
            CELLS["mux2_x1"].ports,
        )
    )
    held = [v for vertices in wiring.vertices.values() for v in vertices]
    assert len(held) == len(set(held))


@pytest.mark.parametrize("change", [{"height": 3.2}, {"site": 0.39}, {"rows": (0.6, 0.9, 1.28, 1.82, 2.18, 2.52)}])
def test_a_canvas_that_cannot_work_is_refused(change):
    with pytest.raises(ParameterError, match=next(iter(change))):
        dataclasses.replace(Canvas(), **change)
