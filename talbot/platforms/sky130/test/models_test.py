"""The models that a deck loads, at every corner."""

import pytest

from talbot.models.parameters import ParameterError
from talbot.platforms.sky130 import models

pytestmark = pytest.mark.needs("layout")
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


def values(lines, name):
    return {line.partition("=")[2].strip() for line in lines if line.startswith(f"+ {name} =")}


def test_leakage_is_that_of_the_worst_case_models_but_at_tt_and_not_fitted():
    """SkyWater's own ss tables have the leakage of "leak": the models for timing give a thousandth of it."""
    leak = {process: models.cards("fitted", process, SIZES, leakage=True) for process in ("tt", "ss", "ff", "sf")}
    assert leak["ss"] == leak["ff"] == leak["sf"] != leak["tt"]
    assert all("mulu0" not in line for line in leak["ss"]) and "1" not in values(leak["ss"], "kvsat")


@pytest.mark.parametrize("device, shift", [("nfet_01v8", False), ("pfet_01v8_hvt", True), ("pfet_01v8", True)])
def test_the_fitted_models_have_the_stress_that_published_delays_show(device, shift):
    size = {(f"sky130_fd_pr__{device}", 1.0, 0.15)}
    binned, fitted = (models.cards(name, "ss", size) for name in ("binned", "fitted"))
    assert values(fitted, "kvsat") == {"{1}"} != values(binned, "kvsat")
    (before,), (after,) = values(binned, "kvth0"), values(fitted, "kvth0")
    assert after == (f"{{1.4*({before.strip('{}')})}}" if shift else before)
    assert sum("mulu0" in line for line in fitted) == 1
