import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from talbot.models.digital.scan import Scan
from talbot.models.parameters import FrameParameters, ParameterError, TileParameters, Window


def frame_of(rows, cols, **kw):
    return FrameParameters(window=Window(0, -(-rows // 4) - 1, 0, -(-cols // 6) - 1), **kw)


@settings(max_examples=60, deadline=None)
@given(
    st.integers(1, 30),
    st.integers(1, 70),
    st.sampled_from([1, 2, 4, 8]),
    st.integers(1, 2**24 - 1),
    st.sampled_from(["edge", "raw", "tof"]),
)
def test_visits_every_unmasked_pixel_once(rows, cols, lanes, mask, mode):
    try:
        scan = Scan(rows, cols, lanes, frame_of(rows, cols, mask=mask, mode=mode))
    except ParameterError:
        assert not (mask >> TileParameters().type_map(rows, cols) & 1).any()
        return
    seen = np.zeros((rows, cols, 4), int)
    for row in scan.row_list:
        c, sub = scan.row_samples(row)
        np.add.at(seen, (row, c, sub), 1)
    wanted = mask >> TileParameters().type_map(rows, cols) & 1
    assert (seen[..., : scan.subs] == wanted[..., None]).all()
    assert not seen[..., scan.subs :].any()


def test_decimation_and_window_in_tiles():
    frame = FrameParameters(window=Window(1, 5, 3, 9), decimation=1)
    scan = Scan(40, 80, 8, frame)
    assert set(scan.row_list // 4) == {1, 3, 5}
    assert set(scan.row_samples(4)[0] // 6) == {3, 5, 7, 9}


def test_window_outside_the_array_is_named():
    with pytest.raises(ParameterError, match="window col1 = 9"):
        Scan(8, 12, 8, FrameParameters(window=Window(0, 1, 0, 9)))
