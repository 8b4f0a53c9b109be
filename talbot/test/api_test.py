"""The public API as a stranger uses it: README's example, and a sensor, a response and a light field of one's own."""

import copy
import gzip
import json
import pickle
import re
import subprocess
import sys
from functools import partial

import numpy as np
import pytest

import talbot
from talbot.api.run_file import BESIDE, FILE
from talbot.base.paths import ROOT
from talbot.commands import main
from talbot.imaging.frame import light_field as frame_light_field
from talbot.imaging.tradeoff.sweeps import SWEEPS
from talbot.models.parameters import AmpTiming, circuit_converter
from talbot.models.reconstruct.methods import METHODS


@pytest.mark.parametrize("how", ["golden", pytest.param("simulate", marks=pytest.mark.slow)])
def test_own_light_field_tile_and_response(how, tmp_path):
    y, x = np.mgrid[:24, :36] / 36
    steps = np.arange(-2, 3)
    views = np.array([[0.5 + 0.4 * np.sin(30 * (x + 0.02 * (u + v))) for u in steps] for v in steps])
    lf = talbot.LightField(views, disparity=np.full((24, 36), 0.02 * 36))

    def grating(theta_x, theta_y):
        wave = 0.6 * np.cos(15 * theta_x)
        return [1 + wave, 1 - wave]

    sine = talbot.PixelType(beta=18, gamma_deg=0, alpha=np.pi / 2)
    own = talbot.PixelType(beta=15, gamma_deg=0, alpha=0, response=grating)
    weak = talbot.PixelType(beta=18, gamma_deg=90, alpha=np.pi / 2, m=0.4)
    sensor = talbot.Sensor(rows=24, cols=36, lanes=4, m=0.6, tile=[[sine, own], [weak, sine]])
    golden = sensor.golden(lf, mode="raw", seed=3)
    run = sensor.simulate(lf, mode="raw", seed=3) if how == "simulate" else golden
    assert run.stream == golden.stream and not run.summary.get("stream_mismatches")
    (frame,) = talbot.decode(run.stream, sensor)
    np.testing.assert_array_equal(frame.samples, run.samples)
    image, found = run.reconstruct("image"), run.reconstruct("light_field")
    assert np.corrcoef(image.ravel(), views[2, 2].ravel())[0, 1] > 0.99
    assert found.values.shape == views.shape
    with pytest.raises(talbot.ParameterError, match="response"):
        golden.save(tmp_path / "run")
    assert not (tmp_path / "run").exists()
    for shown in (run, lf, found, image, frame):
        assert shown._repr_png_().startswith(b"\x89PNG")


def test_the_same_bytes_as_the_command_line(tmp_path):
    codes = np.random.default_rng(0).integers(0, 256, (3, 3, 13, 50, 3), np.uint8)
    sensor = talbot.Sensor(rows=13, cols=50, lanes=4, f_number=2)
    sensor.save(tmp_path / "sensor.toml")
    for name in ("lf.npz", "lf"):
        talbot.LightField(codes).save(tmp_path / name)
    words = ["--scene", tmp_path / "lf", "--sensor", tmp_path / "sensor.toml", "--out", tmp_path / "out"]
    assert main(["sim", "--threshold", "3", *map(str, words)]) == 0
    assert talbot.Sensor.load(tmp_path / "out" / "sensor.toml") == sensor
    for name in ("lf.npz", "lf"):
        run = talbot.Sensor.load(tmp_path / "sensor.toml").simulate(tmp_path / name, threshold=3)
        assert (tmp_path / "out" / "stream.bin").read_bytes() == run.stream
    run.save(tmp_path / "x.run")
    again = talbot.Run.load(tmp_path / "x.run")
    assert again == run and again.summary == run.summary and again.summary["stream_mismatches"] == 0
    (frame,) = talbot.decode(tmp_path / "out" / "stream.bin")
    assert frame.complete and (frame.samples == run.samples).all()


def test_the_example_of_the_readme(tmp_path, monkeypatch):
    (example,) = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(), re.DOTALL)
    monkeypatch.chdir(tmp_path)
    names = {}
    exec(compile(example, "README.md", "exec"), names)
    assert names["near"].shape == names["depth"].shape == names["sharp"].shape == (40, 48)


def test_importing_it_loads_nothing():
    heavy = "numpy", "talbot.flow", "talbot.models", "matplotlib"
    code = f"import talbot, sys; print([name for name in {heavy} if name in sys.modules])"
    assert subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True).stdout == "[]\n"


def test_every_name_is_there_and_documented():
    assert len(talbot.__all__) == 17 and dir(talbot) == sorted(talbot.__all__)
    for name in talbot.__all__:
        value = getattr(talbot, name)
        assert name == "scenes" or value.__doc__
    with pytest.raises(AttributeError, match="no attribute 'sensr'"):
        talbot.sensr  # noqa: B018


def test_a_light_field_is_replaced_whole(tmp_path):
    codes = np.random.default_rng(0).integers(0, 256, (5, 5, 4, 6), np.uint8)
    talbot.LightField(codes, np.ones((4, 6))).save(tmp_path / "lf")
    talbot.LightField(codes[:3, :3]).save(tmp_path / "lf")
    found = talbot.LightField.load(tmp_path / "lf")
    np.testing.assert_array_equal(found.values, codes[:3, :3])
    assert found.data.disparity is None and len(list((tmp_path / "lf").iterdir())) == 9


def test_an_estimate_is_saved_loaded_refocused_and_seen_again(tmp_path, capsys):
    y, x = np.indices((13, 50), float)
    steps = np.arange(-1, 2)
    views = np.array([[0.5 + 0.45 * np.sin(2 * (x + u)) * np.cos(1.5 * (y + v)) for u in steps] for v in steps])
    own, sensor = talbot.LightField(views), talbot.Sensor(rows=13, cols=50, lanes=4)
    run = sensor.golden(own, mode="raw")
    estimate = run.reconstruct("light_field")
    values = np.where(estimate.values < np.quantile(estimate.values, 0.1), -0.23, estimate.values + 0.4)
    field = talbot.LightField(values, name="estimate")
    assert values.max() > 1.05 and field.data.disparity is None
    for name in ("x.npy", "x.npz", "x.png", "x"):
        field.save(tmp_path / name)
        said = capsys.readouterr().err
        found = talbot.LightField.load(tmp_path / name, 3 if name == "x.png" else None)
        if name.startswith("x.n"):
            np.testing.assert_array_equal(found.values, values)
            assert not said
        else:
            np.testing.assert_allclose(found.view(1, 2), np.clip(field.view(1, 2), 0, 1), atol=1e-4)
            assert said.count("\n") == 1 and "are clipped to 0..1 in pictures" in said
        again = sensor.golden(found, mode="edge")
        assert ("below 0, to -0.23: clipped to 0" in capsys.readouterr().err) == name.startswith("x.n")
        assert again.result.exposed.scene.light_field.min() == 0
    assert (
        main(
            ["sim", f"--scene={tmp_path / 'x.npz'}", "--rows=13", "--cols=50", "--lanes=4", f"--out={tmp_path / 'out'}"]
        )
        == 0
    )
    assert "below 0, to -0.23: clipped to 0" in capsys.readouterr().err
    inside = np.s_[3:-3, 3:-3]
    sharp = {d: np.std((estimate.refocus(d) - views[1, 1])[inside]) for d in (-1, 0, 1)}
    assert min(sharp, key=sharp.get) == 1
    disparity = estimate.disparity()
    assert disparity.sure[inside].mean() > 0.9 and abs(disparity[disparity.sure & (x > 3) & (x < 46)] - 1).mean() < 0.2
    assert np.std((estimate.all_in_focus() - views[1, 1])[inside]) < 1.2 * sharp[1] and disparity._repr_png_()
    known = talbot.LightField(views, disparity=np.ones((13, 50)))
    assert (known.disparity() == 1).all() and known.disparity().sure.all()
    np.testing.assert_array_equal(known.all_in_focus(), known.all_in_focus(np.ones((13, 50))))
    for wrong in (lambda: own.refocus(101), lambda: own.disparity(near=-3), lambda: own.all_in_focus(np.ones(3))):
        with pytest.raises(talbot.ParameterError, match="disparity = (101|array)|near = -3"):
            wrong()


@pytest.mark.parametrize(
    "scene, settings, what",
    [
        ("tilted", {"mode": "raw", "window": (0, 2, 1, 4)}, "light_field"),
        ("tilted", {"mode": "raw", "types": [0, 1, 2]}, "light_field"),
        ("moving", {"mode": "edge"}, "image"),
        ("tilted", {"mode": "tof", "phase": True}, "depth"),
    ],
)
def test_a_run_is_equal_after_a_file_a_pickle_and_a_copy(tmp_path, scene, settings, what):
    run = talbot.Sensor(rows=20, cols=30).golden(scene, **settings)
    for path in (tmp_path / "x.run", tmp_path / "folder"):
        run.save(path)
    assert {path.name for path in (tmp_path / "folder").iterdir()} == {FILE, *BESIDE}
    copies = [talbot.Run.load(tmp_path / "x.run"), talbot.Run.load(tmp_path / "folder")]
    for found in (*copies, pickle.loads(pickle.dumps(run)), copy.deepcopy(run)):
        assert found == run and hash(found) == hash(run) and found.summary == run.summary
        mine, its = (getattr(one, "values", one) for one in (run.reconstruct(what), found.reconstruct(what)))
        np.testing.assert_array_equal(its, mine)
    assert run != talbot.Sensor(rows=20, cols=30).golden(scene, **settings, seed=2)
    with pytest.raises(talbot.ParameterError, match="what = 'edges'|method = 'linear'"):
        run.reconstruct("edges" if settings["mode"] == "tof" else "image", method="linear")


def test_files_that_hold_no_run(tmp_path):
    with gzip.open(tmp_path / "program.run", "wb") as file:
        pickle.dump(subprocess.run, file)
    (tmp_path / "text.run").write_text("no run")
    with gzip.open(tmp_path / "other.run", "wb") as file:
        pickle.dump((1, 2, 3), file)
    data = bytearray((tmp_path / "other.run").read_bytes())
    data[-8] ^= 1
    (tmp_path / "damaged.run").write_bytes(data)
    for name, said in (
        ("program", "holds subprocess.run"),
        ("text", "gzip"),
        ("other", "holds 1"),
        ("damaged", "CRC"),
        ("none", "no such"),
    ):
        with pytest.raises(talbot.ParameterError, match=f"path = .*{name}.run': .*{said}"):
            talbot.Run.load(tmp_path / f"{name}.run")


def test_sensors():
    sensor = talbot.Sensor(rows=24, cols=36, m=0.5, converter={"noise": 1.5})
    assert repr(sensor).startswith("Sensor(rows=24, cols=36, m=0.5, converter=")
    assert sensor.replace(m=0.7, converter="circuit") == talbot.Sensor(rows=24, cols=36)
    assert sensor.parameters.converter.noise == 1.5 and sensor.parameters.converter.inl == circuit_converter().inl
    assert "<svg" in sensor._repr_html_() and "m = 0.5\n" in sensor.text
    edge = sensor.golden("coins", window=(1, 3, 0, 4), types=[0, 9], timing={"t_int": 300}, noise=0)
    frame = edge.result.request.frame
    assert frame.mask == 0x201 and frame.timing == AmpTiming(t_int=300) and edge.read.sum() == 3 * 5 * 2
    assert edge.reconstruct("edges").shape == (24, 6, 6)
    assert edge.reconstruct(disparity=np.ones((24, 36))).shape == (24, 36)


VIEWS = np.linspace(0, 1, 3 * 3 * 4 * 6).reshape(3, 3, 4, 6)


@pytest.mark.parametrize(
    "wrong, said",
    [
        (lambda: talbot.Sensor(rowz=3), r"rowz = 3: must be a parameter of a sensor; did you mean rows\?"),
        (lambda: talbot.Sensor(m=2), r"optics.m = 2: must be a number in \[0, 1\] \(Modulation depth"),
        (lambda: talbot.PixelType(beta=18, gamma_deg=0, alpha=7), r"alpha = 7: must be .* in .-6.2832, 6.2832. rad"),
        (lambda: talbot.Sensor(converter="good"), "converter = 'good': must be one of circuit, ideal"),
        (lambda: talbot.Sensor(tile=[[]]), "tile cols = 0: must be an integer in 1..6"),
        (lambda: talbot.Sensor().golden("coins", treshold=3), r"treshold = 3: must be .*; did you mean threshold\?"),
        (lambda: talbot.Sensor().golden("coins", timing={"t_i": 3}), "t_i must be one of its keys"),
        (lambda: talbot.Sensor().golden("coins", timing={"exposure": 3}), "exposure must be one of its keys"),
        (lambda: talbot.Sensor().golden("coins", lux=0), r"lux = 0: must be a number in .0.001, 1000000.0."),
        (lambda: talbot.Sensor().golden("coins", exposure=1024), "exposure = 1024: must be an integer in 0..1023"),
        (lambda: talbot.Sensor().golden("coins", window=(1, 2)), "window = .* must be .row0, row1, col0, col1."),
        (lambda: talbot.Sensor().golden("coins", types=[24]), "types = 24: must be an integer in 0..23"),
        (lambda: talbot.Sensor().golden("coins", overlap="x"), "overlap = 'x': must be one of False, True"),
        (lambda: talbot.Sensor().golden("none.npy"), "no such file"),
        (lambda: talbot.LightField([[1, 2], [3]]), r"light field = no array: must be \(views, views"),
        (lambda: talbot.LightField(np.ma.masked_less(VIEWS, 1)), "light field = a masked array: must have a value ev"),
        (
            lambda: talbot.LightField(VIEWS).save("views.xyz"),
            "path = 'views.xyz': must end in .npy, .npz, .png or .tif",
        ),
        (lambda: talbot.LightField(VIEWS).save("views.jpg"), "path = 'views.jpg': must be .png or .tif, for 16 bits"),
        (lambda: talbot.Sensor().save("/tmp"), "path = '/tmp': must be a file, not a folder"),
        (lambda: talbot.Sensor().sequence(5), "frames = 5: must be a folder, an animated picture, a video, or arrays"),
        (lambda: talbot.Sensor().golden(np.zeros((2, 3))), "must be .views, views, height, width."),
        (lambda: talbot.tradeoff("size"), "name = 'size': must be one of divider, threshold"),
        (lambda: talbot.decode(b""), "0 bytes: the stream is empty"),
    ],
)
def test_what_is_wrong_is_named_in_one_line(wrong, said):
    with pytest.raises(talbot.ParameterError, match=said) as caught:
        wrong()
    assert "\n" not in str(caught.value)


def test_modes_show_what_they_can():
    run = talbot.Sensor(rows=24, cols=36, scale=1, focus=3).golden(mode="tof")
    depth = run.reconstruct("depth")
    assert 1 < np.nanmedian(depth) < 8 and run._repr_html_().startswith("<table>")
    with pytest.raises(talbot.ParameterError, match="what = 'edges': must be one of image, depth in tof mode"):
        run.reconstruct("edges")


def test_a_search_is_a_table_and_sensors(tmp_path):
    task = ROOT / "imaging" / "explore" / "test" / "own.py"
    found = talbot.explore(task, out=tmp_path, trials=4, batch=4, objectives="error,energy_uj", seed=3)
    rows = found.table if isinstance(found.table, list) else found.table.to_dict("records")
    assert len(rows) == 5 and {"point", "front", "error", "energy_uj", "array.rows"} <= rows[0].keys()
    assert found.front and {row["point"] for row in rows if row["front"]} == {*found.front}
    values = next(row for row in rows if row["point"] == found.front[0])
    sensor = found.sensor(found.front[0])
    assert (sensor.parameters.array.rows, sensor.parameters.chip.lanes) == (values["array.rows"], values["chip.lanes"])
    sensor.save(tmp_path / "mine.toml")
    assert talbot.Sensor.load(tmp_path / "mine.toml") == sensor
    assert found.front[0] in found._repr_html_() and "4 points" in repr(found)
    with pytest.raises(talbot.ParameterError, match="point = 'best': must be one of thesis, 0000"):
        found.sensor("best")
    with pytest.raises(talbot.ParameterError, match="number = 'trails'"):
        talbot.explore(task, out=tmp_path, trails=4)


@pytest.mark.slow
def test_a_tradeoff_is_a_table_and_a_plot():
    found = talbot.tradeoff("views", quick=True)
    assert len(found.rows) == 8 and found.rows[0]["views"] == 3
    assert found._repr_png_().startswith(b"\x89PNG") and "<table>" in found._repr_html_()
    assert repr(found) == f"<Tradeoff of 8 points: {', '.join(found.rows[0])}>"
    assert all(re.search(rf"\b{name}\b", talbot.tradeoff.__doc__) for name in SWEEPS)


FAST = "direct", "linear", "mixture"  # imaging/lightfield/test has every method


def test_a_light_field_by_a_method(monkeypatch):
    monkeypatch.setattr(frame_light_field, "prior_of", partial(frame_light_field.prior_of, disparities=7))
    run = talbot.Sensor(rows=24, cols=24).golden("tilted", mode="raw")
    truth = run.result.exposed.scene.full_light_field
    error = {name: np.std(run.reconstruct("light_field", method=name).values - truth) for name in FAST}
    assert error["mixture"] < error["linear"] < error["direct"]
    assert (run.reconstruct("light_field").values == run.reconstruct("light_field", method="linear").values).all()
    assert run.summary["light_field_method"] == "linear"
    found, disparity = run.reconstruct("disparity"), run.result.exposed.scene.disparity
    sure = ~np.isnan(found)
    constant = np.abs(disparity - disparity.mean())[sure].mean()
    assert sure.mean() > 0.5 and np.abs(found - disparity)[sure].mean() < 0.6 * constant
    for what, method, said in (("light_field", "best", ", ".join(METHODS)), ("image", "linear", "left out")):
        with pytest.raises(talbot.ParameterError, match=f"method = '{method}': must be .*{said}"):
            run.reconstruct(what, method=method)


@pytest.mark.slow
def test_polarization_of_a_run_is_that_of_the_command(tmp_path):
    run = talbot.Sensor(rows=48, cols=54).golden("specular", mode="raw")
    found = run.polarization(highlight=0.05)
    words = "--rows=48", "--cols=54", "--golden", "--highlight=0.05", f"--out={tmp_path}"
    assert main(["polar", *words]) == 0
    said = json.loads((tmp_path / "summary.json").read_text())
    assert found.summary["psi_error_deg"] == said["psi_error_deg"] and found.summary["f1"] == said["f1"]
    assert found.psi.shape == found.highlights.shape == (48, 54) and found.highlights.any()
    assert repr(found) == "<Polarization of 48 x 54 pixels>"
    assert np.abs(found.psi).max() <= np.pi / 2 and 0 <= found.degree.min() <= found.degree.max() <= 1
    assert found._repr_png_().startswith(b"\x89PNG") and "<table>" in found._repr_html_()
    for wrong in (lambda: run.depth(), lambda: run.polarization(highlight=-1)):
        with pytest.raises(talbot.ParameterError, match="mode = 'raw': must be 'tof'|highlight = -1"):
            wrong()


@pytest.mark.slow
def test_depth_of_a_run_is_that_of_the_command(tmp_path):
    lens = {"focal_length": 25e-3, "focus": 3.0, "scale": 1.0}
    sensor = talbot.Sensor(rows=40, cols=48, f_mod=100e6, **lens)
    run = sensor.golden("tilted", mode="tof")
    found = run.depth(disparities=11)
    sensor.save(tmp_path / "sensor.toml")
    words = f"--sensor={tmp_path / 'sensor.toml'}", "--scene=tilted", "--disparities=11", "--golden"
    assert main(["depth", *words, f"--out={tmp_path / 'out'}"]) == 0
    said = json.loads((tmp_path / "out" / "summary.json").read_text())
    assert found.summary["depth_rms_m"] == said["depth_rms_m"]
    truth = run.result.exposed.scene.depth
    error = np.sqrt(np.mean((found.depth - truth)[found.sure] ** 2))
    assert error == pytest.approx(said["depth_rms_m"]) and found.behind is None
    assert error < 0.05 * np.ptp(truth) < np.nanstd(run.reconstruct("depth") - truth)  # a phase alone wraps
    assert found.light_field.values.shape == (5, 5, 40, 48) and found._repr_png_().startswith(b"\x89PNG")
    assert repr(found).startswith("<Depth of 40 x 48 pixels, ")
    with pytest.raises(talbot.ParameterError, match="mode = 'tof': must be 'raw'"):
        run.polarization()
    with pytest.raises(talbot.ParameterError, match="near = -3"):
        run.depth(near=-3)
