"""The deck on cells of the wheel: each is its own SPICE, and a changed transistor or name is found."""

import pytest

from talbot.flow.openroad.lvs import Lvs, spice, subcircuits
from talbot.flow.openroad.netlists import routed_netlist
from talbot.platforms.openroad import openroad_platform
from talbot.platforms.sky130 import cells as sky130_hd
from talbot.platforms.sky130 import layers

LIBRARY = openroad_platform("sky130").library


pytestmark = pytest.mark.needs("layout", "klayout", "yosys")


def compared(cell, folder, change=lambda text: text):
    """The verdict on a layout of ``cell`` and a tap next to it; change: of the SPICE text."""
    import klayout.db as db

    text = sky130_hd.file(cell, "spice").read_text()
    ports = subcircuits(text)[f"{LIBRARY}__{cell}"][0]
    made, at = db.Layout(), 0
    for name in (cell, "tapvpwrvgnd_1"):
        made.read(str(sky130_hd.file(name, "gds")))
    top = made.create_cell("Top")
    for name in (cell, "tapvpwrvgnd_1"):
        placed = made.cell(f"{LIBRARY}__{name}")
        top.insert(db.CellInstArray(placed.cell_index(), db.Trans(at, 0)))
        at += placed.bbox_per_layer(made.layer(*layers.CELL_OUTLINE)).width()
        for layer in (made.layer(67, 5), made.layer(68, 5)) if name == cell else ():
            for shape in placed.shapes(layer).each(db.Shapes.STexts):
                top.shapes(layer).insert(shape.text)
    made.write(str(folder / "top.gds"))
    names = [port for port in ports if port not in ("VPB", "VNB")]
    pins = ", ".join(f".{port}({ {'VPB': 'VPWR', 'VNB': 'VGND'}.get(port, port) })" for port in ports)
    declared = "".join(f"inout {name};" for name in names)
    verilog = f"module Top ({', '.join(names)}); {declared} {LIBRARY}__{cell} x ({pins}); endmodule\n"
    (folder / "top.v").write_text(verilog)
    (folder / "cells.spice").write_text(change(text))
    inputs = {"gds": folder / "top.gds", "powered": folder / "top.v", "cells": folder / "cells.spice"}
    outputs = {name: folder / file for name, file in Lvs.outputs.items()}
    return Lvs().run(inputs, outputs)


@pytest.mark.parametrize("cell", ["inv_1", "nand2_1", "conb_1", "dfxtp_1"])
def test_a_cell_is_its_own_netlist(cell, tmp_path):
    assert compared(cell, tmp_path)["lvs_match"]


@pytest.mark.parametrize(
    "change",
    [
        lambda text: text.replace("w=650000u", "w=640000u").replace("w=0.65", "w=0.64"),
        lambda text: text.replace(" A Y ", " Y A "),
    ],
)
def test_another_netlist_does_not_match(change, tmp_path):
    assert not compared("inv_1", tmp_path, change)["lvs_match"]


def test_lengths_in_either_unit_are_micrometers(tmp_path):
    text = ".subckt a X\nX0 X X X X sky130_fd_pr__nfet_01v8 w=650000u l=0.15\n.ends\n"
    assert subcircuits(text)["a"][1] == ["M0 X X X X NFET W=0.65U L=0.15U"]
    (tmp_path / "a.v").write_text("module Top (X); inout X; a one (.X(X)); fill two (); endmodule\n")
    lines = spice(routed_netlist(tmp_path / "a.v", "Top"), subcircuits(text)).splitlines()
    assert lines[:3] == [".subckt Top X", "X0 X a", ".ends"]
