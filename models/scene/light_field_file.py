"""Light fields in files, as the data sets and NumPy have them.

x.npy               the array
x.npz               `light_field` (or the only array), and perhaps `disparity`, `depth`, `s1` with `s2`, `specular`,
                    `behind`, and `direct` with `late` and `bins` (an `Echo`'s)
folder              input_Cam000.png ... row by row, as HCI's 4D data set [Honauer2016], and gt_disp_lowres.pfm if it is
                    there; or out_RR_CC_*.png, as the Stanford archive [Vaish2008]
image, with views   one picture of views x views (or rows x columns of) tiles of one size
*_eslf.png          a lenslet image of a Lytro camera: 14 x 14 views interleaved, pixel by pixel [Raj2016]

Pictures are 8-bit or 16-bit sRGB codes, or floating-point TIFF (linear). Folders are written as HCI's, those of a
grid that is no square with Stanford's names.
"""

import math
import re
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from PIL import Image

from talbot.models.parameters import ParameterError, check_int, check_real
from talbot.models.scene.echo import Echo
from talbot.models.scene.file_form import ARRAY_ERRORS
from talbot.models.scene.light_field import LightField
from talbot.models.scene.picture_file import FLOAT_MAX, encode16, read_picture
from talbot.models.scene.scene import RADIANCE_MAX

SUFFIXES = ".npy", ".npz"
PICTURES = "png|jpe?g|tiff?|webp|bmp|ppm|pgm"
HCI = re.compile(rf"input_Cam(\d{{3}})\.(?:{PICTURES})", re.I)
STANFORD = re.compile(rf"out_(\d+)_(\d+)(?:_.*)?\.(?:{PICTURES})", re.I)
DISPARITY = "gt_disp_lowres.pfm"
MAPS = "disparity", "depth", "specular", "behind"  # in an .npz, of the middle view; disparity of all views, too
STOKES = "s1", "s2"
ECHO = "direct", "late", "bins"  # shares, histograms, middle of the first bin and distance of the bins
BYTES_MAX = 1 << 32  # of a light field in memory
TILED = re.compile(rf"(.+\.(?:{PICTURES})):(.*)", re.I | re.S)  # on the command line: tiles.png:9, tiles.png:3x5
LENSLETS = re.compile(rf".*_eslf\.(?:{PICTURES})", re.I)  # names of lenslet images
LENSLET = 14  # their views along each axis


def named(scene: str) -> Callable[[], LightField] | None:
    """Return the reader of a scene's name on the command line, where it is a light field's.

    scene: a folder, a .npy or .npz file, a lenslet image, image:views, or image:rows x columns of views. Returns
    callable or None: reads it; None for another kind of scene.
    """
    tiled = TILED.fullmatch(scene)
    if tiled and not Path(scene).exists():
        counts = [int(count) if count.isdecimal() and len(count) < 9 else count for count in tiled[2].split("x")]
        return lambda: read_light_field(tiled[1], tuple(counts) if len(counts) == 2 else tiled[2] and counts[0])
    lenslets = LENSLETS.fullmatch(scene) and Path(scene).is_file()
    whole = lenslets or Path(scene).is_dir() or scene.lower().endswith(SUFFIXES)
    return (lambda: read_light_field(scene)) if whole else None


def read_light_field(path: str | Path, views: Any = None) -> LightField:
    """Read a light field.

    path: as the head of this file lists. views: int or (int, int), views along each axis, or rows of views and views in
    a row, 1..31; of one image alone: tiles must have it, lenslet images have 14. Returns LightField: with the file's or
    folder's name. Raises ParameterError for what is missing, damaged, incomplete or of a wrong shape or type.
    """
    path = Path(path)
    numpy = path.suffix.lower() in SUFFIXES
    if views is not None and (numpy or path.is_dir()):
        raise ParameterError(f"views = {views!r}: must be left out, {str(path)!r} has its own")
    if path.is_dir():
        return _folder(path)
    if numpy:
        return _numpy(path)
    lenslets = LENSLETS.fullmatch(path.name)
    views = LENSLET if lenslets and views is None else views
    picture = read_picture(path)
    grid = tuple(views) if isinstance(views, tuple | list) else (views, views)
    for count in grid:
        check_int("views", count, 1, 31)
    if len(grid) != 2:
        raise ParameterError(f"views = {views!r}: must be an integer, or rows and columns of views")
    (down, across), (height, width), channels = map(int, grid), picture.shape[:2], picture.shape[2:]
    if height % down or width % across:
        said = str(down) if down == across else f"{down} x {across}"
        raise ParameterError(f"views = {said}: must divide the image's height and width, {height} x {width}")
    if lenslets:
        values = picture.reshape(height // down, down, width // across, across, *channels)
        return LightField(values.transpose(1, 3, 0, 2, *range(4, values.ndim)), name=path.stem)
    tiles = picture.reshape(down, height // down, across, width // across, *channels)
    return LightField(tiles.swapaxes(1, 2), name=path.stem)


def write_light_field(light_field: LightField, path: str | Path, white: float = 1.0) -> str:
    """Write a light field in the form of the path's name.

    light_field: the light field. Pictures take its codes as they are; linear radiance of 0..white becomes sRGB codes,
    gray of 16 bits, colours of 8, and is clipped to that. path: x.npy, x.npz, an image file (16 bits: .png, .tif), or a
    folder without a dot in its name, which is created. Disparity goes into .npz and folders alone, depth, Stokes
    parameters and highlights into .npz. white: radiance of a picture's largest code, 0.001..16: what is read from it is
    the radiance over ``white``. Returns str: what was clipped, in a line; empty where nothing was, as in .npy and .npz.
    Raises ParameterError for 16-bit colours in pictures, another kind of file, and a white out of range. Raises OSError
    if it cannot be written.
    """
    path, values = Path(path), light_field.values
    check_real("white", white, 1e-3, RADIANCE_MAX)
    if path.suffix.lower() == ".npy":
        with path.open("wb") as file:  # numpy adds a suffix to the name X.NPY
            np.save(file, values)
    elif path.suffix.lower() == ".npz":
        arrays = {name: getattr(light_field, name) for name in MAPS}
        if light_field.stokes is not None:
            arrays |= dict(zip(STOKES, light_field.stokes, strict=True))
        if light_field.echo is not None:
            echo = light_field.echo
            arrays |= dict(zip(ECHO, (echo.share, echo.late, np.array([echo.start, echo.width])), strict=True))
        present = {name: array for name, array in arrays.items() if array is not None}
        with path.open("wb") as file:
            np.savez_compressed(file, allow_pickle=False, light_field=values, **present)
    elif re.fullmatch(rf"\.(?:{PICTURES})", path.suffix, re.I):
        tiles = _codes(values, white).swapaxes(1, 2)
        high, tall, wide, broad, *colours = tiles.shape
        picture = Image.fromarray(tiles.reshape(high * tall, wide * broad, *colours))
        if picture.mode == "I;16" and path.suffix.lower() == ".webp":  # Pillow writes white
            raise ParameterError(f"path = {path.name!r}: must be .png or .tif, for 16 bits")
        try:
            picture.save(path, lossless=True, quality=95)  # of WebP and JPEG; other forms take neither
        except OSError as error:
            if not str(error).startswith("cannot write mode"):
                raise
            raise ParameterError(f"path = {path.name!r}: must be .png or .tif, for 16 bits ({error})") from None
        return _clipped(values, white)
    elif path.suffix:
        raise ParameterError(
            f"path = {path.name!r}: must end in .npy, .npz, .png or .tif, or be a folder without a dot"
        )
    else:
        codes = _codes(values, white)
        path.mkdir(exist_ok=True)
        for i, place in enumerate(np.ndindex(light_field.grid)):
            square = len(set(light_field.grid)) == 1
            name = f"input_Cam{i:03d}.png" if square else "out_{:02d}_{:02d}.png".format(*place)
            Image.fromarray(codes[place]).save(path / name)
        if light_field.disparity is not None:
            Image.fromarray(light_field.disparity.astype(np.float32)).save(path / DISPARITY)
        return _clipped(values, white)
    return ""


def _clipped(values: npt.NDArray[Any], white: float) -> str:
    low, high = float(values.min()), float(values.max())
    if values.dtype.kind != "f" or (low >= 0 and high <= white):
        return ""
    share = float(((values < 0) | (values > white)).mean())
    return (
        f"light field = {low:.3g}..{high:.3g}: {100 * share:.2g} % of the values are clipped to 0..{white:g} in "
        "pictures; .npy and .npz keep them"
    )


def _codes(values: npt.NDArray[Any], white: float) -> npt.NDArray[Any]:
    """Convert to the codes that a PNG can hold: uint8, or uint16 of gray."""
    colour = values.ndim == 5
    if values.dtype.kind == "f":
        codes = encode16(np.clip(values.astype(float) / white, 0, 1)) * (255 if colour else 65535)
        return np.rint(codes).astype(np.uint8 if colour else np.uint16)
    if colour and values.dtype == np.uint16:
        raise ParameterError("light field = uint16 colours: must be 8 bits in pictures; write .npy or .npz")
    return values


def _folder(path: Path) -> LightField:
    entries = sorted(entry for entry in path.iterdir() if entry.is_file())
    hci = {int(m[1]): entry for entry in entries if (m := HCI.fullmatch(entry.name))}
    stanford = {(int(m[1]), int(m[2])): entry for entry in entries if (m := STANFORD.fullmatch(entry.name))}
    count = len(hci) or len(stanford)
    if not count:
        raise ParameterError(
            f"scene = {str(path)!r}: must be an image file, not a folder without input_Cam000.png ... "
            "or out_00_00*.png ...; talbot sequence takes a folder of frames"
        )
    if hci:
        side = math.isqrt(count)
        grid, files = (side, side), {divmod(i, side): entry for i, entry in hci.items()}
    else:
        grid, files = (max(v for v, _ in stanford) + 1, max(u for _, u in stanford) + 1), stanford
    for side in grid:
        check_int("views", side, 1, 31)
    gaps = [place for place in np.ndindex(grid) if place not in files]
    if gaps or count != grid[0] * grid[1]:
        missing = f"row {gaps[0][0]}, column {gaps[0][1]}" if gaps else "another row"
        raise ParameterError(
            f"scene = {str(path)!r}: has {count} views: must be a {'square' if hci else 'rectangle'} of them; "
            f"of {grid[0]} x {grid[1]} is missing {missing}"
        )
    first = read_picture(files[0, 0])
    if first.nbytes * count > BYTES_MAX:
        raise ParameterError(f"scene = {str(path)!r}: {first.nbytes * count} bytes: must be at most {BYTES_MAX}")
    values = np.empty((*grid, *first.shape), first.dtype)
    for place in np.ndindex(grid):
        view = first if place == (0, 0) else read_picture(files[place])
        if view.shape != first.shape or view.dtype != first.dtype:
            raise ParameterError(
                f"scene = {str(files[place])!r}: {view.dtype} {view.shape}: must be as the first view, "
                f"{first.dtype} {first.shape}"
            )
        values[place] = view
    disparity = read_picture(path / DISPARITY, -FLOAT_MAX, FLOAT_MAX) if (path / DISPARITY).is_file() else None
    return LightField(values, disparity, path.resolve().name)


def _numpy(path: Path) -> LightField:
    if not path.is_file():
        raise ParameterError(f"scene = {str(path)!r}: no such file; must be a readable file")
    more: dict[str, Any] = {}
    try:
        if path.suffix.lower() == ".npy":
            values = np.load(path, mmap_mode="r", allow_pickle=False)
        else:
            if any(item.file_size > BYTES_MAX for item in zipfile.ZipFile(path).infolist()):
                raise ParameterError(f"scene = {str(path)!r}: arrays must have at most {BYTES_MAX} bytes")
            with np.load(path, allow_pickle=False) as archive:
                key = archive.files[0] if len(archive.files) == 1 else "light_field"
                if key not in archive:
                    raise ParameterError(f"scene = {str(path)!r}: must hold an array named light_field, or one alone")
                values = archive[key]
                if key == "light_field":
                    more = {name: archive[name] for name in MAPS if name in archive}
                    stokes = [archive[name] for name in STOKES if name in archive]
                    if len(stokes) == 1 or len({part.shape for part in stokes}) > 1:
                        raise ParameterError(
                            f"scene = {str(path)!r}: must hold s1 and s2 of one shape, or none of them"
                        )
                    more |= {"stokes": np.stack(stokes)} if stokes else {}
                    more |= _echo({name: archive[name] for name in ECHO if name in archive}, path)
    except ARRAY_ERRORS as error:
        if isinstance(error, ParameterError):
            raise
        objects = "Object arrays" in str(error) or "Python objects" in str(error)
        why = "has objects: must have numbers" if objects else f"must be a NumPy array file ({type(error).__name__})"
        raise ParameterError(f"scene = {str(path)!r}: {why}") from None
    return LightField(values, name=path.stem, **more)


def _echo(arrays: dict[str, npt.NDArray[Any]], path: Path) -> dict[str, Echo]:
    if not arrays:
        return {}
    if len(arrays) < len(ECHO) or arrays["bins"].shape != (2,):
        raise ParameterError(f"scene = {str(path)!r}: must hold {', '.join(ECHO)} together, bins of two numbers")
    share, late, bins = (arrays[name].astype(np.float32) for name in ECHO)
    return {"echo": Echo(share, late, float(bins[0]), float(bins[1]))}
