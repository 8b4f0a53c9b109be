"""Frames for the tests: configurations of every kind, and samples as sparse or as rough as wanted."""

import numpy as np
from hypothesis import strategies as st

from talbot.models.digital.stream import StreamHeader
from talbot.models.parameters import LANES, MODES, AmpTiming, FrameParameters, ParameterError, Window


def header_of(rows, cols, lanes=8, **frame):
    """The header of a frame that reads the whole array, unless ``window`` says less."""
    window = frame.pop("window", None) or Window(0, -(-rows // 4) - 1, 0, -(-cols // 6) - 1)
    return StreamHeader.from_frame(rows, cols, lanes, FrameParameters(window, **frame))


def ports_of(header):
    """RunLength's configuration ports for a frame: name -> value."""
    w = header.window
    same = ["phase", "decimation", "mask", "threshold", "frame_number"]
    same += ["resync", "exposure", "n_cm", "t_int", "calibration"]
    corners = {"row0": w.row0, "row1": w.row1, "col0": w.col0, "col1": w.col1}
    return {"mode": MODES.index(header.mode), **corners, **{name: int(getattr(header, name)) for name in same}}


def samples_of(header, seed, share=0.2, scale=20):
    """Codes as the converters give them: int64 (rows, cols, subs); zero where nothing is read.

    share: part of them that is not zero where they are signed. scale: of their magnitudes.
    """
    rng = np.random.default_rng(seed)
    shape = header.rows, header.cols, header.subs
    if header.edge:
        codes = np.clip(np.rint(rng.laplace(0, scale, shape)), -128, 127).astype(int)
        codes[rng.random(shape) >= share] = 0
        codes = np.sign(codes) if header.mode == "ternary" else np.where(abs(codes) < header.threshold, 0, codes)
    else:
        codes = rng.integers(0, 256, shape)
    layout, out = header.layout(), np.zeros(shape, int)
    for i, row in enumerate(layout.rows):
        here = row, layout.places_of(i)
        out.reshape(header.rows, -1)[here] = codes.reshape(header.rows, -1)[here]
    return out


@st.composite
def headers(draw):
    """Any header of a small array that reads something."""
    while True:
        rows, cols = draw(st.integers(1, 20)), draw(st.integers(1, 50))
        row0, row1 = sorted(draw(st.integers(0, (rows - 1) // 4)) for _ in range(2))
        col0, col1 = sorted(draw(st.integers(0, (cols - 1) // 6)) for _ in range(2))
        mode = draw(st.sampled_from(MODES))
        header = header_of(
            rows,
            cols,
            draw(st.sampled_from(LANES)),
            window=Window(row0, row1, col0, col1),
            mode=mode,
            mask=draw(st.integers(1, 2**24 - 1) | st.just(2**24 - 1)),
            threshold=draw(st.integers(0, 127)),
            decimation=draw(st.integers(0, 3)),
            phase=mode == "tof" and draw(st.booleans()),
            frame_number=draw(st.integers(0, 65535)),
            resync=draw(st.integers(0, 3)),
            calibration=draw(st.integers(0, 255)),
            timing=AmpTiming(
                n_cm=draw(st.integers(0, 255)), t_int=draw(st.integers(1, 65535)), exposure=draw(st.integers(0, 1023))
            ),
        )
        try:
            header.layout()
        except ParameterError:
            continue
        return header
