import pytest

from talbot.flow.frame.arguments import pixel_types, span, window
from talbot.models.parameters import ALL_TYPES, ParameterError, Window

FULL = Window(0, 95, 0, 63)


@pytest.mark.parametrize(
    "text, mask",
    [
        ("all", ALL_TYPES),
        ("low", 0xFF),
        ("low,high", 0xFF00FF),
        ("0x10", 0x10),
        ("0,2,23", 0x800005),
        ("cosine", 0x555555),
    ],
)
def test_pixel_types(text, mask):
    assert pixel_types(text) == mask


@pytest.mark.parametrize("text", ["", "24", "-1", "0x0", "0x1000000", "lows", "0x", "1,,2"])
def test_pixel_types_refused(text):
    with pytest.raises(ParameterError, match="types = "):
        pixel_types(text)


def test_window():
    assert window("full", FULL) == FULL
    assert window("3:7,2:2", FULL) == Window(3, 7, 2, 2)
    assert window("3,2:5", FULL) == Window(3, 3, 2, 5)


@pytest.mark.parametrize("text", ["1:2", "5:2,0:3", "0:96,0:3", "0:3,0:64", "a:b,0:1", "-1:3,0:1"])
def test_window_refused(text):
    with pytest.raises(ParameterError, match="window"):
        window(text, FULL)


def test_span_names_field_value_and_range():
    with pytest.raises(ParameterError, match=r"waves = '9:12'|waves = '12'.*0\.\.10"):
        span("waves", "9:12", 0, 10)
