"""Labelled pictures: the shipped digits, IDX files, CIFAR's binary batches, .npz, a folder with a folder a class."""

import gzip
import hashlib
import zlib
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
import numpy.typing as npt
from PIL import Image, UnidentifiedImageError

from talbot.models import recognition
from talbot.models.parameters import ParameterError
from talbot.models.scene.file_form import ARRAY_ERRORS
from talbot.models.scene.resample import linear

DIGITS = Path(recognition.__file__).with_name("digits.npz")  # [Kaynak1998]
SIZE = 28  # px, of pictures in folders
SUFFIXES = {".png", ".jpg", ".jpeg", ".bmp", ".gif", ".webp", ".tif", ".tiff"}
TEST = 0.2  # of the pictures, where the data have no test set
IDX = (("train-images*idx3-ubyte*", "train-labels*idx1-ubyte*"), ("t10k-images*idx3-ubyte*", "t10k-labels*idx1-ubyte*"))
CIFAR = 3073  # bytes of a picture


@dataclass(frozen=True, eq=False)
class Pictures:
    """Gray pictures (n, height, width), sRGB codes; labels (n,), 0..classes-1; the test set (n,), or None."""

    name: str
    images: npt.NDArray[np.uint8]
    labels: npt.NDArray[np.int64]
    test: npt.NDArray[np.bool_] | None = None

    @property
    def classes(self) -> int:
        """Number of classes."""
        return int(self.labels.max()) + 1

    @cached_property
    def radiance(self) -> npt.NDArray[np.float32]:
        """Linear radiance, 1 = white, (n, height, width)."""
        return linear(self.images.reshape(len(self.images), -1)).reshape(self.images.shape)

    @property
    def digest(self) -> str:
        """Of the pictures, the labels and the test set."""
        test = b"" if self.test is None else self.test.tobytes()
        return hashlib.sha256(self.images.tobytes() + self.labels.tobytes() + test).hexdigest()

    def part(self, most: int | None) -> "Pictures":
        """At most ``most`` pictures, drawn at random, always the same. Raises ParameterError as `checked`."""
        if most is None or most >= len(self.labels):
            return self
        chosen = np.sort(np.random.default_rng(most).permutation(len(self.labels))[:most])
        test = None if self.test is None else self.test[chosen]
        return checked(Pictures(self.name, self.images[chosen], self.labels[chosen], test))

    def split(self, seed: int) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]:
        """Numbers of the pictures to train on and to test on; drawn by the seed where the data have no test set."""
        if self.test is not None:
            return np.flatnonzero(~self.test), np.flatnonzero(self.test)
        order = np.random.default_rng([seed, 55]).permutation(len(self.labels))
        count = max(round(TEST * len(order)), 1)
        return order[count:], order[:count]


def load(name: str) -> Pictures:
    """Load 'digits', an .npz (images, labels, perhaps test), or a folder. Raises ParameterError."""
    path = Path(name)
    if name == "digits":
        with np.load(DIGITS) as file:
            codes = np.round(file["images"] * (255 / 16)).astype(np.uint8)
            return Pictures("digits", codes, file["labels"].astype(np.int64))
    if path.suffix == ".npz" and path.is_file():
        return checked(_npz(path))
    if not path.is_dir():
        raise ParameterError(f"data = {name!r}: must be digits, an .npz file or a folder")
    for read in (_idx, _cifar, _folders):
        if (pictures := read(path)) is not None:
            return checked(pictures)
    raise ParameterError(f"data = {name!r}: must hold IDX files, CIFAR's .bin batches, or a folder for each class")


def checked(data: Pictures) -> Pictures:
    """Return ``data``. Raises ParameterError where arrays do not fit, or a class or a test set has too few."""
    if data.labels.ndim != 1:
        raise ParameterError(f"data {data.name}: labels = {data.labels.shape}: must have one axis")
    n, shape = len(data.labels), data.images.shape
    if data.images.dtype != np.uint8 or len(shape) != 3 or shape[0] != n or min(shape[1:]) < 4:
        raise ParameterError(
            f"data {data.name}: images = {data.images.dtype} {shape}: must be uint8 ({n}, height, width)"
        )
    if n < 10 or data.labels.min() < 0 or data.classes < 2:
        raise ParameterError(f"data {data.name}: {n} pictures: must be 10 or more, of 2 classes or more")
    if data.test is not None and (data.test.shape != (n,) or data.test.all() or not data.test.any()):
        raise ParameterError(f"data {data.name}: test = {int(data.test.sum())} of {n}: must leave some to train on")
    return data


def _npz(path: Path) -> Pictures:
    try:
        with np.load(path, allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
        images, labels = arrays["images"], arrays["labels"].astype(np.int64)
    except ARRAY_ERRORS as error:
        raise ParameterError(f"data = {str(path)!r}: must have the arrays images and labels ({error})") from None
    test = arrays.get("test")
    return Pictures(path.stem, images, labels, None if test is None else test.astype(bool))


def _idx(folder: Path) -> Pictures | None:
    """Return the files of MNIST and its kin, gzipped or not; the test set where there is one."""
    parts = []
    for patterns in IDX:
        files = [sorted(folder.glob(pattern)) for pattern in patterns]
        if all(files):
            parts.append([_idx_array(matches[0]) for matches in files])
    if not parts:
        return None
    counts = [len(labels) for _, labels in parts]
    test = np.repeat([False, True], counts) if len(parts) == 2 else None
    images, labels = (np.concatenate([part[i] for part in parts]) for i in (0, 1))
    return Pictures(folder.name, images, labels.astype(np.int64), test)


def _idx_array(path: Path) -> npt.NDArray[np.uint8]:
    try:
        data = gzip.decompress(path.read_bytes()) if path.suffix == ".gz" else path.read_bytes()
        axes = data[3]
        shape = tuple(int(n) for n in np.frombuffer(data, ">i4", axes, 4))
        if data[:3] != b"\0\0\x08":
            raise ValueError("no bytes")
        return np.frombuffer(data, np.uint8, offset=4 + 4 * axes).reshape(shape)
    except (OSError, EOFError, ValueError, IndexError, zlib.error) as error:
        raise ParameterError(f"data = {str(path)!r}: must be an IDX file of bytes ({error})") from None


def _cifar(folder: Path) -> Pictures | None:
    """Return the binary version of CIFAR-10: data_batch_*.bin and test_batch.bin; gray by Rec. 601."""
    files = [*sorted(folder.glob("data_batch_*.bin")), *folder.glob("test_batch.bin")]
    if not files:
        return None
    records = []
    for file in files:
        data = np.fromfile(file, np.uint8)
        if data.size % CIFAR or not data.size:
            raise ParameterError(f"data = {str(file)!r}: {data.size} bytes: must be records of {CIFAR}")
        records.append(data.reshape(-1, CIFAR))
    test = np.repeat([file.name.startswith("test") for file in files], [len(part) for part in records])
    every = np.concatenate(records)
    colour = every[:, 1:].reshape(-1, 3, 32, 32).astype(np.float32)
    gray = np.round(np.einsum("nchw,c->nhw", colour, np.array([0.299, 0.587, 0.114], np.float32))).astype(np.uint8)
    return Pictures(folder.name, gray, every[:, 0].astype(np.int64), None if test.all() or not test.any() else test)


def _folders(folder: Path) -> Pictures | None:
    """Return a folder a class, or train/ and test/ with these: each picture's middle square, SIZE px wide, in gray."""
    tops = [folder / name for name in ("train", "test")]
    tops = tops if all(top.is_dir() for top in tops) else [folder]
    names = sorted({inner.name for top in tops for inner in top.iterdir() if inner.is_dir()})
    images, labels, test = [], [], []
    for top in tops:
        for number, name in enumerate(names):
            for file in sorted((top / name).glob("*")):
                if file.suffix.lower() in SUFFIXES:
                    images.append(picture(file))
                    labels.append(number)
                    test.append(top.name == "test" and len(tops) > 1)
    if not images:
        return None
    return Pictures(folder.name, np.stack(images), np.array(labels), np.array(test) if len(tops) > 1 else None)


def picture(path: Path, size: int = SIZE) -> npt.NDArray[np.uint8]:
    """Return the middle square of a picture file in gray, (size, size). Raises ParameterError."""
    try:
        with Image.open(path) as image:
            gray = image.convert("L")
    except (OSError, UnidentifiedImageError, Image.DecompressionBombError) as error:
        raise ParameterError(f"data = {str(path)!r}: must be a picture ({error})") from None
    side = min(gray.size)
    left, top = (gray.width - side) // 2, (gray.height - side) // 2
    return np.asarray(gray.resize((size, size), Image.Resampling.BOX, (left, top, left + side, top + side)))
