"""The cells that `timing` measures are those of the library with an input, with their parasitics."""

import json

import pytest

from talbot.flow.layout.steps.timing import sources_of
from talbot.platforms.extraction import device_models, extraction_platform
from talbot.platforms.sky130 import cells

pytestmark = pytest.mark.needs("layout")

FUNCTIONS = """library(sky130) {
 cell(sky130_fd_sc_hd__inv_1) {
  pin(A) { direction : input; }
 }
 cell(sky130_fd_sc_hd__conb_1) {
  pin(HI) { direction : output; function : "1"; }
 }
}
"""


def test_a_source_for_every_cell_with_an_input(tmp_path):
    from talbot.cells.characterize.job import cell_of  # it reads layouts

    models = device_models("sky130")
    inputs = {
        "areas": tmp_path / "areas.json",
        "functions": tmp_path / "functions.lib",
        "gds": cells.file("inv_1", "gds"),
    }
    inputs["areas"].write_text(json.dumps({"sky130_fd_sc_hd__inv_1": 3.75}))
    inputs["functions"].write_text(FUNCTIONS)
    (source,) = sources_of(inputs, extraction_platform("sky130"))
    assert (source.name, source.area) == ("sky130_fd_sc_hd__inv_1", 3.75)
    assert list(cell_of(source, models).functions) == ["Y"]
