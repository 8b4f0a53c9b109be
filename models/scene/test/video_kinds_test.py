"""Videos of every kind: frames, their orientation and times as players show them."""

import struct
from fractions import Fraction

import av
import numpy as np
import pytest

from talbot.models.parameters import ParameterError
from talbot.models.scene import Sampling, open_clip, resample

SHAPE = 48, 64
SAMPLING = Sampling(*SHAPE)


def pictures(count=8):
    """Brighter from frame to frame, and to the right; the upper left is dark."""
    x = np.arange(SHAPE[1]) / SHAPE[1]
    frame = np.repeat((60 + 100 * x)[None], SHAPE[0], 0)
    frame[:16, :16] = 20
    return [np.uint8(frame + 6 * n) for n in range(count)]


def write(path, frames, *, codec="mpeg4", form="yuv420p", times=None, rate=25, aspect=None, **options):
    start = options.pop("movflags", None)
    with av.open(str(path), "w", options={"movflags": start} if start else {}) as container:
        stream = container.add_stream(codec, rate=rate, options=options)
        stream.height, stream.width = frames[0].shape[:2]
        stream.pix_fmt = form
        if codec == "mpeg4":
            stream.codec_context.qmin = 1
        stream.codec_context.time_base = Fraction(1, 1000 if times else rate)
        if aspect:
            stream.codec_context.sample_aspect_ratio = aspect
        for number, values in enumerate(frames):
            kind = "rgba" if values.ndim == 3 else "gray16le" if values.dtype == np.uint16 else "gray"
            frame = av.VideoFrame.from_ndarray(np.ascontiguousarray(values), kind)
            frame.pts = times[number] if times else number
            frame.time_base = stream.codec_context.time_base
            container.mux(stream.encode(frame))
        container.mux(stream.encode())
    return path


def light(codes):
    return resample.linear(codes)


@pytest.mark.parametrize(
    "name, codec",
    [
        ("CLIP.MP4", "mpeg4"),
        ("clip.Mov", "mpeg4"),
        ("clip.m4v", "mpeg4"),
        ("clip.3gp", "mpeg4"),
        ("clip.avi", "mpeg4"),
        ("clip.mkv", "mpeg4"),
        ("clip.webm", "libvpx-vp9"),
        ("clip.ts", "mpeg2video"),
        ("clip.MTS", "libx264"),
        ("clip.m2ts", "libx264"),
        ("clip.mpg", "mpeg2video"),
        ("clip.wmv", "wmv2"),
        ("clip.flv", "flv"),
        ("clip.y4m", "rawvideo"),
        ("clip.ogv", "libvpx"),
        ("clip.mxf", "mpeg2video"),
        ("clip.bin", "mpeg4"),
    ],
)
def test_every_container(tmp_path, name, codec):
    path = tmp_path / name
    if name == "clip.bin":
        write(tmp_path / "clip.mp4", pictures(), codec=codec).rename(path)  # known by its first bytes
    else:
        write(path, pictures(), codec=codec)
    clip = open_clip(path, SAMPLING)
    frames = list(clip)
    assert clip.count == len(frames) == 8
    for frame, want in zip(frames, pictures(), strict=True):
        assert frame.seconds == pytest.approx(0.04, abs=0.002)
        assert np.sqrt(np.mean((frame.luminance - light(want)) ** 2)) < 0.05


def with_matrix(path, matrix):
    """The same MP4 with another display matrix."""
    data = bytearray(path.read_bytes())
    head = data.index(b"tkhd")
    place = data.index(struct.pack(">9i", 65536, 0, 0, 0, 65536, 0, 0, 0, 1 << 30), head)
    a, b, c, d = matrix
    data[place : place + 36] = struct.pack(">9i", a << 16, b << 16, 0, c << 16, d << 16, 0, 0, 0, 1 << 30)
    path.write_bytes(data)


@pytest.mark.parametrize(
    "matrix, turn",
    [
        ((1, 0, 0, 1), lambda x: x),
        ((0, 1, -1, 0), lambda x: np.rot90(x, -1)),  # a phone held upright
        ((-1, 0, 0, -1), lambda x: np.rot90(x, 2)),
        ((0, -1, 1, 0), np.rot90),
        ((-1, 0, 0, 1), np.fliplr),
        ((1, 0, 0, -1), np.flipud),
        ((0, 1, 1, 0), np.transpose),
        ((0, -1, -1, 0), lambda x: np.rot90(x, 2).T),
    ],
)
def test_the_display_matrix_turns_and_mirrors(tmp_path, matrix, turn):
    path = write(tmp_path / "clip.mp4", pictures(2))
    with_matrix(path, matrix)
    for frame, want in zip(open_clip(path, SAMPLING), pictures(2), strict=True):
        assert np.sqrt(np.mean((frame.luminance - turn(light(want))) ** 2)) < 0.05


@pytest.mark.parametrize("name", ["clip.mp4", "clip.mkv", "clip.avi"])
def test_frames_last_until_the_next_one(tmp_path, name):
    """Of variable rate; AVI has a grid, whose gaps its header counts as frames."""
    times = [0, 40, 540, 580, 1580, 1620]
    frames = list(open_clip(write(tmp_path / name, pictures(6), times=times), SAMPLING))
    assert [round(frame.seconds, 2) for frame in frames[:-1]] == [0.04, 0.5, 0.04, 1.0, 0.04]
    assert 0.01 < frames[-1].seconds < 0.2


def test_an_edit_list_leaves_frames_out(tmp_path):
    """Trimmed in a phone without encoding again: the header counts all."""
    path = write(tmp_path / "clip.mp4", pictures(8), g="1")
    data = bytearray(path.read_bytes())
    place = data.index(b"elst") + 12  # one edit: duration in ms of the movie, start in the media's units
    duration, start = struct.unpack(">Ii", data[place : place + 8])
    with av.open(str(path)) as container:
        scale = container.streams.video[0].time_base.denominator
    data[place : place + 8] = struct.pack(">Ii", duration * 5 // 8, start + scale * 3 // 25)
    path.write_bytes(data)
    clip = open_clip(path, SAMPLING)
    frames = list(clip)
    assert clip.count == len(frames) == 5
    np.testing.assert_allclose(frames[0].luminance.mean(), light(pictures()[3]).mean(), atol=0.01)


def test_ten_bits_are_kept(tmp_path):
    values = np.full(SHAPE, 200, np.uint16) + np.arange(SHAPE[1], dtype=np.uint16)  # one code of 8 bits in all
    path = write(tmp_path / "clip.mkv", [values], codec="ffv1", form="gray10le")
    (frame,) = open_clip(path, SAMPLING)
    assert len(np.unique(frame.luminance)) > 1


@pytest.mark.parametrize("full", [False, True])
def test_black_and_white_of_either_range(tmp_path, full):
    values = np.zeros(SHAPE, np.uint8)
    values[:, 32:] = 255
    path = tmp_path / "clip.mkv"
    with av.open(str(path), "w") as container:
        stream = container.add_stream("ffv1", rate=25)
        stream.height, stream.width, stream.pix_fmt = *SHAPE, "yuv420p"
        stream.codec_context.color_range = 2 if full else 1
        frame = av.VideoFrame.from_ndarray(values, "gray")
        frame = frame.reformat(format="yuv420p", src_color_range=2, dst_color_range=2 if full else 1)
        frame.color_range = 2 if full else 1
        container.mux(stream.encode(frame))
        container.mux(stream.encode())
    (frame,) = open_clip(path, SAMPLING)
    np.testing.assert_allclose(frame.luminance[:, :30], 0, atol=0.01)
    np.testing.assert_allclose(frame.luminance[:, 34:], 1, atol=0.02)


@pytest.mark.parametrize("name, codec, form", [("clip.webm", "libvpx-vp9", "yuva420p"), ("clip.mov", "qtrle", "argb")])
def test_transparent_video_lies_on_white(tmp_path, name, codec, form):
    values = np.zeros((*SHAPE, 4), np.uint8)
    values[:, :32, 3] = 255  # opaque black, then nothing
    (frame,) = open_clip(write(tmp_path / name, [values], codec=codec, form=form), SAMPLING)
    np.testing.assert_allclose(frame.luminance[:, :28], 0, atol=0.02)
    np.testing.assert_allclose(frame.luminance[:, 36:], 1, atol=0.02)


def test_pixels_that_are_not_square(tmp_path):
    path = write(tmp_path / "clip.mp4", pictures(2), aspect=Fraction(16, 11))
    for frame in open_clip(path, SAMPLING):
        assert frame.luminance.shape == (48, 93)


def with_cover(path):
    """A song with a picture of its sleeve."""
    with av.open(str(path), "w") as container:
        sound = container.add_stream("aac", rate=44100)
        frame = av.AudioFrame.from_ndarray(np.zeros((1, 1024), np.float32), "fltp", "mono")
        frame.rate = 44100
        container.mux(sound.encode(frame))
        container.mux(sound.encode())


def cut(share=2 / 3, **options):
    def make(path):
        write(path, pictures(40), **options)
        path.write_bytes(path.read_bytes()[: int(path.stat().st_size * share)])

    return make


@pytest.mark.parametrize(
    "name, make, said",
    [
        ("clip.mp4", with_cover, "must have a video stream"),
        ("clip.mp4", cut(), "the video is damaged"),
        ("clip.mp4", cut(movflags="faststart"), "the video is damaged .of"),
        ("clip.avi", cut(), r"the video is damaged \(of \d+ bytes \d+ are there\)"),
        ("clip.mkv", cut(), r"the video is damaged \(of \d+ bytes \d+ are there\)"),
        ("clip.wmv", cut(codec="wmv2"), r"the video is damaged \(of \d+ bytes \d+ are there\)"),
        ("clip.mxf", cut(codec="mpeg2video"), r"the video is damaged \(of \d+ bytes \d+ are there\)"),
        ("clip.ogv", cut(codec="libvpx"), r"the video is damaged \(of \d+ bytes \d+ are there\)"),
        ("clip.mp4", cut(0.5, movflags="frag_keyframe+empty_moov", g="5"), r"damaged \(of \d+ bytes \d+ are there\)"),
        ("clip.y4m", cut(0.63, codec="rawvideo"), r"the video is damaged \(the file ends early; frames read: 25\)"),
        ("clip.ts", cut(0.9, codec="libx264"), r"the video is damaged \(the file ends early; frames read: \d\d\)"),
        ("clip.m2ts", cut(0.8, codec="libx264"), r"the video is damaged \(the file ends early; frames read: \d\d\)"),
        ("clip.MTS", lambda path: path.write_bytes(b""), "the video is damaged"),
    ],
)
def test_what_is_refused_is_refused_when_it_is_opened(tmp_path, name, make, said):
    make(tmp_path / name)
    with pytest.raises(ParameterError, match=said) as caught:
        open_clip(tmp_path / name, SAMPLING)
    assert "\n" not in str(caught.value)


def test_hdr_is_refused(tmp_path):
    path = tmp_path / "clip.mkv"
    with av.open(str(path), "w") as container:
        stream = container.add_stream("ffv1", rate=25)
        stream.height, stream.width, stream.pix_fmt = *SHAPE, "yuv420p10le"
        stream.codec_context.color_trc = 18
        frame = av.VideoFrame.from_ndarray(pictures(1)[0], "gray").reformat(format="yuv420p10le")
        frame.color_trc = 18
        container.mux(stream.encode(frame))
        container.mux(stream.encode())
    with pytest.raises(ParameterError, match=r"is HDR \(HLG\): must be SDR"):
        open_clip(path, SAMPLING)
