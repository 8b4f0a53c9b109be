"""Speed of a sequence: 60 frames of the default size, everything that `talbot sequence` does (make bench)."""

import numpy as np
from PIL import Image
from skimage import data

from talbot.base.progress import Frames
from talbot.imaging.frame.request import request
from talbot.imaging.sequence.outputs import rate_line, run
from talbot.models.scene import Sampling, open_clip


def pan(count, size=384):
    """A window that moves over a photograph."""
    photograph = np.asarray(Image.fromarray(data.coffee()).resize((900, 700)))
    for n in range(count):
        y, x = int(100 + 60 * np.sin(n / 9)), 4 * n
        yield Image.fromarray(photograph[y : y + size, x : x + size])


def test_sixty_frames(benchmark, tmp_path):
    first, *rest = pan(60)
    first.save(tmp_path / "pan.gif", save_all=True, append_images=rest, duration=33)
    asked = request(out=tmp_path / "out", scene="pan")

    def sequence():
        with Frames(60) as progress:
            return run(asked, open_clip(tmp_path / "pan.gif", Sampling.of(asked.sensor)), progress)

    sequence()  # the simulator is compiled
    summary = benchmark.pedantic(sequence, rounds=3)
    assert summary["frames"] == 60 and summary["frames_that_differ"] == 0
    benchmark.extra_info.update({name: summary[name] for name in ("frames_per_s", "rtl_cycles_per_s")})
    print(f"\n{rate_line(summary)}")
