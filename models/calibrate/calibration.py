"""A calibration, the sensor that it describes, and its JSON file."""

import json
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Self

import numpy as np

from talbot.models.parameters import ParameterError, PixelType, SensorParameters, check_real
from talbot.models.pixel.table import TableResponse

VIGNETTING = 4.0  # power of the natural law; the aperture's sigma holds what else there is
LABELS = "beta", "gamma_deg", "alpha", "m"
TABLE = "along", "across", "values", "gamma", "source"
PUPIL_MAX = 1000.0  # m, of CameraParameters


@dataclass(frozen=True)
class Calibration:
    """Pixel types and lens as measured.

    types: beta, gamma, alpha, m of every type, in the tile's order; with a table of what was measured where Eq. 3.1 is
        not its response.
    gains: capacitor ratio of every type, 0..64.
    sigma: of the aperture in rad, 0.01..10, in addition to cos**4 of the lens.
    pupil_power: inverse distance of the exit pupil from the sensor in 1/m, 0..1e4; 0 is telecentric.
    centre: optical centre (y, x) in px from the array's middle; None where the lens is telecentric.
    """

    types: tuple[PixelType, ...]
    gains: tuple[float, ...]
    sigma: float
    pupil_power: float
    centre: tuple[float, float] | None

    def __post_init__(self) -> None:
        if len(self.types) != len(self.gains):
            raise ParameterError(f"gains = {len(self.gains)}: must be as many as types, {len(self.types)}")
        for gain in self.gains:
            check_real("gains", gain, 0, 64)
        check_real("sigma", self.sigma, 0.01, 10)
        check_real("pupil_power", self.pupil_power, 0, 1e4)

    def applied(self, sensor: SensorParameters) -> SensorParameters:
        """Return the sensor with the measured pixel types, aperture, vignetting and exit pupil.

        sensor: has the tile's order, the rest of the lens and the chip; the optical centre stays the array's middle.
        Raises ParameterError for another number of types.
        """
        tile, optics = sensor.tile, sensor.optics
        if len(self.types) != tile.n_types:
            raise ParameterError(f"calibration = {len(self.types)} pixel types: must be {tile.n_types}, as the sensor")
        camera, pupil = optics.camera, None
        if self.pupil_power > 1 / PUPIL_MAX:
            pupil = max(1 / self.pupil_power, 4 * camera.focal_length**2 / camera.focus)
        optics = replace(
            optics, camera=replace(camera, exit_pupil=pupil), aperture_sigma=self.sigma, vignetting_power=VIGNETTING
        )
        return replace(sensor, tile=replace(tile, types=self.types), optics=optics)

    @property
    def table(self) -> dict[str, Any]:
        """Plain values, for a JSON file."""
        kinds = [{name: getattr(kind, name) for name in LABELS} | _table(kind) for kind in self.types]
        return {
            "types": kinds,
            "gains": [*self.gains],
            "sigma": self.sigma,
            "pupil_power": self.pupil_power,
            "centre": self.centre and [*self.centre],
        }

    @classmethod
    def of(cls, table: dict[str, Any]) -> Self:
        """Calibration of `table`.

        table: its keys; others are left alone. Returns the same. Raises ParameterError for a key that is missing, or a
        value out of range.
        """
        try:
            types = tuple(_type(kind) for kind in table["types"])
            centre = table["centre"]
            middle = None if centre is None else (float(centre[0]), float(centre[1]))
            gains = tuple(float(gain) for gain in np.atleast_1d(table["gains"]))
            return cls(types, gains, table["sigma"], table["pupil_power"], middle)
        except (KeyError, TypeError, IndexError) as error:
            raise ParameterError(f"calibration = a table: must have types, gains, sigma, ...: {error}") from None


def _table(kind: PixelType) -> dict[str, Any]:
    """Return a type's own response, for a JSON file; {} where it has none."""
    table = kind.response
    if not isinstance(table, TableResponse):
        return {}
    plain = {name: getattr(table, name) for name in TABLE}
    digits = {"along": 6, "across": 6, "values": 4}
    return {"response": {k: v.round(digits[k]).tolist() if k in digits else v for k, v in plain.items()}}


def _type(kind: dict[str, Any]) -> PixelType:
    plain = {name: value for name, value in kind.items() if name != "response"}
    stored = kind.get("response")
    if stored is None:
        return PixelType(**plain)
    along, across, values = (np.array(stored[name], np.float64) for name in TABLE[:3])
    response = TableResponse(along, across, values, float(stored["gamma"]), str(stored["source"]))
    return PixelType(**plain, response=response)


def read_calibration(path: str | Path) -> Calibration:
    """Read the calibration.json that `make calibrate` writes.

    path: the file. Returns Calibration: as measured. Raises ParameterError for a file that is missing, no JSON, or out
    of range.
    """
    try:
        if Path(path).exists() and not Path(path).is_file():
            raise ValueError("no file")
        table = json.loads(Path(path).read_text(encoding="utf-8-sig"))
        if not isinstance(table, dict):
            raise ParameterError("calibration = a list: must be a table")
        return Calibration.of(table)
    except (OSError, ValueError, RecursionError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        said = f"calibration = {str(path)!r}: must be a calibration.json of talbot calibrate ({reason})"
        raise ParameterError(said) from None
