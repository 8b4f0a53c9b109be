"""Image and depth files of every kind, good and bad."""

import struct
import zlib

import numpy as np
import pytest
from PIL import Image

from talbot.models.parameters import CameraParameters, ParameterError
from talbot.models.scene import Sampling, load
from talbot.models.scene.test.focused import focused

SMALL = focused(Sampling(rows=16, cols=24), 0.0)
TIFF = b"II*\0\x08\0\0\0"  # of a TIFF or DNG, whose directory is cut


def _saved(tmp_path, array, name="p.png", mode=None):
    path = tmp_path / name
    Image.fromarray(array, mode).save(path) if mode else Image.fromarray(array).save(path)
    return str(path)


def _linear(code):
    unit = code / 255
    return unit / 12.92 if unit <= 0.04045 else ((unit + 0.055) / 1.055) ** 2.4


@pytest.mark.parametrize("suffix", ["png", "tif", "bmp", "gif", "webp", "jpg"])
def test_gray_8_bit(tmp_path, suffix):
    scene = load(_saved(tmp_path, np.full((40, 60), 180, np.uint8), "p." + suffix), SMALL)
    np.testing.assert_allclose(scene.image, _linear(180), atol=0.01)


def test_gray_16_bit_keeps_its_depth(tmp_path):
    codes = np.full((40, 60), 32768 + 37, np.uint16)
    scene = load(_saved(tmp_path, codes), SMALL)
    np.testing.assert_allclose(scene.image, _linear(codes[0, 0] / 65535 * 255), rtol=1e-5)


def test_colour_is_luminance(tmp_path):
    codes = np.zeros((40, 60, 3), np.uint8)
    codes[..., 1] = 255
    np.testing.assert_allclose(load(_saved(tmp_path, codes), SMALL).image, 0.7152, rtol=1e-5)


def test_transparent_lies_on_white(tmp_path):
    codes = np.zeros((40, 60, 4), np.uint8)
    np.testing.assert_allclose(load(_saved(tmp_path, codes), SMALL).image, 1.0, rtol=1e-5)


@pytest.mark.parametrize("mode", ["1", "P", "LA", "CMYK", "I;16", "I"])
def test_other_modes(tmp_path, mode):
    picture = Image.fromarray(np.tile(np.arange(60, dtype=np.uint8) * 4, (40, 1))).convert("L")
    picture = picture.convert(mode) if mode != "I;16" else Image.fromarray(np.asarray(picture, np.uint16) * 257)
    path = str(tmp_path / "p.tif")
    picture.save(path)
    image = load(path, SMALL).image
    assert np.isfinite(image).all() and 0 <= image.min() <= image.max() <= 1


@pytest.mark.parametrize("size", [(1, 1), (1, 500), (500, 1), (3, 2)])
def test_tiny_pictures(tmp_path, size):
    scene = load(_saved(tmp_path, np.full(size, 255, np.uint8)), SMALL)
    np.testing.assert_allclose(scene.image, 1.0)


@pytest.mark.parametrize("suffix", ["png", "jpg"])
def test_huge_picture(tmp_path, suffix):
    """100 million pixels, above Pillow's warning: one half black, one half white."""
    codes = np.zeros((10000, 10000), np.uint8)
    codes[:, 5000:] = 255
    path = tmp_path / ("p." + suffix)
    Image.fromarray(codes).save(path, **({"compress_level": 1} if suffix == "png" else {}))
    image = load(str(path), focused(Sampling(rows=16, cols=16), 0.0)).image
    assert image[:, :7].max() < 0.01 and image[:, 9:].min() > 0.99


def test_bomb_is_a_named_error(tmp_path):
    """A header that promises 30000 x 30000 pixels."""

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    path = tmp_path / "bomb.png"
    path.write_bytes(
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", struct.pack(">IIBBBBB", 30000, 30000, 8, 0, 0, 0, 0))
        + chunk(b"IDAT", zlib.compress(b"\0" * 1000))
        + chunk(b"IEND", b"")
    )
    with pytest.raises(ParameterError, match="scene = .*bomb.png.*178956970 pixels"):
        load(str(path), SMALL)


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, -0.5, 1.5])
def test_bad_floating_point_pixel(tmp_path, value):
    pixels = np.full((20, 30), 0.5, np.float32)
    pixels[7, 11] = value
    with pytest.raises(ParameterError, match=r"scene = .*pixel value .*\[0, 1\]"):
        load(_saved(tmp_path, pixels, "p.tif"), SMALL)


def test_floating_point_is_linear(tmp_path):
    np.testing.assert_allclose(load(_saved(tmp_path, np.full((20, 30), 0.25, np.float32), "p.tif"), SMALL).image, 0.25)


@pytest.mark.parametrize("content", [b"not an image", b"\x89PNG\r\n\x1a\n" + b"\0" * 50, TIFF + b"\x09\0\xff"])
def test_not_an_image(tmp_path, content):
    path = tmp_path / "p.png"
    path.write_bytes(content)
    with pytest.raises(ParameterError, match=r"scene = .*p\.png': must be an image file .* PNG, JPEG, TIFF, "):
        load(str(path), SMALL)  # a warning of Pillow's would be an error here


def test_truncated_image(tmp_path):
    path = tmp_path / "p.png"
    Image.fromarray(np.random.default_rng(0).integers(0, 256, (200, 200), np.uint8)).save(path)
    path.write_bytes(path.read_bytes()[:9000])
    with pytest.raises(ParameterError, match="damaged"):
        load(str(path), SMALL)


def test_folder_and_missing_file(tmp_path):
    for path, said in ((tmp_path, "must be an image file, not a folder"), (tmp_path / "none.png", "no such file")):
        with pytest.raises(ParameterError, match=said):
            load(str(path), SMALL)


@pytest.fixture
def picture(tmp_path):
    return _saved(tmp_path, np.random.default_rng(1).integers(0, 256, (32, 48), np.uint8))


def _depths(tmp_path):
    """The same plane at 2 m in every form a depth file may have."""
    metres = np.full((32, 48), 2.0)
    np.save(tmp_path / "d.npy", metres)
    np.savez(tmp_path / "d.npz", depth=metres)
    Image.fromarray(np.full((64, 96), 2000, np.uint16)).save(tmp_path / "mm.png")
    Image.fromarray(np.full((16, 24), 255, np.uint8)).save(tmp_path / "inverse.png")
    return [str(tmp_path / n) for n in ("d.npy", "d.npz", "mm.png", "inverse.png")]


def test_every_depth_file_says_the_same(tmp_path, picture):
    found = [load(picture, SMALL, depth=d) for d in _depths(tmp_path)]
    for scene in found:
        np.testing.assert_allclose(scene.depth, 2.0 / 14.5)
        np.testing.assert_allclose(scene.disparity, found[0].disparity)
        assert (scene.disparity > 0).all()  # nearer than the focal plane
        assert scene.angular


def test_disparity_file(tmp_path, picture):
    np.savez(tmp_path / "d.npz", disparity=np.linspace(-0.05, 0.05, 48) * np.ones((32, 1)))
    sampling = Sampling(16, 24, camera=CameraParameters(focus=3 / 14.5))  # on the files' reference plane
    scene = load(picture, sampling, depth=str(tmp_path / "d.npz"))
    assert -0.05 < scene.disparity.min() < -0.04
    np.testing.assert_allclose(scene.disparity.max(), 0.05)


@pytest.mark.parametrize(
    "values,field",
    [
        (np.full((32, 48), np.nan), "depth = nan"),
        (np.full((32, 48), np.inf), "depth = inf"),
        (np.zeros((32, 48)), "depth = 0"),
        (np.full((32, 48), 1e9), "depth = 1e"),
        (np.ones((32, 20)), "proportions"),
        (np.ones(5), "depth shape"),
        (np.ones((2, 3, 4)), "depth shape"),
        (np.full((32, 48), "far"), "real numbers"),
        (np.ones((0, 4)), "depth shape"),
        (np.full((32, 48), 1j), "real"),
    ],
)
def test_bad_depth_values(tmp_path, picture, values, field):
    np.save(tmp_path / "d.npy", values)
    with pytest.raises(ParameterError, match=field):
        load(picture, SMALL, depth=str(tmp_path / "d.npy"))


@pytest.mark.parametrize(
    "name,content",
    [
        ("d.npy", b""),
        ("d.npy", b"rubbish"),
        ("d.npz", b"rubbish"),
        ("d.png", b"x"),
        (
            "d.npy",
            b"\x93NUMPY\x01\x00v\x00{'descr': '<f8', 'fortran_order': False, "
            b"'shape': (32000000, 48000000), }" + b" " * 38 + b"\n",
        ),
    ],
)
def test_bad_depth_files(tmp_path, picture, name, content):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(ParameterError, match="depth = "):
        load(picture, SMALL, depth=str(tmp_path / name))


def test_missing_depth_file_and_wrong_array_name(tmp_path, picture):
    with pytest.raises(ParameterError, match="depth = .*no such file"):
        load(picture, SMALL, depth=str(tmp_path / "none.npy"))
    np.savez(tmp_path / "d.npz", z=np.ones((32, 48)))
    with pytest.raises(ParameterError, match="named depth or disparity"):
        load(picture, SMALL, depth=str(tmp_path / "d.npz"))
