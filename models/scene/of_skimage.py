"""Pictures that scikit-image ships, read by Pillow: ``skimage.io`` imports SciPy and every reader of pictures."""

from importlib.util import find_spec
from pathlib import Path

import numpy as np
import numpy.typing as npt
from PIL import Image


def folder() -> Path:
    """Folder of scikit-image's pictures.

    Returns Path: the folder. Raises ModuleNotFoundError without scikit-image.
    """
    spec = find_spec("skimage")
    if spec is None or not spec.submodule_search_locations:
        raise ModuleNotFoundError("No module named 'skimage'", name="skimage")
    return Path(spec.submodule_search_locations[0]) / "data"


def codes(name: str) -> npt.NDArray[np.uint8]:
    """Codes of a picture.

    name: of the file, without suffix. Returns (rows, cols) or (rows, cols, 3): codes 0..255. Raises ModuleNotFoundError
    without scikit-image. Raises FileNotFoundError for a picture that it does not ship.
    """
    files = [folder() / f"{name}{suffix}" for suffix in (".png", ".jpg")]
    path = next((file for file in files if file.exists()), None)
    if path is None:
        raise FileNotFoundError(f"{folder()}: no picture {name}")
    with Image.open(path) as image:
        return np.asarray(image)
