"""Views of a lens as Mitsuba's frusta, what the command writes and refuses, small scenes by Mitsuba itself."""

import json
import sys

import numpy as np
import pytest

from talbot.commands import main
from talbot.imaging.render import frustum
from talbot.imaging.render.command import short
from talbot.models.parameters import LIFE_SIZE
from talbot.models.scene import Sampling, camera, read_light_field
from talbot.models.scene.rendered import RENDERED

LENS = Sampling(24, 36, camera=LIFE_SIZE)


@pytest.mark.parametrize("depth", [2.0, 3.0, 5.0])
def test_a_point_moves_between_views_by_its_disparity(depth):
    """A point that the middle view shows at (y, x) is on the ray of view (dv, du) that is a disparity away."""
    d = float(camera.disparity(depth, LENS))
    y, x = 7, 20
    origin, aim = frustum.rays(LENS, 0, 0)
    point = (origin + depth * aim)[:, y * LENS.cols + x]
    for dv, du in ((0, 2), (-2, 0), (1, -1)):
        origin, aim = frustum.rays(LENS, dv, du)
        seen = (origin + depth * aim).reshape(3, *LENS.shape)
        for axis, shift, n, at in ((0, du, seen[0, 0], x), (1, dv, seen[1, :, 0], y)):
            order = np.argsort(n)
            np.testing.assert_allclose(np.interp(point[axis], n[order], order), at - shift * d, atol=1e-6)


def test_what_is_kept_is_finer_than_the_noise():
    values = np.random.default_rng(1).uniform(1e-3, 4, 1000)
    assert np.abs(short("light_field", values) / values - 1).max() < 2**-7
    assert short("depth", values).dtype == np.float32 and short("specular", values > 1).dtype == bool


@pytest.mark.parametrize(
    "word, message",
    [("--scene=nothing", "scene = 'nothing'"), ("--samples=0", "samples = '0'"), ("--size=2", "size = '2'")],
)
def test_bad_arguments(word, message, capsys, tmp_path):
    assert main(["render", word, f"--out={tmp_path / 'out'}"]) == 2
    assert message in capsys.readouterr().err and not (tmp_path / "out").exists()


def test_without_mitsuba(capsys, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "mitsuba", None)
    assert main(["render", f"--out={tmp_path / 'out'}"]) == 2
    err = capsys.readouterr().err
    assert err.count("\n") == 1 and "mitsuba = not installed" in err and not (tmp_path / "out").exists()


@pytest.fixture(scope="module")
def made(tmp_path_factory, require):
    """Folder of two small scenes by Mitsuba."""
    require("mitsuba")
    folder = tmp_path_factory.mktemp("render")
    assert main(["render", "--scene=sheet,room", "--size=24", "--views=3", "--samples=8", f"--out={folder}"]) == 0
    return folder


@pytest.mark.slow
def test_small_scenes_by_mitsuba(made, capsys):
    room, sheet = (read_light_field(made / f"{name}.npz") for name in ("room", "sheet"))
    assert room.views == 3 and room.shape == (24, 24) and 0.2 < room.echo.share.mean() < 0.9
    np.testing.assert_allclose(room.echo.late.sum(-1), 1, atol=1e-3)
    assert np.hypot(*sheet.stokes[:, 1, 1, 12, 12]) == pytest.approx(sheet.values[1, 1, 12, 12], rel=0.02)  # the hole
    known = json.loads((made / "rendered.json").read_text())
    assert set(known) == {"sheet", "room"} <= set(RENDERED)
    before = (made / "room.npz").stat().st_mtime_ns
    assert main(["render", "--scene=room", "--size=24", "--views=3", "--samples=8", f"--out={made}"]) == 0
    assert (made / "room.npz").stat().st_mtime_ns == before  # as it was made


@pytest.mark.slow
def test_mitsubas_views_have_the_disparity_of_the_thin_lens(made):
    """A textured plane behind the focal plane, rendered: its picture moves by what the lens says."""
    import mitsuba as mi
    from skimage.registration import phase_cross_correlation

    from talbot.imaging.render import variant

    variant.use(variant.PLAIN)
    texture = mi.Bitmap(np.random.default_rng(2).random((256, 256, 1)).astype(np.float32))
    sampling = Sampling(64, 64, camera=LIFE_SIZE)
    for depth in (2.2, 4.0):
        plane = {"type": "rectangle", "to_world": mi.ScalarTransform4f().translate([0, 0, -depth]).scale(0.5)}
        plane["bsdf"] = {"type": "diffuse", "reflectance": {"type": "bitmap", "bitmap": texture, "raw": True}}
        light = {"light": {"type": "constant"}, "by": {"type": "path", "max_depth": 2}}
        scene = mi.load_dict({"type": "scene", "plane": plane} | light)
        film = {"type": "hdrfilm", "pixel_format": "luminance"}
        seen = [
            np.array(mi.render(scene, sensor=mi.load_dict(frustum.perspective(sampling, dv, du, film)), spp=64))[..., 0]
            for dv, du in ((0, -1), (0, 1), (-1, 0), (1, 0))
        ]
        d = float(camera.disparity(depth, sampling))
        for first, last, want in ((0, 1, (0, 2 * d)), (2, 3, (2 * d, 0))):
            found = phase_cross_correlation(seen[first], seen[last], upsample_factor=50, normalization=None)[0]
            np.testing.assert_allclose(found, want, atol=0.12)
