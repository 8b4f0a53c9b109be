"""Sequences of pictures: every form gives the same frames, and what is none is refused in one line."""

import sys

import av
import numpy as np
import pytest
from PIL import Image

from talbot.models.parameters import ParameterError
from talbot.models.scene import Sampling, load, open_clip, resample

SAMPLING = Sampling(12, 18)


def codes(count=11, shape=(20, 30)):
    """Smooth pictures that move, so that a video keeps them."""
    y, x = np.mgrid[: shape[0], : shape[1]]
    return [np.uint8(128 + 90 * np.sin((x + 2 * n) / 5) * np.cos(y / 6)) for n in range(count)]


def write(path, frames, **options):
    first, *rest = map(Image.fromarray, frames)
    first.save(path, save_all=True, append_images=rest, duration=50, **options)
    return path


def write_video(path, frames, codec="mpeg4"):
    with av.open(str(path), "w") as container:
        stream = container.add_stream(codec, rate=20, options={"qscale": "1"})
        stream.height, stream.width = frames[0].shape
        stream.pix_fmt, stream.codec_context.qmin = "yuv420p", 1
        for frame in frames:
            colours = np.repeat(frame[..., None], 3, 2)
            container.mux(stream.encode(av.VideoFrame.from_ndarray(colours, "rgb24")))
        container.mux(stream.encode())
    return path


def folder(path, frames):
    path.mkdir()
    for number, frame in enumerate(frames):  # f10 comes after f9
        Image.fromarray(frame).save(path / f"f{number}.png")
    (path / ".hidden").touch()
    return path


@pytest.mark.parametrize("form", ["gif", "webp", "png", "folder", "arrays", "mp4"])
def test_every_form_gives_the_frames_in_their_order(tmp_path, form):
    frames = codes()
    if form == "folder":
        source, seconds, error = folder(tmp_path / "clip", frames), 1 / 30, 0
    elif form == "arrays":
        source, seconds, error = frames, 1 / 30, 0
    elif form == "mp4":
        source, seconds, error = write_video(tmp_path / "clip.mp4", frames), 0.05, 0.2
    else:
        source = write(tmp_path / f"clip.{form}", frames, **({"lossless": True} if form == "webp" else {}))
        seconds, error = 0.05, 0
    clip = open_clip(source, SAMPLING)
    assert clip.count == 11 and clip.name == ("frames" if form == "arrays" else "clip")
    for _ in range(2):  # and again from the first
        found = list(clip)
        assert len(found) == 11
        for frame, want in zip(found, frames, strict=True):
            assert frame.seconds == pytest.approx(seconds)
            np.testing.assert_allclose(frame.luminance, resample.linear(want), atol=error + 1e-6)


def test_arrays_may_be_radiance_or_colours():
    bright = np.full((4, 6), 3.0)
    (frame,) = open_clip(iter([bright]), SAMPLING)
    np.testing.assert_array_equal(frame.luminance, bright)
    (frame,) = open_clip([np.zeros((4, 6, 3), np.uint8)], SAMPLING)
    assert frame.luminance.shape == (4, 6)


def mixed(path):
    folder(path, codes(3))
    (path / "notes.txt").touch()
    return path


def of_two_sizes(path):
    folder(path, codes(3))
    Image.fromarray(codes(1, (20, 31))[0]).save(path / "f3.png")
    return path


def empty(path):
    path.mkdir()
    return path


def damaged(path):
    write(path, codes())
    data = bytearray(path.read_bytes())
    path.write_bytes(data[: len(data) * 2 // 3])
    return path


def damaged_video(path):
    write_video(path, codes(30, (96, 128)))
    data = bytearray(path.read_bytes())
    for place in range(len(data) // 3, len(data) // 3 + 300, 7):
        data[place] ^= 0x5A
    path.write_bytes(data)
    return path


def cut_video(path):
    write_video(path, codes(30, (96, 128)))
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    return path


def one_frame(path):
    Image.fromarray(codes(1)[0]).save(path)
    return path


def text(path):
    path.write_text("no picture")
    return path


@pytest.mark.parametrize(
    "make, name, said",
    [
        (mixed, "clip", r"must hold pictures of one kind, has \.png, \.txt"),
        (of_two_sizes, "clip", "f3.png': 20 x 31 px, frames 1: must be one of 20 x 30 px"),
        (empty, "clip", "it is empty"),
        (one_frame, "clip.gif", "has one frame: must have more"),
        (damaged, "clip.gif", "damaged"),
        (damaged, "clip.webp", "damaged|of a form that is read"),
        (damaged_video, "clip.mp4", "the video is damaged"),
        (cut_video, "clip.mp4", "the video is damaged"),
        (text, "clip.mp4", "the video is damaged"),
        (text, "clip.gif", "must be an image file of a form that is read"),
        (lambda path: path, "none.mp4", "no such file"),
        (lambda path: codes(2) + codes(1, (5, 5)), "", "frame 2 = 5 x 5: must be as frame 0, 20 x 30"),
        (lambda path: [], "", "must be one array or more"),
        (lambda path: [np.zeros(3)], "", "must be .height, width."),
        (lambda path: [np.full((3, 3), np.nan)], "", "must be a finite number"),
    ],
)
def test_what_is_no_sequence_is_refused(tmp_path, make, name, said):
    with pytest.raises(ParameterError, match=said) as caught:
        list(open_clip(make(tmp_path / name), SAMPLING))
    assert "\n" not in str(caught.value)


def test_without_the_package_a_video_names_the_extra(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "av", None)
    with pytest.raises(ParameterError, match=r"needs the package av: pip install 'talbot\[video\]'"):
        open_clip(text(tmp_path / "clip.mp4"), SAMPLING)


@pytest.mark.parametrize("form", ["gif", "mp4", "folder"])
def test_a_sequence_is_no_picture(tmp_path, form):
    source = folder(tmp_path / "clip", codes(3)) if form == "folder" else tmp_path / f"clip.{form}"
    if form == "gif":
        write(source, codes(3))
    elif form == "mp4":
        source.touch()
    with pytest.raises(ParameterError, match="talbot sequence takes"):
        load(str(source), SAMPLING)
