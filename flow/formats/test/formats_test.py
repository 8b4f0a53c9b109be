"""The comparison: every sample coded once in every order, known frames cost what they must, bad files are named."""

import csv

import numpy as np
import pytest

from talbot.base.command import main
from talbot.flow.formats import command, company
from talbot.flow.formats.codes import entropy_bytes, load_codes, thresholded
from talbot.flow.formats.measure import frame_bytes, growth, measure
from talbot.flow.formats.orders import CHIP, ORDERS, segments_of
from talbot.flow.formats.table import lines
from talbot.flow.formats.tokens import CHOSEN, FORMATS
from talbot.models.digital.stream import StreamHeader, encode_frame
from talbot.models.parameters import FrameParameters, ParameterError, Window


@pytest.fixture
def codes():
    """Sparse codes of an odd size, (22, 45)."""
    rng = np.random.default_rng(2)
    values = rng.laplace(0, 25, (22, 45)) * (rng.random((22, 45)) < 0.2)
    return np.clip(np.rint(values), -128, 127).astype(np.int16), values


@pytest.mark.parametrize("name", ORDERS)
def test_every_order_has_every_sample_once(name):
    segments = segments_of(name, 22, 45)
    assert sorted(np.concatenate(segments)) == list(range(22 * 45))
    assert len(segments) == {"raster": 22, CHIP: 22, "type by type in the frame": 24, "tile by tile": 6}[name]


def test_tiles_follow_each_other():
    assert segments_of("tile by tile", 8, 12)[1][:26].tolist() == [
        row * 12 + col for row in range(4, 8) for col in range(6)
    ] + [54, 55]


@pytest.mark.parametrize("threshold", [0, 12])
def test_the_chosen_format_in_the_chip_s_order_is_the_stream(codes, threshold):
    header = StreamHeader.from_frame(22, 45, 8, FrameParameters(Window(0, 5, 0, 7), threshold=threshold, resync=0))
    sent = thresholded(codes[0], threshold)
    assert frame_bytes(sent, threshold, FORMATS[CHOSEN][0], segments_of(CHIP, 22, 45)) == len(
        encode_frame(header, sent[..., None], 0, 0)
    )


@pytest.mark.parametrize("threshold", [0, 2, 3])
@pytest.mark.parametrize("sigma", [1.3, 2, 4])
def test_the_stream_is_near_the_entropy_of_noise(sigma, threshold):
    """Version 2, with runs alone, took 1.27 to 1.30 times the entropy at 0."""
    noise = np.rint(np.random.default_rng(3).normal(-0.4, sigma, (96, 384))).astype(np.int16)
    sent = thresholded(noise, threshold)
    assert company.stream_bytes(sent, threshold) <= 1.15 * entropy_bytes(sent) + company.FIXED


def test_formats_on_a_known_row():
    """300 zeros, 12, 40 zeros, -90 under a threshold of 10."""
    row = np.array([0] * 300 + [12] + [0] * 40 + [-90], np.int16)
    out = np.zeros(100, np.uint8)
    expected = {"byte pairs": "ff00 2d0c 285a".replace("5a", "a6"), "nibbles": "fffff fffff fffff fffff 02 ffa f a6"}
    for name, text in expected.items():
        size = FORMATS[name][0](row, 10, out)
        digits = text.replace(" ", "")
        assert out[:size].tobytes().hex() == digits + "0" * (len(digits) % 2)


def test_entropy():
    assert entropy_bytes(np.zeros((4, 4), int)) == 0
    assert entropy_bytes(np.array([0, 1] * 8)) == 2
    assert entropy_bytes(np.arange(256)) == 256


def test_noise_grows_by_less_than_a_sixteenth_in_the_chosen_format_alone():
    grown = {name: growth(encoder, (8, 384)) for name, (encoder, _) in FORMATS.items()}
    assert [name for name, ratio in grown.items() if ratio < 17 / 16] == [CHOSEN]


def test_measure(codes):
    rows = measure(*codes, thresholds=(4, 20))
    assert len(rows) == 2 * len(ORDERS) * len(FORMATS)
    assert rows[0]["psnr_db"] > rows[-1]["psnr_db"] and rows[0]["bytes"] > rows[-1]["bytes"]
    assert all(row["ratio"] == pytest.approx(22 * 45 / row["bytes"]) for row in rows)


def test_command(tmp_path, codes, capsys, monkeypatch):
    """Without Yosys: the sizes are left out, and said to be."""
    monkeypatch.setenv("PATH", str(tmp_path))
    np.savez(tmp_path / "c.npz", codes=codes[0], ideal=codes[1])
    document = tmp_path / "d.md"
    document.write_text("before\n<!-- formats -->\nstale\n<!-- end of formats -->\nafter\n")
    arguments = ["--codes", str(tmp_path / "c.npz"), "--out", str(tmp_path / "out"), "--document", str(document)]
    assert main(command, arguments) == 0
    said = capsys.readouterr()
    assert "| byte pairs |" in said.out and "needs Yosys" in said.out and "sizes left out: yosys: not found" in said.err
    with open(tmp_path / "out" / "formats.csv", encoding="utf-8") as file:
        assert {row["order"] for row in csv.DictReader(file)} == set(ORDERS)
    assert (tmp_path / "out" / "formats.png").read_bytes()[:4] == b"\x89PNG"
    text = document.read_text()
    assert text.startswith("before\n") and text.endswith("after\n") and "stale" not in text and "| nibbles |" in text


@pytest.mark.slow
@pytest.mark.needs("yosys")
def test_gates_rank_the_packers():
    gates = command.gates_of_packers()
    assert list(gates) == list(FORMATS)
    assert gates["byte pairs"] < gates["nibbles"] < gates["Golomb-Rice, fixed"] < gates[CHOSEN] < 2500


@pytest.mark.parametrize(
    "content",
    [
        {},
        {"codes": np.zeros(3, int)},
        {"codes": np.zeros((2, 2)), "ideal": np.zeros((2, 2))},
        {"codes": np.full((2, 2), 300), "ideal": np.zeros((2, 2))},
    ],
)
def test_bad_codes_are_named(tmp_path, content):
    np.savez(tmp_path / "c.npz", **content)
    with pytest.raises(ParameterError, match="c.npz"):
        load_codes(tmp_path / "c.npz")


def test_bad_files_are_one_line_and_status_2(tmp_path, capsys):
    (tmp_path / "text.npz").write_text("no archive")
    for name in ("missing.npz", "text.npz"):
        assert main(command, ["--codes", str(tmp_path / name), "--out", str(tmp_path / "out")]) == 2
        error = capsys.readouterr().err
        assert name in error and error.count("\n") == 1
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("share", [0.0, 1e-4, 1e-3, 0.01])
def test_sparse_frames_are_near_their_entropy_and_ahead_of_zstd(share):
    """Values at random places: nothing to gain from their neighbours."""
    rng = np.random.default_rng(3)
    magnitude = np.minimum(rng.geometric(0.15, (384, 384)) + 9, 127)
    codes = np.where(rng.random((384, 384)) < share, magnitude * rng.choice([-1, 1], (384, 384)), 0).astype(np.int16)
    (row,) = company.compare("random", codes, [10])
    assert row["entropy"] == round(entropy_bytes(codes)) and row["samples"] == 384 * 384
    assert row["stream"] <= company.GOAL * row["entropy"] + company.FIXED
    assert row["stream"] <= min(row[coder] for coder in company.CODERS)


def test_noise_grows_by_less_than_a_sixteenth():
    noise = np.random.default_rng(4).integers(-128, 128, (64, 384)).astype(np.int16)
    assert company.stream_bytes(noise, 0) <= noise.size * 17 / 16


def test_golomb_rice_of_a_known_frame():
    """36 times 0, 1, 3 and 4 after the folding; parameter 1: 2, 2, 3 and 4 bits."""
    codes = np.array([[0, 9], [10, -10]], np.int16)
    (row,) = company.compare("known", np.tile(codes, (6, 6)), [9])
    assert row["Golomb-Rice"] == company.FRAME + -(-36 * (2 + 2 + 3 + 4) // 8)


def test_prefix_tables_of_known_frames():
    """Two values of one magnitude level, alike often: a bit each. 13 is of octave 3: three bits more."""
    half = np.tile(np.array([0, 3], np.int16), (4, 8))
    assert company.CODERS["tables"](half) == 4 * (16 // 8 + 2)
    assert company.CODERS["tables"](np.full((4, 8), 9, np.int16)) == 4 * (1 + 2)
    assert company.CODERS["tables"](np.array([[1] * 7 + [13]] * 4, np.int16)) == 4 * (2 + 2)


def test_a_bias_of_every_converter_is_known_to_the_tables():
    """Converters of different bias, and noise of a code: the signs before tell what the magnitudes do not."""
    rng = np.random.default_rng(6)
    bias, noise = np.array([2, -2] * 4), rng.integers(-1, 2, (64, 384))
    codes = (np.tile(bias, 48) + noise).astype(np.int16)
    mixed = rng.permuted(codes, axis=1)
    assert company.CODERS["tables"](codes) < entropy_bytes(codes) < company.CODERS["tables"](mixed)


def test_the_tables_of_the_coders():
    row = {"scene": "a", "threshold": 10, "samples": 1000, "not_zero": 0.5, "entropy": 100, "stream": 130}
    rows = [row | {"zlib -9": 200, "zstd -19": 260, "JPEG-LS": 300, "JPEG XL": 350, "Golomb-Rice": 400, "tables": 90}]
    rows += [rows[0] | {"scene": "b", "stream": 520}, rows[0] | {"threshold": 4}]
    text = lines(company.tables(rows, 10))
    assert "| a | 50.00 % | 100 | 130 | 200 | 260 | 300 | 350 | 400 | 90 |" in text
    assert "| 10 | 200 | 650 | 400 | 520 | 600 | 700 | 800 | 180 | 2.00 (b) | 2.00 (b) | 0.52 (b) |" in text
    assert "| 4 | 100 | 130 | 200 | 260 | 300 | 350 | 400 | 90 | 0.50 (a) | 0.50 (a) | 0.13 (a) |" in text


@pytest.mark.parametrize("what", ["an array", "nothing", "no samples"])
def test_codes_that_are_none(what, tmp_path):
    path = tmp_path / "codes.npz"
    with path.open("wb") as file:
        if what == "an array":
            np.save(file, np.zeros((2, 2)))
        elif what == "no samples":
            np.savez(file, codes=np.zeros((0, 3), np.int16), ideal=np.zeros((0, 3)))
    with pytest.raises(ParameterError, match="codes = .*must "):
        load_codes(path)
