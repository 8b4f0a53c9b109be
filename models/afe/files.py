"""Files that pixels/afe.sv loads: big-endian 64-bit words, as $fread fills them."""

from pathlib import Path

import numpy as np
import numpy.typing as npt

from talbot.models.afe.converter import Converter
from talbot.models.afe.front_end import FrontEnd


def sample_words(samples: npt.NDArray[np.float64]) -> memoryview:
    """Diode values as the bytes of a file.

    samples: (taps, rows, cols, 2), word ((tap * rows + row) * cols + col) * 2 + diode. Returns the bytes, 8 a word.
    """
    return np.ascontiguousarray(samples, ">f8").data.cast("B")


def write_samples(path: str | Path, samples: npt.NDArray[np.float64]) -> None:
    """Write diode values.

    path: the file. samples: (taps, rows, cols, 2), word ((tap * rows + row) * cols + col) * 2 + diode.
    """
    with open(path, "wb") as file:
        file.write(sample_words(samples))


def write_converter(path: str | Path, front_end: FrontEnd) -> None:
    """Write gain and imperfections of a front end.

    Words: gain, noise_scale, ktc_scale (float64), seed (integer), the amplifier's four, offset of every lane, then for
    every lane 256 bipolar levels, and for every lane 256 unipolar levels (float64).

    path: the file. front_end: source of the values.
    """
    c = front_end.converter or Converter.ideal(front_end.lanes)
    with open(path, "wb") as file:
        file.write(np.array([front_end.gain, c.noise_scale, c.ktc_scale], ">f8").tobytes())
        file.write(np.array([c.seed], ">u8").tobytes())
        file.write(np.array(c.amplifier, ">f8").tobytes())
        file.write(c.offset.astype(">f8").tobytes())
        file.write(c.levels.astype(">f8").tobytes())
