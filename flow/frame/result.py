"""What one run of the main job holds: its exposure, the chip's frame and the golden one."""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
import numpy.typing as npt

from models.afe import FrontEnd
from models.capture import Views
from models.chip import GoldenFrame
from models.digital.stream.frame import DecodedFrame
from models.plan import Plan
from models.reconstruct import rebuild
from models.reconstruct.rebuild import Rebuilt
from models.scene import Scene

from .hardware import HardwareFrame
from .request import FrameRequest


@dataclass(frozen=True, eq=False)
class Exposed:
    """One exposure of a scene.

    views: how many views of which pixels.
    samples: (taps, rows, cols, 2), what the front end samples. ideal: (rows, cols, subs), the values ahead of the
    converters, in LSB, of the same exposure without noise.
    """

    scene: Scene
    plan: Plan
    views: Views
    front_end: FrontEnd
    samples: npt.NDArray[np.float64]
    ideal: npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class FrameResult:
    """Everything of one run, for the figures, the pictures and the report."""

    request: FrameRequest
    exposed: Exposed
    program: Path
    golden: GoldenFrame
    chip: HardwareFrame
    decoded: DecodedFrame

    @cached_property
    def rebuilt(self) -> Rebuilt:
        """The 2-D image rebuilt from the decoded edges alone."""
        asked, exposed, edges = self.request, self.exposed, self.decoded.samples[..., 0]
        trim, timing = exposed.front_end.trim, asked.frame.timing
        return rebuild(edges, self.decoded.read, exposed.scene, asked.sensor, trim, timing)
