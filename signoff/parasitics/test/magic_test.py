"""Capacitances of crossing lines as Magic extracts them, where an installed PDK has its technology file."""

import os
import re
from pathlib import Path

import numpy as np
import pytest

from talbot.base.gds import write_gds
from talbot.base.tools import finish
from talbot.signoff.parasitics.capacitance import capacitances
from talbot.signoff.parasitics.shapes import shapes
from talbot.signoff.parasitics.test.planted import DEVICES, M1, M2, M3, TECH, layout

TECHNOLOGY = Path(os.environ.get("PDK_ROOT", "/nowhere")) / "sky130A" / "libs.tech" / "magic" / "sky130A.tech"
SCRIPT = """drc off
gds read {gds}
load top
select top cell
extract style ngspice()
extract do all
extract do local
extract all
quit -noprompt
"""
DBU_OF_MAGIC = 5  # its units in sky130A.tech are 5 nm


def magic(folder, made):
    """Capacitance (fF) of every node, and (level's name, x, y) of a corner of it, um."""
    write_gds(made, folder / "top.gds")
    (folder / "run.tcl").write_text(SCRIPT.format(gds=folder / "top.gds"))
    options = ["-dnull", "-noconsole", "-T", TECHNOLOGY, "-rcfile", "/dev/null"]
    finish(["magic", *options, folder / "run.tcl"], {**os.environ}, folder)
    text = (folder / "top.ext").read_text()
    names = {f"m{k}": f"met{k}" for k in (1, 2, 3)}
    nodes = re.findall(r'(?m)^node "(.*?)" \S+ (\S+) (\S+) (\S+) (m\d)', text)
    total = {name: float(af) for name, af, *_ in nodes}
    for one, other, af in re.findall(r'(?m)^cap "(.*?)" "(.*?)" (\S+)', text):
        for name in {one, other} & set(total):
            total[name] += float(af)
    at = {name: (names[layer], float(x), float(y)) for name, _, x, y, layer in nodes}
    return [(total[name] / 1000, *at[name]) for name in total]


@pytest.mark.needs("magic", "PDK_ROOT", "layout")
def test_crossing_lines_are_as_in_magic(tmp_path):
    lines = [(M1, 0, 0.7 * k, 20, 0.7 * k + 0.3) for k in range(12)]
    lines += [(M2, 1.4 * k + 0.5, -2, 1.4 * k + 0.8, 12) for k in range(12)]
    lines += [(M3, 0, 1.5 * k, 20, 1.5 * k + 0.4) for k in range(6)]
    made = layout(*lines)
    nodes = magic(tmp_path, made)
    found = shapes(made, made.cell("top"), TECH, DEVICES)
    own = np.bincount(found.nets, capacitances(found, [TECH.wires["typ"]])[0].own)
    pairs = []
    for femto, level, x, y in nodes:
        place = (round(v * DBU_OF_MAGIC) + 2 for v in (x, y))
        pairs.append((own[found.nets[found.at(found.names.index(level), *place)]], femto))
    ours, theirs = np.transpose(pairs)
    assert len(pairs) == len(lines)
    assert ours.sum() == pytest.approx(theirs.sum(), rel=0.25)
    assert np.abs(ours / theirs - 1).max() < 0.4
