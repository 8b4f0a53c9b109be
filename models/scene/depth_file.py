"""From a depth file next to a picture to metres from the camera. The files hold metres of the scene (1:scale).

.npy                (rows, cols), depth in m, 0.1..1000
.npz                one array: `depth` (m, the same) or `disparity` (px per view step, -100..100, against
                    `camera.REFERENCE`, at the array's size)
image, 9..16 bits   depth in mm, 100..65535
image, 1..8 bits    inverse depth: 0 is 6 m, 255 is 2 m, linear in 1/m (brighter is nearer)
"""

import zipfile
from pathlib import Path

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import ParameterError
from talbot.models.scene import camera, resample
from talbot.models.scene.file_form import ARRAY_ERRORS
from talbot.models.scene.picture_file import read_codes
from talbot.models.scene.sampling import Sampling
from talbot.models.scene.scene import check_values

NEAR, FAR = 2.0, 6.0  # m, of 8-bit images
BYTES_MAX = 2**30  # of an array in an .npz


def read_depth(path: str | Path, sampling: Sampling, picture_shape: tuple[int, int]) -> npt.NDArray[np.float64]:
    """Read a depth file.

    path: the file. sampling: size of the array, and views. picture_shape: (int, int), height and width of the picture
    that the file belongs to. The crop is the same; the resolution may differ, the proportions by 2 % at most. Returns
    (rows, cols): depth in m from the camera. Raises ParameterError for a file that is missing or damaged, a wrong
    shape, or a value out of range.
    """
    values, kind = _read(Path(path))
    if values.ndim != 2 or 0 in values.shape:
        raise ParameterError(f"depth shape = {values.shape}: must be (rows, cols)")
    height, width = values.shape
    if not _alike(height, width, *picture_shape):
        turned = "; turned by the image's EXIF orientation it has them" if _alike(width, height, *picture_shape) else ""
        raise ParameterError(
            f"depth shape = {values.shape}: must have the proportions of the image, {picture_shape}{turned}"
        )
    values = resample.pick(values, *sampling.shape, box=resample.centre_box(height, width, *sampling.shape))
    if kind == "disparity":
        check_values("disparity", values, -100, 100)
        return camera.depth(values, sampling, float(camera.scaled(camera.REFERENCE, sampling.camera)))
    if kind == "inverse":
        return camera.scaled(1 / (1 / FAR + values / 255 * (1 / NEAR - 1 / FAR)), sampling.camera)
    if kind == "mm":
        values = values / 1000
    if (values == 0).any():
        raise ParameterError(
            "depth = 0: every value must be a finite number in [0.1, 1000]; 0 is a hole where nothing was measured: "
            "fill it first"
        )
    check_values("depth", values, 0.1, 1000)
    return camera.scaled(values, sampling.camera)


def _alike(height: int, width: int, rows: int, cols: int) -> bool:
    """Return whether two sizes have the same proportions, to 2 %."""
    return abs(np.log(width / height * rows / cols)) <= 0.02


def _read(path: Path) -> tuple[npt.NDArray[np.generic], str]:
    """Values of a file and their kind: depth, disparity, mm or inverse."""
    if path.suffix.lower() not in (".npy", ".npz"):
        codes = read_codes(path, "depth")
        return codes, "mm" if codes.dtype == np.uint16 else "inverse"
    if not path.is_file():
        raise ParameterError(f"depth = {str(path)!r}: no such file; must be a readable file")
    try:
        if path.suffix.lower() == ".npy":
            values, kind = np.load(path, mmap_mode="r", allow_pickle=False), "depth"
        else:
            if any(item.file_size > BYTES_MAX for item in zipfile.ZipFile(path).infolist()):
                raise ParameterError(f"depth = {str(path)!r}: arrays must have at most {BYTES_MAX} bytes")
            with np.load(path, allow_pickle=False) as archive:
                kind = next((name for name in ("depth", "disparity") if name in archive), None)
                if kind is None:
                    raise ParameterError(f"depth = {str(path)!r}: must hold an array named depth or disparity")
                values = archive[kind]
    except ARRAY_ERRORS as error:
        if isinstance(error, ParameterError):
            raise
        raise ParameterError(f"depth = {str(path)!r}: must be a NumPy array file ({type(error).__name__})") from None
    if values.dtype.kind not in "iuf":
        raise ParameterError(f"depth type = {values.dtype}: must be real numbers")
    if kind == "depth" and values.dtype.kind != "f":
        raise ParameterError(f"depth type = {values.dtype}: must be floating point, in m; of integers the unit is open")
    return values, kind
