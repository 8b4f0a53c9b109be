import numpy as np
import pytest
from PIL import Image

from talbot.base.animation import Animation


def test_what_is_written_is_read_back(tmp_path):
    rng = np.random.default_rng(1)
    frames = [rng.integers(0, 256, (5, 7, 3), np.uint8) for _ in range(4)]
    with Animation(tmp_path / "a.webp") as animation:
        for frame in frames:
            animation.add(Image.fromarray(frame), 1 / 30)
    with Image.open(tmp_path / "a.webp") as found:
        assert found.n_frames == 4 and found.info["loop"] == 0
        for number, frame in enumerate(frames):
            found.seek(number)
            np.testing.assert_array_equal(np.asarray(found.convert("RGB")), frame)
        assert found.info["timestamp"] + found.info["duration"] == 133
    assert (tmp_path / "a.webp").read_bytes()[4:8] == ((tmp_path / "a.webp").stat().st_size - 8).to_bytes(4, "little")


def test_another_size_is_refused(tmp_path):
    with Animation(tmp_path / "a.webp") as animation:
        animation.add(Image.new("RGB", (7, 5)), 0.1)
        with pytest.raises(ValueError, match="must be of the animation's size"):
            animation.add(Image.new("RGB", (5, 7)), 0.1)
