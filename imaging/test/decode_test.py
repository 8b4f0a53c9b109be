import json
import re

import numpy as np
import pytest

from talbot.base.command import main
from talbot.imaging import decode
from talbot.models.digital.stream import encode_frame
from talbot.models.digital.stream.test.frames import header_of, samples_of


@pytest.fixture
def stream():
    header = header_of(12, 30, threshold=4, frame_number=9)
    samples = samples_of(header, 1)
    return samples, encode_frame(header, samples, 70, 290)


def test_decodes_to_a_file(tmp_path, capsys, stream):
    samples, data = stream
    (tmp_path / "s.bin").write_bytes(data)
    assert main(decode, [str(tmp_path / "s.bin"), "--out", str(tmp_path / "d.npz")]) == 0
    assert (
        capsys.readouterr().out
        == "frame 9: edge, 12 x 30, complete; threshold 4, 12 of 12 rows, 70 conversions, 290 left out, "
        f"{len(data)} bytes\nwritten: {tmp_path / 'd.npz'}\n"
    )
    with np.load(tmp_path / "d.npz") as kept:
        assert np.array_equal(kept["samples"], samples) and kept["read"].all() and kept["bad_rows"].size == 0
        assert (kept["made"], kept["left_out"]) == (70, 290)
        header = json.loads(str(kept["header"]))
    assert (header["mode"], header["window"]["row1"], header["frame_number"]) == ("edge", 2, 9)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["d.npz", "s.bin"]


@pytest.mark.parametrize(
    "text, said",
    [
        ("", "array.rows = 384: must be 12, as in the header of frame 9"),
        ("array.rows = 12\narray.cols = 60", "array.cols = 60: must be 30, as in the header"),
        ("array.rows = 12\narray.cols = 30\nchip.lanes = 2", "chip.lanes = 2: must be "),
        ("tile.rows = 2\ntile.cols = 3", "tile = 2 x 3: must be 4 x 6, as in the header"),
    ],
)
def test_a_stream_of_another_sensor_is_refused(tmp_path, capsys, stream, text, said):
    (tmp_path / "s.bin").write_bytes(stream[1])
    (tmp_path / "odd.toml").write_text(text)
    assert main(decode, [str(tmp_path / "s.bin"), f"--sensor={tmp_path / 'odd.toml'}"]) == 2
    err = capsys.readouterr().err
    assert said in err and err.count("\n") == 1 and not [*tmp_path.glob("*.npz")]


def test_every_frame_has_its_file(tmp_path, stream):
    (tmp_path / "s.bin").write_bytes(stream[1] * 3)
    assert len(decode.decode_to(tmp_path / "s.bin", tmp_path / "d.npz")) == 3
    assert sorted(path.name for path in tmp_path.glob("*.npz")) == ["d-1.npz", "d-2.npz", "d.npz"]


def test_damage_is_reported_and_the_rest_is_kept(tmp_path, capsys, stream):
    samples, data = stream
    (tmp_path / "s.bin").write_bytes(data[:-30])
    assert main(decode, [str(tmp_path / "s.bin"), "--out", str(tmp_path / "d.npz")]) == 1
    error = capsys.readouterr().out
    assert "rows are bad" in error and "trailer" in error
    with np.load(tmp_path / "d.npz") as kept:
        assert kept["bad_rows"].size and not kept["read"][kept["bad_rows"]].any() and kept["made"] == -1


@pytest.mark.parametrize("cut", range(1, 15))
def test_a_cut_trailer_is_damage(tmp_path, capsys, stream, cut):
    (tmp_path / "s.bin").write_bytes(stream[1][:-cut])
    assert main(decode, [str(tmp_path / "s.bin")]) == 1
    assert "trailer" in capsys.readouterr().out


def test_a_corrected_byte_is_damage_and_bad_rows_are_listed_once(tmp_path, capsys, stream):
    for at, said in ((5, "corrected"), (slice(60, 80), "bad rows: ")):
        data = bytearray(stream[1])
        data[at] = bytes(20) if isinstance(at, slice) else data[at] ^ 1
        (tmp_path / "s.bin").write_bytes(data)
        assert main(decode, [str(tmp_path / "s.bin")]) == 1
        text = capsys.readouterr().out
        assert said in text and text.count("bad rows: ") <= 1 and not re.search(r"rows are bad: ", text)


@pytest.mark.parametrize("out, must", [("folder", "must be a file, not a folder"), ("s.bin", "must not be the stream")])
def test_where_it_may_not_write(tmp_path, capsys, stream, out, must):
    (tmp_path / "folder").mkdir()
    (tmp_path / "s.bin").write_bytes(stream[1])
    assert main(decode, [str(tmp_path / "s.bin"), "--out", str(tmp_path / out)]) == 2
    assert must in capsys.readouterr().err and (tmp_path / "s.bin").read_bytes() == stream[1]


@pytest.mark.parametrize("content, message", [(b"", "empty"), (b"no stream", "header"), (bytes(1000), "starts with")])
def test_no_stream_is_one_line_and_status_2(tmp_path, capsys, content, message):
    (tmp_path / "s.bin").write_bytes(content)
    assert main(decode, [str(tmp_path / "s.bin"), "--out", str(tmp_path / "d.npz")]) == 2
    error = capsys.readouterr().err
    assert (
        error.startswith("imaging.decode: error: ") and message in error and "s.bin" in error and error.count("\n") == 1
    )
    assert not (tmp_path / "d.npz").exists()


@pytest.mark.parametrize("name, out", [("missing", "d.npz"), ("", "d.npz"), ("s.bin", "s.bin/d.npz")])
def test_files_that_cannot_be_are_named(tmp_path, capsys, stream, name, out):
    (tmp_path / "s.bin").write_bytes(stream[1])
    assert main(decode, [str(tmp_path / name), "--out", str(tmp_path / out)]) == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1 and (name or str(tmp_path)) in error or "s.bin" in error
