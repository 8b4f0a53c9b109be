"""The frames whose energy is measured: a few tiles of the default sensor, each varying one thing of the first."""

from dataclasses import dataclass, field, fields
from functools import partial

from talbot.flow.frame.job import expose, see
from talbot.flow.frame.request import FrameRequest, request
from talbot.flow.frame.result import Exposed
from talbot.flow.layout.chain import CHIP_FRAME
from talbot.flow.layout.steps.stimulus import SCENE, middle
from talbot.models.parameters import ALL_TYPES, ParameterError, Window

INTEGRATION = 64  # cycles; short, so that most of a frame's cycles convert
HALF_THE_TYPES = 0x555555


@dataclass(frozen=True)
class EnergyFrame:
    """One frame, its fields as those of a request of `make sim`; a wrong value is refused there.

    first, last: tile row, tile column of the window's corners, both included. recorded: the frame that `make layout`
    simulates with delays (`steps.stimulus`), in place of what the other fields say.
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
    first: tuple[int, int] = (48, 8)
    last: tuple[int, int] = (48, 39)
    recorded: bool = False

    def requested(self) -> FrameRequest:
        """The request. Raises ParameterError."""
        size = CHIP_FRAME["rows"], CHIP_FRAME["cols"]
        if self.recorded:
            cut = partial(middle, tiles=CHIP_FRAME["tiles"])
            return request(*size, scene=SCENE, mode="tof", phase=True, window=cut)
        (row0, col0), (row1, col1) = self.first, self.last
        return request(
            *size,
            scene=self.scene,
            mode=self.mode,
            threshold=self.threshold,
            phase=self.phase,
            mask=self.mask,
            exposure=self.exposure,
            timing={"n_cm": self.n_cm, "t_int": self.t_int},
            window=lambda full: Window(row0, row1, col0, col1),
        )

    def exposed(self) -> tuple[FrameRequest, Exposed]:
        """The request and what the pixels hold. Raises ParameterError."""
        asked = self.requested()
        return asked, expose(asked, *see(asked))

    @property
    def varies(self) -> str:
        """What differs from the first frame, in words."""
        if self.recorded:
            return "one tile in time of flight with phases, as simulated with delays"
        given = {item.name: getattr(self, item.name) for item in fields(self) if item.name != "name"}
        plain = {item.name: item.default for item in fields(self) if item.name != "name"}
        changed = [f"{name} {value:#x}" if name == "mask" else f"{name} {value}" for name, value in given.items()
                   if value != plain[name]]  # fmt: skip
        return ", ".join(changed) or "edge mode, four rows of 32 tiles, the scene of make sim"


FRAMES = (
    EnergyFrame("edge"),
    EnergyFrame("image", mode="image"),
    EnergyFrame("raw", mode="raw", last=(48, 23)),
    EnergyFrame("tof", mode="tof", last=(48, 15)),
    EnergyFrame("phase", mode="tof", phase=True, last=(48, 15)),
    EnergyFrame("threshold", threshold=64),
    EnergyFrame("all", threshold=0),
    EnergyFrame("mask", mask=HALF_THE_TYPES),
    EnergyFrame("resets", n_cm=8),
    EnergyFrame("exposure", exposure=8),
    EnergyFrame("idle", t_int=2000, last=(48, 8)),
    EnergyFrame("lanes", last=(48, 10)),
)
# Predicted by the fit of the others: another scene, window, threshold, mask and integration
HELD_BACK = EnergyFrame("held_back", "coins", threshold=16, mask=0xFFF0FF, t_int=200, first=(20, 20), last=(21, 43))
RECORDED = EnergyFrame("recorded", recorded=True)


def frame_named(name: str) -> EnergyFrame:
    """The frame of that name. Raises ParameterError."""
    known = {frame.name: frame for frame in (*FRAMES, HELD_BACK, RECORDED)}
    if name not in known:
        raise ParameterError(f"frame = {name!r}: must be one of {', '.join(known)}")
    return known[name]
