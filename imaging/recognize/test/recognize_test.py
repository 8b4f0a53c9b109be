"""The command from data to page, its figures and baselines, the chip's bytes, and what is refused."""

import gzip
import json
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from talbot.api.recognize import recognize
from talbot.commands import main
from talbot.imaging.recognize import chip, gestures, intensity, page, pose, study
from talbot.imaging.recognize.data import load, picture
from talbot.imaging.recognize.job import Study, as_trained
from talbot.imaging.recognize.study import Setting, evaluate, noisy, reduced, see
from talbot.imaging.recognize.wake import watch
from talbot.models.afe import FrontEnd
from talbot.models.parameters import STANDARD, ParameterError
from talbot.models.recognition.optics import Display

SMALL = ("--count", "60", "--seeds", "2", "--scale", "3", "--workers", "1", "--golden")


@pytest.fixture(scope="module")
def digits():
    return load("digits").part(120)


def test_the_command_writes_every_accuracy_with_its_baselines(tmp_path, capsys):
    out = tmp_path / "out"
    assert main(["recognize", *SMALL, "--some", "60", "--curves", "threshold", "--out", str(out)]) == 0
    s = json.loads((out / "summary.json").read_text())
    keys = [
        "accuracy",
        "accuracy_std",
        "baselines",
        "energy_uj",
        "bytes",
        "flops_first_layer",
        "flops_total",
        "seconds",
    ]
    assert all(key in s for key in keys)
    assert {"image", "same_bytes", "random", "chance"} <= s["baselines"].keys()
    assert all({"accuracy", "accuracy_std"} <= row.keys() for row in s["baselines"].values())
    assert s["accuracy"] > 2 * s["baselines"]["chance"]["accuracy"] > 0
    assert s["rows"]["same_bytes"]["bytes"] <= s["bytes"] and s["energy_uj"][0] <= s["energy_uj"][1]
    assert "plain image in at most as many bytes" in capsys.readouterr().out
    page = (out / "recognize.html").read_text()
    assert "<svg" in page and "chance" in page
    with np.load(out / "features.npz") as file:
        assert file["features"].shape == (60, 12, 12, 12) and file["labels"].shape == (60,)


def test_a_second_run_takes_the_kept_parts(tmp_path, monkeypatch):
    words = ["recognize", *SMALL, "--curves", "none", "--front", "gradient", "--out", str(tmp_path / "o")]
    assert main(words) == 0
    first = json.loads((tmp_path / "o" / "summary.json").read_text())
    monkeypatch.setattr(study.kernel, "train", None)  # nothing is trained again
    assert main(words) == 0
    again = json.loads((tmp_path / "o" / "summary.json").read_text())
    assert again["rows"] == first["rows"]


def test_codes_are_the_golden_chips_and_its_ternary_mode_sends_their_signs(digits):
    display = Display(STANDARD, (8, 8), 3, 12.0)
    pictures = digits.radiance[:2]
    got = chip.read(display, pictures, "edge", 8, 1.0, 1)
    asked = chip.frame_request(display, "edge", 8, 1.0, 1)
    front_end = chip.trimmed(asked)
    for i, (samples, converters) in enumerate(chip.samples_of(asked, front_end, display, pictures)):
        golden = chip.golden_frame(samples, asked.sensor, asked.frame, converters)
        assert np.array_equal(golden.sent[..., 0], got.codes[i]) and isinstance(converters, FrontEnd)
    ternary = chip.read(display, pictures, "ternary", 8, 1.0, 1)
    assert (ternary.codes != np.sign(got.codes)).mean() < 0.002  # an edge's search may contradict its window
    assert ternary.share > 0 and ternary.bytes < 0.7 * got.bytes
    assert ternary.energy[0] < got.energy[0] < got.image_energy[0]


def test_the_sensor_reads_only_the_types_of_alpha_zero(digits):
    codes = chip.read(Display(STANDARD, (8, 8), 3, 12.0), digits.radiance[:1], "edge", 0, 1.0, 1).codes[0]
    odd = STANDARD.tile.type_map(*codes.shape) % 2 == 1
    assert (codes[odd] == 0).all() and (codes[~odd] != 0).mean() > 0.3


def test_labels_that_mean_nothing_are_not_learned(digits):
    """Neither the split nor the features leak the answer."""
    shuffled = replace(digits, labels=np.random.default_rng(1).permutation(digits.labels))
    found = evaluate(Setting(scale=3, seeds=4), shuffled)
    assert np.mean(found["accuracies"]) < 0.3


def test_more_noise_in_the_pictures_costs_accuracy(digits):
    base = Setting(front="image", seeds=4)
    clean, poor = (np.mean(evaluate(replace(base, snr_db=db), digits)["accuracies"]) for db in (None, -3))
    assert poor < clean - 0.1
    added = noisy(np.full((4, 50, 50), 0.5, np.float32), 20, 1) - 0.5
    assert added.std() == pytest.approx(0.05, rel=0.05)


def test_the_network_beats_chance_and_its_optics_cost_no_first_layer(digits):
    found = evaluate(Setting(scale=3, seeds=1, classifier="lenet", epochs=40), digits)
    assert found["accuracies"][0] > 0.4 and found["flops_first_layer"] == 0
    learned = evaluate(Setting(front="learned", seeds=1, classifier="lenet", epochs=1), digits)
    assert learned["flops_first_layer"] == 8 * 8 * 25 * 12


@pytest.mark.slow
def test_as_many_bytes_as_a_gradient_are_a_picture_too_small_for_a_network(tmp_path):
    words = "--classifier lenet --front gradient --epochs 1 --seeds 1 --count 30 --curves none --golden"
    assert main(["recognize", *words.split(), "--workers", "1", "--out", str(tmp_path / "out")]) == 0
    baselines = json.loads((tmp_path / "out" / "summary.json").read_text())["baselines"]
    assert baselines["same_bytes"]["bytes"] <= baselines["image"]["bytes"] and "learned" in baselines


def test_fewer_bits_are_coarser_codes(digits):
    base = Setting(scale=3, threshold=0)
    fine, coarse = (see(replace(base, bits=bits), digits.radiance[:3]) for bits in (8, 3))
    assert coarse.bytes == pytest.approx(fine.bytes * 3 / 8)
    assert len(np.unique(coarse.channels)) < len(np.unique(fine.channels))


def test_a_reduced_picture_keeps_its_mean_and_a_constant():
    pictures = np.random.default_rng(1).random((2, 9, 9)).astype(np.float32)
    assert np.allclose(reduced(pictures, 4).mean((1, 2)), pictures.mean((1, 2)), atol=1e-6)
    assert np.allclose(reduced(pictures, 9), pictures, atol=1e-6)
    assert np.allclose(reduced(np.ones((1, 7, 7), np.float32), 3), 1)


def test_random_types_are_six_and_differ_by_draw():
    one, two = study.random_tile(1), study.random_tile(2)
    assert one.n_types == 6 and one != two and all(5 <= kind.beta <= 50 and kind.alpha == 0 for kind in one.types)
    assert see(Setting(draw=1, ideal=True), np.ones((2, 8, 8), np.float32)).channels.shape == (2, 12, 12, 6)


def test_a_watch_holds_as_many_events_as_others():
    seen = watch(0.1, 1)
    quiet = np.abs(seen.pairs[~seen.events, 1] / seen.pairs[~seen.events, 0]).std((1, 2))
    assert seen.events.mean() == 0.5 and quiet.max() < 1e-5  # light alone drifts


def test_gestures_are_those_of_their_seed_and_move_as_they_are_named(monkeypatch):
    shown, labels = gestures.clips(16, 1)
    assert np.array_equal(gestures.clips(16, 1)[0], shown) and not np.array_equal(gestures.clips(16, 2)[0], shown)
    monkeypatch.setattr(gestures, "DRIFT", 0)
    monkeypatch.setattr(gestures, "background", lambda rng: np.full((16, 16), 0.4))
    y, x = np.mgrid[:16, :16]
    for frames, label in zip(*gestures.clips(16, 1)):
        shape = np.abs(frames - 0.4)
        area = shape.sum((1, 2))
        measured = {"right": (shape * x).sum((1, 2)) / area, "down": (shape * y).sum((1, 2)) / area, "growing": area}
        move, back = gestures.MOVES[label], {"left": "right", "up": "down", "shrinking": "growing"}
        if (of := back.get(move, move)) in measured:
            steps = np.diff(measured[of])
            assert ((steps > 0) if of == move else (steps < 0)).all()
        else:
            assert np.ptp(area) < 0.1 * area.mean()
    assert np.bincount(labels).tolist() == [2] * 8


def test_temporal_gradients_of_gestures_are_equation_a2(monkeypatch):
    seen, scored = [], study.scored
    monkeypatch.setattr(study, "scored", lambda *words: seen.append(words[-1].channels) or scored(*words))
    rows = gestures.classify(Setting(seeds=2), 24)
    temporal, active = seen[:2]
    assert temporal.shape == (24, 16, 16, 7) and active.shape == (24, 16, 16, 8)
    for n, row, col, t in np.ndindex(2, 16, 16, 7):
        assert temporal[n, row, col, t] == max(0, abs(active[n, row, col, t + 1] - active[n, row, col, t]))
    cheap, dear = (rows[name] for name in ("temporal binary gradients (Eq. A.2)", "differences of plain images"))
    assert cheap["bytes"] == 7 * 32 < dear["bytes"] and 20 * cheap["energy_uj"][1] < dear["energy_uj"][0]


def test_a_ray_meets_the_head_where_it_is_drawn():
    turn, radii, centre = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0], np.array([0.7, 1, 0.8]), 0.1
    v, u = np.mgrid[-1.2:1.2:9j, -1.2:1.2:9j]
    z, point = pose._hit(u, v, turn, np.full(3, centre), radii)
    met = np.isfinite(z)
    assert 10 < met.sum() < 81
    assert np.allclose((((point - centre) / radii) ** 2).sum(-1)[met], 1)
    assert np.allclose((point @ turn.T)[met], np.stack([u, v, z], -1)[met])


def test_the_pose_of_held_out_heads_is_better_than_their_mean():
    shown, angles = pose.heads(8, 1)
    assert np.array_equal(pose.heads(8, 1)[0], shown) and not np.array_equal(pose.heads(8, 2)[0], shown)
    assert (np.abs(angles) <= (45, 30)).all() and shown.shape == (8, 32, 32)
    rows = pose.regress(Setting(seeds=2), 200)["rows"]
    error = {name: row["error_deg"] for name, row in rows.items()}
    mean = error.pop("mean of the angles to learn from")
    assert 15 < mean < 25 and max(error.values()) < 0.75 * mean


def test_intensity_of_held_out_digits_is_better_than_gray(digits):
    rows = intensity.recover(Setting(seeds=2), digits)["rows"]
    psnr = {name: row["psnr_db"] for name, row in rows.items()}
    assert psnr["binary frame, kernel regression"] > psnr["mean of the pictures to learn from"] + 1 > psnr["gray"] + 2
    assert psnr["ternary differences along x and y, Poisson"] > psnr["gray"] + 3
    assert psnr[intensity.JPEG] is None and rows["binary frame, Poisson"]["bytes"] == 8


def test_tables_of_the_tasks_enter_a_document(tmp_path, monkeypatch):
    monkeypatch.setattr(intensity, "SCENE", 16)
    monkeypatch.setattr(intensity, "FACES", 20)
    document = tmp_path / "document.md"
    marks = ("digits", "gestures", "intensity", "pose")
    document.write_text("".join(f"<!-- {mark} -->\n<!-- end of {mark} -->\n" for mark in marks))
    words = ("--some", "16", "--front", "gradient", "--curves", "gestures,intensity,pose", "--document", str(document))
    assert main(["recognize", *SMALL, *words, "--out", str(tmp_path / "o")]) == 0
    s, text = json.loads((tmp_path / "o" / "summary.json").read_text()), document.read_text()
    assert s["intensity"].keys() == {"digits", "faces", "photographs"} and len(s["gestures"]) == 9
    faces = s["intensity"]["faces"]
    assert faces["gray"]["ssim"] < faces["ternary differences along x and y, Poisson"]["ssim"] < 1
    assert len(s["pose"]) == 5 and "| mean of the angles to learn from |" in text
    assert "| temporal binary gradients (Eq. A.2) |" in text and "| JPEG in as many bytes | - |" in text


def test_the_table_of_a_document_has_one_threshold_and_no_row_twice():
    row = {"accuracy": 0.5, "accuracy_std": 0.0, "bytes": 9, "energy_uj": (1.0, 2.0), "network_uj": 1.0}
    s = {"types": 12, "threshold": 10, "rows": dict.fromkeys(("asp", "asp_5", "image"), row)}
    s["rows"]["same_bytes"] = row | {"train_s": 1.0}
    assert len(page.rows(s)) == 4 and len(page.lines(s).splitlines()) == 2 + 2
    s["rows"]["same_bytes"] = row | {"bytes": 8}
    assert len(page.lines(s).splitlines()) == 2 + 3


def test_one_seed_has_no_spread():
    result = {"accuracies": [0.5], "bytes": 9, "energy_uj": (1.0, 2.0), "network_uj": 1.0}
    single, double = (study.figures(result | {"accuracies": values}) for values in ([0.5], [0.5, 0.5]))
    table = page.gesture_table({"gestures": {"one": single, "two": double}})
    assert "| one | 50.00 % | - | 9 | 1 to 2 | 1 |" in table and "| two | 50.00 % | 0.00 | 9 |" in table
    pose = {"error_deg": 1.0, "error_deg_std": None, "yaw_deg": 1.0, "pitch_deg": 1.0}
    assert "| heads | 1.00 | - | 1.00 | 1.00 | 9 |" in page.pose_table({"pose": {"heads": result | pose}})


def labelled(n=30):
    rng = np.random.default_rng(4)
    return rng.integers(0, 256, (n, 9, 7), dtype=np.uint8), rng.permutation(np.arange(n) % 3).astype(np.uint8)


def idx(array):
    return b"\0\0\x08" + bytes([array.ndim]) + np.array(array.shape, ">i4").tobytes() + array.tobytes()


def test_idx_files_have_their_own_test_set(tmp_path):
    images, labels = labelled()
    (tmp_path / "train-images-idx3-ubyte").write_bytes(idx(images))
    (tmp_path / "train-labels-idx1-ubyte.gz").write_bytes(gzip.compress(idx(labels)))
    assert load(str(tmp_path)).test is None
    (tmp_path / "t10k-images.idx3-ubyte").write_bytes(idx(images[:12]))
    (tmp_path / "t10k-labels.idx1-ubyte").write_bytes(idx(labels[:12]))
    data = load(str(tmp_path))
    assert np.array_equal(data.images, np.concatenate([images, images[:12]])) and data.test.sum() == 12
    assert data.split(1)[1].tolist() == data.split(2)[1].tolist() == list(range(30, 42))
    (tmp_path / "train-images-idx3-ubyte").write_bytes(idx(images)[:-3])
    with pytest.raises(ParameterError, match="IDX"):
        load(str(tmp_path))


def test_cifars_batches_are_gray_with_a_test_set(tmp_path):
    rng = np.random.default_rng(5)
    record = rng.integers(0, 10, (20, 3073), dtype=np.uint8)
    record[:, 0] %= 10
    record[3, 1:] = 200
    (tmp_path / "data_batch_1.bin").write_bytes(record.tobytes())
    (tmp_path / "test_batch.bin").write_bytes(record[:5].tobytes())
    data = load(str(tmp_path))
    assert data.images.shape == (25, 32, 32) and (data.images[3] == 200).all() and data.test.sum() == 5
    assert np.array_equal(data.labels[:20], record[:, 0])


def test_a_folder_a_class_and_an_npz(tmp_path):
    images, labels = labelled()
    for i, (pixels, label) in enumerate(zip(images, labels)):
        folder = tmp_path / "pictures" / f"class{label}"
        folder.mkdir(parents=True, exist_ok=True)
        Image.fromarray(pixels).save(folder / f"{i:02}.png")
    data = load(str(tmp_path / "pictures"))
    assert data.images.shape == (30, 28, 28) and np.bincount(data.labels).tolist() == [10, 10, 10]
    Image.fromarray(np.full((20, 40), 90, np.uint8)).save(tmp_path / "wide.png")
    assert (picture(tmp_path / "wide.png") == 90).all()
    np.savez(tmp_path / "own.npz", images=images, labels=labels)
    assert load(str(tmp_path / "own.npz")).classes == 3


@pytest.mark.parametrize(
    ("words", "error"),
    (
        (("--data", "none"), "data = 'none'"),
        (("--front", "asp,asp"), "front = 'asp,asp'"),
        (("--front", "edges"), "front = 'edges'"),
        (("--curves", "beta"), "curves = 'beta'"),
        (("--scale", "0"), "scale = '0'"),
        (("--classifier", "svm"), "classifier = 'svm'"),
        (("--blur", "99"), "blur = '99'"),
    ),
)
def test_bad_input_is_one_line_and_nothing_is_written(words, error, tmp_path, capsys):
    assert main(["recognize", *words, "--out", str(tmp_path / "o")]) == 2
    text = capsys.readouterr().err
    assert error in text and text.count("\n") == 1 and not (tmp_path / "o").exists()


def test_broken_data_are_one_line(tmp_path):
    (tmp_path / "own.npz").write_bytes(b"PK no archive")
    with pytest.raises(ParameterError, match="own.npz"):
        load(str(tmp_path / "own.npz"))
    (tmp_path / "empty").mkdir()
    with pytest.raises(ParameterError, match="must hold IDX files"):
        load(str(tmp_path / "empty"))
    for name in ("train-images-idx3-ubyte.gz", "train-labels-idx1-ubyte.gz"):
        (tmp_path / "empty" / name).write_bytes(gzip.compress(bytes(99))[:20])
    with pytest.raises(ParameterError, match="must be an IDX file"):
        load(str(tmp_path / "empty"))
    images, labels = labelled(200)
    np.savez(tmp_path / "few.npz", images=images, labels=labels, test=np.arange(200) == 0)
    with pytest.raises(ParameterError, match="must leave some"):
        load(str(tmp_path / "few.npz")).part(20)


@pytest.mark.slow
def test_the_verilog_sends_the_golden_chips_bytes(digits):
    display = Display(STANDARD, (8, 8), 3, 12.0)
    edge, signs = (chip.verify(display, digits.radiance[:1], mode, 10, 1.0, 1) for mode in ("edge", "ternary"))
    assert edge["mismatches"] == signs["mismatches"] == 0 and 46 < signs["bytes"] < edge["bytes"]
    for verified in (edge, signs):
        assert verified["cycles"] == pytest.approx(verified["cycles_model"], rel=1e-3)


def test_shipped_weights_are_compared_on_the_pictures_of_their_split_alone():
    whole, setting = load("digits"), Setting()
    assert as_trained(Study(whole, ("asp",), setting))
    assert not as_trained(Study(whole.part(200), ("asp",), setting))
    assert not as_trained(Study(replace(whole, images=255 - whole.images), ("asp",), setting))
    assert not as_trained(Study(whole, ("asp",), replace(setting, blur=3.0)))


def test_shipped_weights_are_small_and_read_digits_without_training():
    assert study.WEIGHTS.stat().st_size <= 100_000
    data = load("digits")
    held = data.split(1)[1][:200]  # not trained on
    found = recognize(data.images[held])
    assert found.features.shape == (200, 12, 12, 12) and found.labels is None
    assert (found.classes == data.labels[held]).mean() > 0.95


def test_own_pictures_in_python_have_features_classes_and_baselines():
    data = load("digits").part(100)
    found = recognize(data.images, data.labels, front="ternary", scale=3, seeds=2)
    assert set(np.unique(np.sign(found.features))) <= {-1, 0, 1} and found.test.sum() == 20
    assert found.summary["baselines"]["chance"]["accuracy"] < found.summary["accuracy"]
    assert (found.classes == data.labels)[~found.test].mean() > 0.95 and "100 pictures" in repr(found)
    own = recognize(data.images, data.labels, test=np.arange(100) >= 90, front="gradient", seeds=1)
    assert np.array_equal(np.flatnonzero(own.test), np.arange(90, 100))


@pytest.mark.parametrize(
    ("call", "error"),
    (
        (lambda: recognize(np.zeros((2, 8, 8))), "pictures = float64"),
        (lambda: recognize(np.zeros((2, 8, 8), np.uint8), front="image"), "labels = None"),
        (lambda: recognize("digits", np.zeros(3)), "labels: "),
        (lambda: recognize("digits", blurr=3), "setting = 'blurr'"),
        (lambda: recognize("digits", seeds=0), "seeds = 0"),
        (lambda: recognize(np.zeros((20, 8, 8), np.uint8), np.arange(20) / 2), "labels = float64"),
        (lambda: recognize(np.zeros((20, 64, 64), np.uint8), np.arange(20) % 2), "scale = 6: must be at most 2"),
        (lambda: recognize(np.zeros((20, 200, 200), np.uint8), np.arange(20) % 2, scale=1), "pictures = 200 x 200"),
        (lambda: recognize(np.zeros((20, 8, 8), np.uint8), np.arange(19) % 2), "images = "),
    ),
)
def test_python_refuses_what_does_not_fit(call, error):
    with pytest.raises(ParameterError, match=error):
        call()
