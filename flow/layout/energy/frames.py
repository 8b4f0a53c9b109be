"""The frames whose energy is measured: a few tiles of the default sensor, each varying one thing of the first."""

from dataclasses import dataclass, field, fields, replace
from functools import partial

from talbot.flow.frame.job import expose, see
from talbot.flow.frame.request import FrameRequest, request
from talbot.flow.frame.result import Exposed
from talbot.flow.layout.steps.stimulus import SCENE, middle
from talbot.models.afe.trim import trim_gain
from talbot.models.parameters import ALL_TYPES, AmpTiming, ParameterError, Window

INTEGRATION = 64  # cycles; short, so that most of a frame's cycles convert
HALF_THE_TYPES = 0x555555
RECORDED_TILES = 1  # of the chip's frame with delays (`chain.CHIP_FRAME`)


@dataclass(frozen=True)
class EnergyFrame:
    """One frame, its fields as those of a request of `make sim`; a wrong value is refused there.

    The pixels hold the default exposure; t_int, n_cm, exposure are the chip's alone. first, last: tile row and column
    of the window's corners, both included. recorded: the frame that `make layout` simulates with delays
    (`steps.stimulus`), in place of what the other fields say.
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

    def shot(self) -> tuple[FrameRequest, Exposed]:
        """The frame, with the timing that the chip is given, and what the pixels hold. Raises ParameterError."""
        asked = self.requested()
        exposed = expose(asked, *see(asked))
        if self.recorded:
            return asked, exposed
        timing = AmpTiming(t_int=self.t_int, n_cm=self.n_cm, exposure=self.exposure)
        return replace(asked, frame=replace(asked.frame, timing=timing)), untrimmed(asked, exposed)

    @property
    def varies(self) -> str:
        """What differs from the first frame, in words."""
        if self.recorded:
            return "one tile in time of flight with phases, as simulated with delays"
        pairs = [(item.name, getattr(self, item.name)) for item in fields(self) if item.name != "name"]
        plain = vars(EnergyFrame(""))
        changed = [
            f"{name} {value:#x}" if name == "mask" else f"{name} {value}"
            for name, value in pairs
            if value != plain[name]
        ]
        return ", ".join(changed) or "edge mode, eight rows of 32 tiles, the scene of make sim"


def untrimmed(asked: FrameRequest, exposed: Exposed) -> Exposed:
    """The same values ahead of the converters with no trim, so that none is written over SPI: diodes b have it."""
    front_end, samples = exposed.front_end, exposed.samples.copy()
    if asked.frame.mode == "edge":  # of the other modes the sums and diodes are as they are
        samples[..., 1] *= trim_gain(front_end.trim)[asked.sensor.tile.type_map(*samples.shape[1:3])]
    return replace(exposed, samples=samples, front_end=replace(front_end, trim=(0,) * len(front_end.trim)))


FRAMES = (
    EnergyFrame("edge"),
    EnergyFrame("image", mode="image"),
    EnergyFrame("raw", mode="raw", last=(49, 47)),
    EnergyFrame("tof", mode="tof", last=(49, 39)),
    EnergyFrame("phase", mode="tof", phase=True, last=(49, 39)),
    EnergyFrame("threshold", threshold=64),
    EnergyFrame("all", threshold=0),
    EnergyFrame("mask", mask=HALF_THE_TYPES),
    EnergyFrame("resets", n_cm=8),
    EnergyFrame("exposure", exposure=8),
    EnergyFrame("idle", t_int=500, last=(49, 32)),
    EnergyFrame("lanes", last=(49, 34)),
)
# Predicted by the fit of the others: another scene, window, threshold, mask and integration
HELD_BACK = EnergyFrame("held_back", "coins", threshold=16, mask=0xFFF0FF, t_int=200, first=(60, 20), last=(61, 47))
RECORDED = EnergyFrame("recorded", recorded=True)
EVERY = (*FRAMES, HELD_BACK, RECORDED)


def frame_named(name: str) -> EnergyFrame:
    """The frame of that name. Raises ParameterError."""
    known = {frame.name: frame for frame in EVERY}
    if name not in known:
        raise ParameterError(f"frame = {name!r}: must be one of {', '.join(known)}")
    return known[name]
