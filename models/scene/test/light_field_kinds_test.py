"""Light fields of every array, grid and file: the same scene, or one line that says what is wrong."""

import io
import zipfile

import numpy as np
import pytest
from PIL import Image

from talbot.models.parameters import ParameterError
from talbot.models.scene import LightField, Sampling, load, open_clip, read_light_field, write_light_field

SHAPE = 6, 8
CODES = np.random.default_rng(3).integers(0, 256, (3, 3, *SHAPE), np.uint8)


@pytest.mark.parametrize("suffix", [".npy", ".npz"])
@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("kind", ["u1", "u2", "f2", "f4", "f8"])
@pytest.mark.parametrize("layout", ["C", "F", "reversed", "strided"])
def test_every_array_of_a_light_field(tmp_path, suffix, order, kind, layout):
    values = {"u1": CODES, "u2": CODES.astype(np.uint16)}.get(kind, CODES / 255)  # uint16 below 16: no radiance
    values = values.astype(kind)
    stored = values.astype(order + kind)
    if layout == "F":
        stored = np.asfortranarray(stored)
    elif layout == "reversed":
        stored = stored[::-1, :, :, ::-1]
        values = values[::-1, :, :, ::-1]
    elif layout == "strided":
        stored = np.repeat(stored, 2, 3)[..., ::2]
    path = tmp_path / ("x" + suffix)
    np.save(path, stored) if suffix == ".npy" else np.savez(path, light_field=stored, disparity=np.zeros(SHAPE, ">f4"))
    for found in (read_light_field(path), LightField(stored)):
        assert found.values.dtype.isnative
        np.testing.assert_array_equal(found.values, values)
        np.testing.assert_array_equal(found.view(1, 1), LightField(values.copy()).view(1, 1))
        assert np.isfinite(found.scene(Sampling(*SHAPE)).image).all()


@pytest.mark.parametrize(
    "values, said",
    [
        *[(CODES.astype(kind), f"light field = {kind} array: must be of uint8, uint16, float.* integers are codes")
          for kind in ("int8", "int16", "int32", "int64", "uint32", "uint64")],
        (CODES > 9, "light field = bool array: must be of uint8"),
        (CODES.astype(complex), "light field = complex128 array: must be of"),
        (CODES.astype(np.longdouble), r"light field = \w+ array: must be of"),
        (np.uint8(3), r"array of shape \(\): must be"),
        (CODES[:, :, :0], "must be"),
        (np.zeros((32, 1, 2, 2), np.uint8), "views = 32: must be an integer in 1..31"),
    ],
)  # fmt: skip
def test_arrays_that_are_refused(tmp_path, values, said):
    np.save(tmp_path / "x.npy", values)
    with pytest.raises(ParameterError, match=said):
        read_light_field(tmp_path / "x.npy")
    if values.ndim == 4:
        with pytest.raises(ParameterError, match=said):
            LightField(values)


def test_objects_are_refused_by_name(tmp_path):
    np.save(tmp_path / "x.npy", np.array([[1, None]], object), allow_pickle=True)
    with pytest.raises(ParameterError, match="has objects: must have numbers"):
        read_light_field(tmp_path / "x.npy")


def test_frames_of_the_other_byte_order_are_codes():
    dark = np.full(SHAPE, 9, ">u2")
    (frame,) = open_clip([dark], Sampling(*SHAPE))
    np.testing.assert_allclose(frame.luminance, 9 / 65535 / 12.92, rtol=1e-6)


@pytest.mark.parametrize("grid", [(3, 5), (5, 3), (2, 5), (4, 3)])
@pytest.mark.parametrize("form", ["x.npy", "x.npz", "x", "x.png"])
def test_a_grid_may_be_a_rectangle(tmp_path, grid, form):
    """Every form keeps it; the sensor sees its middle square, with the same middle view."""
    values = np.random.default_rng(0).integers(0, 256, (*grid, *SHAPE), np.uint8)
    path = tmp_path / form
    write_light_field(LightField(values), path)
    found = read_light_field(path, grid if form == "x.png" else None)
    np.testing.assert_array_equal(found.values, values)
    scene = load(f"{path}:{grid[0]}x{grid[1]}" if form == "x.png" else str(path), Sampling(*SHAPE))
    assert found.grid == grid and scene.views == min(grid)
    np.testing.assert_allclose(scene.image, found.view(grid[0] // 2, grid[1] // 2))


@pytest.mark.parametrize("deep", [False, True])
def test_lenslet_images_are_interleaved(tmp_path, deep):
    values = np.random.default_rng(0).integers(0, 256, (14, 14, *SHAPE, 3), np.uint8)
    if deep:
        values = values[..., 0].astype(np.uint16) * 257
    lenslets = np.zeros((SHAPE[0] * 14, SHAPE[1] * 14, *values.shape[4:]), values.dtype)
    for v in range(14):
        for u in range(14):
            lenslets[v::14, u::14] = values[v, u]
    path = tmp_path / "flower_eslf.png"
    Image.fromarray(lenslets).save(path)
    np.testing.assert_array_equal(read_light_field(path).values, values)
    assert load(str(path), Sampling(*SHAPE)).views == 14
    np.testing.assert_array_equal(read_light_field(path, 7).values[0, 0], lenslets[::7, ::7])
    Image.fromarray(lenslets[:-1]).save(path)
    with pytest.raises(ParameterError, match="views = 14: must divide the image's height and width, 83 x 112"):
        load(str(path), Sampling(*SHAPE))


@pytest.mark.parametrize("shape, size", [((6, 8), (6, 8)), ((2048, 100), (1024, 50)), ((10, 3072), (5, 1536))])
def test_a_sensor_of_its_size(shape, size):
    assert LightField(np.zeros((1, 1, *shape), np.uint8)).own_size() == size


@pytest.mark.parametrize("text", ["3x", "x3", "3x5x1", "0x3", ""])
def test_grids_that_are_refused(tmp_path, text):
    Image.fromarray(CODES[0, 0]).save(tmp_path / "x.png")
    with pytest.raises(ParameterError, match="views = "):
        load(f"{tmp_path / 'x.png'}:{text}", Sampling(*SHAPE))


def test_depth_in_integers_has_no_unit(tmp_path):
    Image.fromarray(CODES[0, 0]).save(tmp_path / "p.png")
    np.save(tmp_path / "d.npy", np.full(SHAPE, 900, np.uint16))
    with pytest.raises(ParameterError, match="depth type = uint16: must be floating point, in m"):
        load(str(tmp_path / "p.png"), Sampling(*SHAPE), depth=str(tmp_path / "d.npy"))
    np.save(tmp_path / "d.npy", np.full(SHAPE, 3, ">f4"))
    np.testing.assert_allclose(
        load(str(tmp_path / "p.png"), Sampling(*SHAPE), depth=str(tmp_path / "d.npy")).depth, 3 / 14.5, rtol=1e-6
    )


def _encrypted(data):
    data[6] |= 1
    data[data.find(b"PK\1\2") + 8] |= 1


def _odd_compression(data):
    data[8] = data[data.find(b"PK\1\2") + 10] = 97


def _bad_stream(data):
    data[75:85] = b"\xff" * 10  # within the array's compressed bytes


@pytest.mark.parametrize("spoil", [_encrypted, _odd_compression, _bad_stream])
def test_archives_that_zipfile_does_not_read(tmp_path, spoil):
    path = tmp_path / "x.npz"
    np.savez_compressed(path, depth=np.ones((3, 3, *SHAPE)))
    data = bytearray(path.read_bytes())
    spoil(data)
    path.write_bytes(data)
    with pytest.raises(ParameterError, match="scene = .*must be a NumPy array file"):
        read_light_field(path)
    Image.fromarray(CODES[0, 0]).save(tmp_path / "x.png")
    with pytest.raises(ParameterError, match="depth = .*must be a NumPy array file"):
        load(str(tmp_path / "x.png"), Sampling(*SHAPE), depth=str(path))


@pytest.mark.parametrize("shape", [(9, 9, 100_000, 100_000), (3, -3, 6, 8)])
@pytest.mark.parametrize("suffix", [".npy", ".npz"])
def test_headers_of_impossible_size(tmp_path, suffix, shape):
    header = io.BytesIO()
    np.lib.format.write_array_header_1_0(header, {"descr": "<f8", "fortran_order": False, "shape": shape})
    data, path = header.getvalue() + bytes(3000), tmp_path / ("x" + suffix)
    if suffix == ".npy":
        path.write_bytes(data)
    else:
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr("light_field.npy", data)
    with pytest.raises(ParameterError, match="must be a NumPy array file"):
        read_light_field(path)


def test_names_and_forms_of_written_files(tmp_path):
    for name in ("X.NPY", "X.NPZ"):
        write_light_field(LightField(CODES), tmp_path / name)
        np.testing.assert_array_equal(read_light_field(tmp_path / name).values, CODES)
    write_light_field(LightField(CODES), tmp_path / "x.webp")
    light_field = read_light_field(tmp_path / "x.webp", 3)
    np.testing.assert_allclose(
        light_field.view(0, 2), LightField(CODES).view(0, 2), atol=1e-9
    )  # it has no gray, three equal
    with pytest.raises(ParameterError, match="path = 'x.webp': must be .png or .tif, for 16 bits"):
        write_light_field(LightField(CODES / 255), tmp_path / "x.webp")
