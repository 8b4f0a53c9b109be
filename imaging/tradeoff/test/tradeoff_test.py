import csv

import numpy as np
import pytest

from talbot.imaging.frame.job import golden_result
from talbot.imaging.frame.light_field import pair_of, reached
from talbot.imaging.frame.request import STANDARD, request
from talbot.imaging.tradeoff import fixed_pattern, light_field, light_field_sensor, views
from talbot.imaging.tradeoff.sweeps import SWEEPS, lines, measured, run_sweeps
from talbot.models.afe import FrontEnd
from talbot.models.parameters import ParameterError
from talbot.models.pixel.weights import view_weights

QUICK = ("views",)


@pytest.fixture(scope="module")
def few(tmp_path_factory):
    """Folder and rows of the sweeps that take a few seconds each."""
    out = tmp_path_factory.mktemp("tradeoff")
    return out, run_sweeps(out, QUICK, quick=True, store=tmp_path_factory.mktemp("kept"))


@pytest.fixture(scope="module")
def tables(tmp_path_factory):
    """Folder and rows of all sweeps, quick: 90 s of processor time."""
    out = tmp_path_factory.mktemp("tradeoff")
    return out, run_sweeps(out, quick=True, store=tmp_path_factory.mktemp("kept"))


def test_a_sweep_writes_its_table_and_plot(few):
    check_files(*few, QUICK)


@pytest.mark.slow
def test_every_sweep_writes_its_table_and_plot(tables):
    check_files(*tables, SWEEPS)


def check_files(out, rows, names):
    for name in names:
        with open(out / f"{name}.csv", encoding="utf-8", newline="") as file:
            read = list(csv.DictReader(file))
        assert len(read) == len(rows[name]) and set(read[0]) == set(rows[name][0])
        assert (out / f"{name}.png").read_bytes().startswith(b"\x89PNG")
    assert {p.name for p in out.iterdir()} == {"tradeoff.html", *(f"{n}.{e}" for n in names for e in ("csv", "png"))}


@pytest.mark.slow
def test_the_verilog_agreed_everywhere(tables):
    for name in ("divider", "threshold", "exposure", "light", "lens", "noise"):
        assert all(row["mismatches"] == 0 for row in tables[1][name])


@pytest.mark.slow
def test_wider_dividers_err_less_and_take_longer(tables):
    for variant in ("radix2", "cordic"):
        narrow, wide = (row for row in tables[1]["divider"] if row["variant"] == variant)
        assert wide["worst_lsb"] < narrow["worst_lsb"] and wide["latency"] > narrow["latency"]


@pytest.mark.slow
def test_higher_thresholds_send_less_and_err_more(tables):
    rows = tables[1]["threshold"]
    assert not any(row["mismatches"] for row in rows)
    assert [r["bytes"] for r in rows] == sorted((r["bytes"] for r in rows), reverse=True)
    assert rows[0]["psnr_edges_db"] > rows[-1]["psnr_edges_db"]


@pytest.mark.slow
def test_a_longer_lead_lights_more_and_takes_longer(tables):
    """From next to no light past a full well, and all rows integrate as long."""
    rows = tables[1]["exposure"]
    for name in ("integration_ms", "frame_ms", "white_of_full_well", "snr_edges_db"):
        values = [r[name] or 0.0 for r in rows]  # nothing of an edge at all: None
        assert values == sorted(values) and len(set(values)) == len(values)
    assert not any(row["deviating_rows"] for row in rows)


@pytest.mark.slow
def test_less_light_takes_longer(tables):
    """The pointer leads by as many rows as the light asks for: white is as bright, until its lead ends."""
    rows = tables[1]["light"]
    times = [r["integration_ms"] for r in rows]
    assert times == sorted(times, reverse=True) and len(set(times)) == len(times)
    assert rows[1]["white_of_full_well"] == pytest.approx(0.8, rel=0.05)
    assert rows[0]["white_of_full_well"] <= 0.81


@pytest.mark.slow
def test_a_slower_lens_takes_longer_and_fewer_views(tables):
    rows = tables[1]["lens"]
    lenses = [r for r in rows if r["focus_m"] == rows[0]["focus_m"]]
    times, views = ([r[name] for r in lenses] for name in ("frame_ms", "views"))
    assert times == sorted(times) and len(set(times)) == len(times) == 2
    assert views == sorted(views, reverse=True) and views[0] > views[-1]
    assert len({r["focus_m"] for r in rows}) == 2 and all(r["quadrature_error_codes"] < 0.5 for r in rows)


def test_more_nodes_err_less_for_uniform_light(few):
    coarse, fine = (r["worst"] for r in few[1]["views"] if r["light"] == "uniform" and r["views"] == 5)
    assert fine < coarse / 10


@pytest.mark.slow
def test_denser_patches_and_more_atoms_err_less(tables):
    found = [r for r in tables[1]["light_field"] if r["noise"] == "physical"]
    rows = {(r["method"], r["setting"]): r["psnr_db"] for r in found}
    by_stride = [rows["sparse", setting] for setting in ("stride 9", "stride 5", "")]
    assert by_stride == sorted(by_stride)
    assert rows["sparse", "atoms 64"] < rows["sparse", "atoms 192"] < rows["sparse", ""]
    assert rows["direct", ""] + 2 < rows["sparse", ""] < rows["linear", ""]


@pytest.mark.slow
def test_noise_is_what_its_label_says(tables):
    """Of white, in the samples; the sum image, of two of them, loses by it, and an estimate still gains on that."""
    result = golden_result(request(rows=48, cols=48, mode="raw"))
    error = light_field.noisy(result, 0.1) - pair_of(result, result.exposed.ideal)
    assert error.std() == pytest.approx(0.1, rel=0.03)
    rows = {(r["noise"], r["method"]): r for r in tables[1]["light_field"] if not r["setting"]}
    noises = "physical", "0.1 of white"
    clean, free = (10 ** -((r["psnr_db"] - r["gain_db"]) / 10) for r in (rows[n, "linear"] for n in noises))
    share = (free - clean) / (reached(result).mean() * 0.1**2 / 2)
    assert 0.7 < share < 1.05  # sums below 0 are clipped, which takes noise from dark pixels
    assert rows["0.1 of white", "linear"]["gain_db"] > 1


def test_a_sweep_goes_on_from_what_is_kept(tmp_path, monkeypatch):
    monkeypatch.setattr(views, "points", lambda quick: [("uniform", 3, 1)])
    first = measured("views", store=tmp_path)
    monkeypatch.setattr(views, "sampling_error", None)  # not called again
    assert measured("views", store=tmp_path) == first
    with pytest.raises(TypeError):
        measured("views", store=tmp_path / "empty")


@pytest.mark.slow
def test_fewer_bits_and_gated_differences_cost_light_field(tables):
    rows = {(r["what"], r["value"]): r for r in tables[1]["light_field_sensor"]}
    assert rows["bits", 3]["mixture_psnr_db"] + 1 < rows["bits", 8]["mixture_psnr_db"]
    assert rows["threshold", 32]["sent"] < 0.5
    assert rows["threshold", 32]["mixture_psnr_db"] < rows["bits", 8]["mixture_psnr_db"]


@pytest.mark.parametrize("layout", light_field_sensor.LAYOUTS)
def test_every_layout_shares_the_light(layout):
    weights = view_weights(light_field_sensor.tile(layout), STANDARD.optics)
    assert weights.min() >= 0 and weights.shape == (24, 2, 5, 5)
    np.testing.assert_allclose(weights.sum((1, 2, 3)), 2, rtol=0.02)


def test_unknown_sweep_is_named(tmp_path):
    with pytest.raises(ParameterError, match="only = 'speed'"):
        run_sweeps(tmp_path / "out", ["speed"])
    assert not (tmp_path / "out").exists()


def test_a_ratio_takes_a_columns_offset_away_at_one_light():
    """An offset does at any; a ratio that is off is a ratio's to take."""
    front_end = FrontEnd(4.0, (0,) * 24)
    rng = np.random.default_rng(3)
    offset, ratio = rng.normal(0, 0.5, 48), rng.normal(1, 0.02, 48)

    def seen(light, ratio=1.0, offset=0.0):
        out = np.full((40, 48, 2), light)
        out[..., 0] = ratio * light + offset
        return out

    def left(at, **off):
        samples = fixed_pattern.fitted(seen(at, **off)[None], seen(50.0, **off), front_end)
        return {name: front_end.values(one, "edge").std() for name, one in samples.items()}

    same, darker = left(50.0, offset=offset), left(5.0, offset=offset)
    assert same["column"] < 0.2 and darker["column"] > 0.8 * darker["tile"] > 1
    assert same["offset"] < 1e-9 and darker["offset"] < 1e-9
    assert left(5.0, ratio=ratio)["column"] < 0.02 < left(5.0, ratio=ratio)["tile"]


def test_a_sweep_goes_into_a_document():
    assert (
        lines([{"threshold": 1024, "sent_x": 0.12345}]) == "| threshold | sent x |\n| ---: | ---: |\n| 1024 | 0.123 |\n"
    )
