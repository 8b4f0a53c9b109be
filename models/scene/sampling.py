"""Sampling of a scene: array size, views and focal plane."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from models.parameters import check_choice, check_int, check_real

DTYPES = ("float32", "float64")


@dataclass(frozen=True)
class Sampling:
    """One array size, one angular sampling, one focal plane.

    Attributes
    ----------
    rows, cols : int
        1..1536 pixels.
    views : int
        Views along each axis, 1..31.
    focus : float or None
        Disparity of the focal plane against the reference plane (models/scene/camera.py), -100..100 px per view
        step, towards the camera; None is the scene's own.
    dtype : str
        'float32' or 'float64', the type of the light field.
    """

    rows: int = 384
    cols: int = 384
    views: int = 5
    focus: float | None = None
    dtype: str = "float64"

    def __post_init__(self) -> None:
        check_int("rows", self.rows, 1, 1536)
        check_int("cols", self.cols, 1, 1536)
        check_int("views", self.views, 1, 31)
        check_choice("dtype", self.dtype, DTYPES)
        if self.focus is not None:
            check_real("focus", self.focus, -100, 100)

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return self.rows, self.cols

    @property
    def steps(self) -> npt.NDArray[np.float64]:
        """Offset of every view from the centre, in view steps: (views,)."""
        return np.arange(self.views, dtype=np.float64) - (self.views - 1) / 2

    def focus_or(self, default: float) -> float:
        """Focal plane, or a default where none is set.

        Parameters
        ----------
        default : float
            In px per view step of a 5 x 5 light field.

        Returns
        -------
        float
            In px per view step.
        """
        return default * 5 / self.views if self.focus is None else float(self.focus)
