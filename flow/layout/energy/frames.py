"""The frames whose energy is measured: a few tiles of the default sensor, each varying one thing of the first."""

from collections.abc import Sequence
from dataclasses import dataclass, field, fields, replace
from functools import partial

import numpy as np
import numpy.typing as npt

from talbot.flow.layout.steps.stimulus import SCENE, middle
from talbot.imaging.frame.job import expose, see
from talbot.imaging.frame.request import FrameRequest, request
from talbot.models.afe import FrontEnd
from talbot.models.afe.trim import trim_gain
from talbot.models.chip import front_end_of
from talbot.models.parameters import ALL_TYPES, AmpTiming, ParameterError, Window

Values = npt.NDArray[np.float64]
INTEGRATION = 64  # cycles; short, so that most of a frame's cycles convert
HALF_THE_TYPES = 0x555555
RECORDED_TILES = 1  # of the chip's frame with delays (`chain.CHIP_TILES`)


@dataclass(frozen=True)
class EnergyFrame:
    """One frame, its fields as those of a request of `make sim`; a wrong value is refused there.

    The pixels hold the default exposure; t_int, n_cm, exposure are the chip's alone. first, last: tile row and column
    of the window's corners, both included. recorded: the frame that `make layout` simulates with delays
    (`steps.stimulus`), in place of what the other fields say. lit_as: the frame whose exposure the pixels hold.
    """

    name: str
    scene: str = SCENE
    mode: str = "edge"
    threshold: int = 10
    phase: bool = False
    mask: int = ALL_TYPES
    n_cm: int = 0
    exposure: int = field(default=0, metadata={"unit": "rows"})
    t_int: int = field(default=INTEGRATION, metadata={"unit": "cycles"})
    first: tuple[int, int] = (48, 32)
    last: tuple[int, int] = (49, 63)
    recorded: bool = False
    lit_as: str = "edge"

    def requested(self) -> FrameRequest:
        """The request whose exposure the pixels hold, with the default timing. Raises ParameterError."""
        if self.recorded:
            return request(scene=SCENE, mode="tof", phase=True, window=partial(middle, tiles=RECORDED_TILES))
        corners = *self.first, *self.last
        return request(
            scene=self.scene,
            mode=self.mode,
            threshold=self.threshold,
            phase=self.phase,
            mask=self.mask,
            window=lambda full: Window(corners[0], corners[2], corners[1], corners[3]),
        )

    def light(self) -> tuple[Values, tuple[int, ...]]:
        """What the pixels of its window hold, (taps, rows, cols, 2), and the types' trims. Raises ParameterError."""
        asked = self.requested()
        exposed = expose(asked, *see(asked))
        return exposed.samples, exposed.front_end.trim

    def shot(self, samples: Values, trims: Sequence[int]) -> tuple[FrameRequest, Values, FrontEnd]:
        """The frame with its own timing, the samples and the front end, for light of `light`.

        Trims are at their resets, so that none is written over SPI; in edge mode diodes b have them: the values ahead
        of the converters are the same. The recorded frame is as it was.
        """
        asked = self.requested()
        if self.recorded:
            return asked, samples, front_end_of(asked.lit, trims)
        timing = AmpTiming(t_int=self.t_int, n_cm=self.n_cm, exposure=self.exposure)
        if self.mode == "edge":
            trimmed = samples[..., 1] * trim_gain(trims)[asked.sensor.tile.type_map(*samples.shape[1:3])]
            samples = np.stack([samples[..., 0], trimmed], -1)
        untrimmed = front_end_of(asked.lit, [0] * len(trims))
        return replace(asked, frame=replace(asked.frame, timing=timing)), samples, untrimmed

    @property
    def varies(self) -> str:
        """What differs from the first frame, in words."""
        if self.recorded:
            return "one tile in time of flight with phases, as simulated with delays"
        pairs = [(f.name, getattr(self, f.name)) for f in fields(self) if f.name not in ("name", "lit_as")]
        plain = vars(EnergyFrame(""))
        changed = [
            f"{name} {value:#x}" if name == "mask" else f"{name} {value}"
            for name, value in pairs
            if value != plain[name]
        ]
        return ", ".join(changed) or "edge mode, eight rows of 32 tiles, the scene of make sim"


FRAMES = (
    EnergyFrame("edge"),
    EnergyFrame("image", mode="image"),
    EnergyFrame("raw", mode="raw", last=(49, 47)),
    EnergyFrame("tof", mode="tof", last=(49, 39), lit_as="tof"),
    EnergyFrame("phase", mode="tof", phase=True, last=(49, 39), lit_as="tof"),
    EnergyFrame("threshold", threshold=64),
    EnergyFrame("all", threshold=0),
    EnergyFrame("mask", mask=HALF_THE_TYPES),
    EnergyFrame("resets", n_cm=8),
    EnergyFrame("exposure", exposure=8),
    EnergyFrame("idle", t_int=500, last=(49, 32)),
    EnergyFrame("lanes", last=(49, 34)),
)
# Predicted by the fit of the others: another scene, window, threshold, mask and integration
WINDOW = 60, 20, 61, 47  # its first and last tile row and column
HELD_BACK = EnergyFrame(
    "held_back", "coins", threshold=16, mask=0xFFF0FF, t_int=200, first=WINDOW[:2], last=WINDOW[2:], lit_as="held_back"
)
RECORDED = EnergyFrame("recorded", recorded=True, lit_as="recorded")
EVERY = (*FRAMES, HELD_BACK, RECORDED)


def frame_named(name: str) -> EnergyFrame:
    """The frame of that name. Raises ParameterError."""
    known = {frame.name: frame for frame in EVERY}
    if name not in known:
        raise ParameterError(f"frame = {name!r}: must be one of {', '.join(known)}")
    return known[name]
