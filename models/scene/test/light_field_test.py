"""Light fields of one's own: every form written and read again, what the sensor sees of them, what is refused."""

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from PIL import Image

from talbot.models.parameters import ParameterError
from talbot.models.scene import LightField, Sampling, load, read_light_field, write_light_field
from talbot.models.scene.resample import linear

SMALL = Sampling(rows=16, cols=24)
RNG = np.random.default_rng(0)
GRAY = RNG.integers(0, 256, (3, 3, 16, 24), np.uint8)
COLOUR = RNG.integers(0, 256, (3, 3, 16, 24, 3), np.uint8)
DEEP = RNG.integers(0, 65536, (3, 3, 16, 24), np.uint16)
FLOAT = RNG.random((3, 3, 16, 24))


@pytest.mark.parametrize("values", [GRAY, COLOUR, DEEP, FLOAT, FLOAT.astype(np.float32)])
@pytest.mark.parametrize("name", ["x.npy", "x.npz", "x", "x.png"])
def test_every_form_is_read_as_it_was_written(tmp_path, name, values):
    disparity = RNG.normal(size=(16, 24)).astype(np.float32)
    write_light_field(LightField(values, disparity), tmp_path / name)
    found = read_light_field(tmp_path / name, 3 if name == "x.png" else None)
    assert found.name == "x" and found.views == 3 and found.shape == (16, 24)
    if values.dtype.kind == "f" and name in ("x", "x.png"):  # 16-bit codes
        assert found.values.dtype == np.uint16
        np.testing.assert_allclose(found.view(1, 2), values[1, 2], atol=2 / 65535)
    else:
        np.testing.assert_array_equal(found.values, values)
    if name in ("x.npz", "x"):
        np.testing.assert_array_equal(found.disparity, disparity)


@settings(max_examples=25, deadline=None)
@given(
    arrays(
        st.sampled_from([np.float16, np.float32, np.float64]),
        st.tuples(st.integers(1, 3), st.integers(1, 5), st.integers(1, 5)).map(lambda s: (s[0], s[0], *s[1:])),
        elements=st.floats(-16, 16, width=16),
    ),
    st.sampled_from([1.0, 2.5, 16.0]),
)
def test_an_estimate_is_kept_by_arrays_and_clipped_by_pictures(values, white):
    field = LightField(values)
    with TemporaryDirectory() as name:
        folder = Path(name)
        for path in (folder / "x.npy", folder / "x.npz"):
            assert write_light_field(field, path, white) == ""
            kept = read_light_field(path).values
            assert kept.dtype == values.dtype
            np.testing.assert_array_equal(kept, values)
        seen = np.clip(values.astype(float) / white, 0, 1)
        for path in (folder / "x.png", folder / "x"):
            said = write_light_field(field, path, white)
            assert bool(said) == bool((values < 0).any() or (values > white).any())
            assert not said or f"clipped to 0..{white:g}" in said
            found = read_light_field(path, len(values) if path.suffix else None)
            for v, u in np.ndindex(values.shape[:2]):
                np.testing.assert_allclose(found.view(v, u), seen[v, u], atol=2 / 65535)


def test_a_sensor_sees_no_light_below_zero():
    values = FLOAT.copy()
    values[:, :, :8] -= 1
    scene = LightField(values, name="estimate").scene(SMALL)
    np.testing.assert_array_equal(scene.light_field, np.maximum(values, 0))
    (note,) = scene.notes
    assert note.startswith("estimate: 50 % of the light field is below 0, to -1: clipped to 0")
    assert LightField(values).scene(Sampling(rows=5, cols=7)).light_field.min() >= 0
    assert not LightField(FLOAT).scene(SMALL).notes


def test_folder_of_the_stanford_archive(tmp_path):
    for v, u in np.ndindex(3, 3):
        Image.fromarray(COLOUR[v, u]).save(tmp_path / f"out_{v:02d}_{u:02d}_-381.909271_{u * 3.5}.png")
    np.testing.assert_array_equal(read_light_field(tmp_path).values, COLOUR)


@pytest.mark.parametrize("name", ["x.npy", "x.npz", "x", "x.png:3"])
def test_a_name_on_the_command_line_is_the_light_field(tmp_path, name):
    write_light_field(LightField(GRAY), tmp_path / name.removesuffix(":3"))
    scene = load(str(tmp_path / name), SMALL)
    assert scene.name == "x" and scene.views == 3 and scene.angular
    for v, u in np.ndindex(3, 3):
        np.testing.assert_allclose(scene.light_field[v, u], linear(GRAY[v, u]), rtol=1e-6)
    np.testing.assert_array_equal(scene.image, scene.light_field[1, 1])


def test_a_folder_with_the_name_of_a_scene_is_the_scene(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_light_field(LightField(GRAY), "coins")
    assert load("coins", SMALL).views == 5 and load("./coins", SMALL).views == 3


def test_values_are_radiance():
    """uint8 and uint16 are the same codes; colours are luminance; floats are what they are."""
    gray = LightField(GRAY).view(0, 1)
    np.testing.assert_allclose(LightField(GRAY.astype(np.uint16) * 257).view(0, 1), gray, atol=1e-6)
    np.testing.assert_allclose(LightField(np.stack([GRAY] * 3, -1)).view(0, 1), gray, atol=1e-6)
    np.testing.assert_array_equal(LightField(FLOAT * 16).scene(SMALL).light_field, FLOAT * 16)
    red = np.zeros((1, 1, 2, 2, 3))
    red[..., 0] = 1
    np.testing.assert_allclose(LightField(red).view(0, 0), 0.2126)


def test_size_and_disparity_fit_the_array():
    """Twice the size: means of four; disparity in px of the array; the middle of a wide one."""
    big = np.kron(FLOAT, np.ones((2, 2)))
    wide = np.concatenate([0 * big[..., :8], big, 0 * big[..., :8]], 3)
    scene = LightField(wide, np.full((32, 64), 3.0)).scene(SMALL)
    np.testing.assert_allclose(scene.light_field[0, 2, 4:-4, 4:-4], FLOAT[0, 2, 4:-4, 4:-4], atol=0.25)
    np.testing.assert_allclose(scene.light_field.mean(), FLOAT.mean(), rtol=0.01)
    np.testing.assert_array_equal(scene.disparity, 1.5)
    assert scene.depth is None


def test_views_that_are_equal_are_one():
    scene = LightField(np.broadcast_to(FLOAT[1, 1], (5, 5, 16, 24))).scene(SMALL)
    assert not scene.angular and scene.views == 5


@pytest.mark.parametrize(
    "values, more, said",
    [
        (np.zeros((3, 4, 5, 6, 3, 1)), {}, r"array of shape .*: must be \(views, views, height, width\)"),
        (np.zeros((3, 3, 5)), {}, "array of shape"),
        (np.zeros((3, 3, 5, 6, 4)), {}, "array of shape"),
        (np.zeros((0, 0, 5, 6)), {}, "array of shape"),
        (np.zeros((32, 32, 1, 1)), {}, "views = 32: must be an integer in 1..31"),
        (np.zeros((1, 1, 5, 6), int), {}, "int64 array: must be of uint8, uint16, float16"),
        (np.zeros((1, 1, 5, 6), object), {}, "object array: must be of"),
        (np.full((1, 1, 5, 6), np.nan), {}, "light field = nan"),
        (np.full((1, 1, 5, 6), 17.0), {}, r"light field = 17: every value must be a finite number in \[-16, 16\]"),
        (np.zeros((1, 1, 5, 6)), {"disparity": np.zeros((6, 5))}, r"disparity = .* must be numbers, \(5, 6\)"),
        (np.zeros((1, 1, 5, 6)), {"disparity": np.full((5, 6), np.inf)}, "disparity = inf"),
    ],
)
def test_arrays_that_are_refused(values, more, said):
    with pytest.raises(ParameterError, match=said):
        LightField(values, **more)


def _missing(folder):
    (folder / "input_Cam004.png").unlink()


def _extra(folder):
    (folder / "input_Cam004.png").rename(folder / "input_Cam100.png")


def _other(folder):
    Image.fromarray(GRAY[0, 0, :8]).save(folder / "input_Cam007.png")


def _damaged(folder):
    (folder / "input_Cam007.png").write_bytes(b"rubbish")


@pytest.mark.parametrize(
    "spoil, said",
    [
        (_missing, "has 8 views: must be a square of them"),
        (_extra, "has 9 views: .* of 3 x 3 is missing row 1, column 1"),
        (_other, r"Cam007.png': uint8 \(8, 24\): must be as the first view, uint8 \(16, 24\)"),
        (_damaged, "Cam007.png': must be an image file of a form that is read"),
    ],
)
def test_folders_that_are_refused(tmp_path, spoil, said):
    write_light_field(LightField(GRAY), tmp_path / "x")
    spoil(tmp_path / "x")
    with pytest.raises(ParameterError, match=said):
        load(str(tmp_path / "x"), SMALL)


@pytest.mark.parametrize(
    "name, content, said",
    [
        ("x.npy", b"rubbish", "must be a NumPy array file"),
        ("x.npz", b"rubbish", "must be a NumPy array file"),
        ("x.png:3", b"rubbish", "must be an image file of a form that is read"),
        ("x.png:many", None, "views = 'many': must be an integer in 1..31"),
        ("x.png:0", None, "views = 0: must be an integer in 1..31"),
        ("x.png:5", None, "views = 5: must divide the image's height and width, 48 x 72"),
        ("none.npy", None, "no such file"),
        ("none.png:3", None, "no such file"),
    ],
)
def test_files_that_are_refused(tmp_path, name, content, said):
    path = tmp_path / name.partition(":")[0]
    if content is not None:
        path.write_bytes(content)
    elif name[0] == "x":
        write_light_field(LightField(GRAY), path)
    with pytest.raises(ParameterError, match=said):
        load(str(tmp_path / name), SMALL)


def test_more_that_is_refused(tmp_path):
    np.savez(tmp_path / "two.npz", a=GRAY, b=GRAY)
    with pytest.raises(ParameterError, match="an array named light_field, or one alone"):
        read_light_field(tmp_path / "two.npz")
    np.save(tmp_path / "x.npy", GRAY)
    with pytest.raises(ParameterError, match="views = 3: must be left out"):
        read_light_field(tmp_path / "x.npy", 3)
    with pytest.raises(ParameterError, match="depth = .*: must be left out"):
        load(str(tmp_path / "x.npy"), SMALL, depth="d.npy")
    with pytest.raises(ParameterError, match="white = 0: must be"):
        write_light_field(LightField(FLOAT), tmp_path / "x.png", white=0)
    with pytest.raises(ParameterError, match="must be 8 bits in pictures"):
        write_light_field(LightField(np.stack([DEEP] * 3, -1)), tmp_path / "folder")
    assert not (tmp_path / "folder").exists()
