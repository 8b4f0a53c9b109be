"""The bench from its frames to a calibration, and that in the hands of another command."""

import json
from functools import partial

import pytest

from talbot.commands import main
from talbot.imaging.calibrate import measure, page
from talbot.models.calibrate import read_calibration
from talbot.models.parameters import ParameterError


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    """Folder and summary of a small bench behind a lens that is not telecentric."""
    folder = tmp_path_factory.mktemp("calibrate")
    words = "--rows=24", "--cols=24", "--holes=7", "--pupil=0.012"
    with pytest.MonkeyPatch.context() as patch:  # the picture by few disparities
        patch.setattr(measure, "prior_of", partial(measure.prior_of, disparities=3))
        assert main(["calibrate", *words, f"--out={folder}"]) == 0
    return folder, json.loads((folder / "summary.json").read_text())


def test_it_finds_what_it_did_not_read(done):
    _, s = done
    for kind in s["types"]:
        assert kind["beta"] == pytest.approx(kind["beta_true"], abs=0.1)
        assert kind["m"] == pytest.approx(kind["m_true"], abs=0.03)
        assert kind["alpha"] == pytest.approx(kind["alpha_true"], abs=0.03)
    assert s["response_rms"] < 0.02 < 0.4 < s["response_rms_constant"]
    assert s["pupil_power"] == pytest.approx(s["pupil_power_true"], rel=0.05)
    assert max(map(abs, s["centre"])) < 1 and s["condition"] < 50 and s["gains_rms"] < 0.02


def test_the_picture_hardly_shows_it(done):
    _, s = done
    for name, calibrated in s["picture"]["calibrated"].items():
        assert calibrated > s["picture"]["true_optics"][name] - 0.3


def test_files(done):
    folder, s = done
    assert {path.name for path in folder.iterdir()} == {*page.NAMES}
    assert f"{s['response_rms']:.4f}" in (folder / "calibrate.html").read_text()
    assert len(read_calibration(folder / "calibration.json").types) == 24


@pytest.mark.slow
def test_lightfield_knows_it_in_place_of_the_truth(done, tmp_path):
    folder, _ = done
    words = "--rows=24", "--cols=24", "--pupil=0.012", "--golden", "--disparities=5"
    known = f"--calibration={folder / 'calibration.json'}"
    assert main(["lightfield", *words, known, f"--out={tmp_path}"]) == 0
    s = json.loads((tmp_path / "summary.json").read_text())
    for name, true in s["true_optics"].items():
        assert s["methods"][name]["psnr_db"] == pytest.approx(true, abs=0.5)
    assert s["true_optics"]["linear"] != s["methods"]["linear"]["psnr_db"]


@pytest.mark.parametrize(
    "word, message",
    [
        ("--holes=4", "holes = '4': must be an integer in 5..31"),
        ("--rows=2", "must hold every pixel type"),
        ("--scene=none", "scene = 'none': must be an image file or one of "),
    ],
)
def test_bad_arguments(word, message, capsys, tmp_path):
    assert main(["calibrate", word, f"--out={tmp_path / 'out'}"]) == 2
    err = capsys.readouterr().err
    assert message in err and not (tmp_path / "out").exists()
    assert "flat field" not in err  # before any work


def test_no_such_calibration(capsys, tmp_path):
    words = "--calibration=none.json", f"--out={tmp_path / 'out'}"
    assert main(["lightfield", *words]) == 2
    assert "calibration = 'none.json': must be a calibration.json" in capsys.readouterr().err


@pytest.mark.parametrize(
    "text, words, size",
    [
        ("", [], (96, 96)),
        ("array.rows = 48\narray.cols = 60\n", [], (48, 60)),
        ("array.rows = 48\narray.cols = 60\n", ["--rows=30"], (30, 60)),
    ],
)
def test_the_size_is_that_of_a_sensor_file(text, words, size, tmp_path, monkeypatch):
    sizes = []

    def calibrate(request, *_):
        sizes.append(request.sensor.shape)
        raise ParameterError("seen")

    monkeypatch.setattr(measure, "calibrate", calibrate)
    (tmp_path / "odd.toml").write_text(text)
    file = [f"--sensor={tmp_path / 'odd.toml'}"] if text else []
    assert main(["calibrate", f"--out={tmp_path / 'out'}", *file, *words]) == 2
    assert sizes == [size]
