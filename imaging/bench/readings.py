"""Voltmeter readings of the pixels' test chip as a CSV file: a line for each reading of a pixel's two pads.

Lines of kind ``sweep`` are read under reset, in the dark. Those of ``dark`` and ``light`` have a first reading after
the reset has ended, and a second one ``seconds`` later.
"""

import csv
import io
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import ParameterError
from talbot.models.parameters.sensor_file import nearest
from talbot.pixels.test_chip.places import COLS, ROWS

Floats = npt.NDArray[np.float64]
KINDS = "sweep", "dark", "light"
BYTES_MAX = 1 << 28


class Column(NamedTuple):
    """A column of numbers. low, high: range, both included. digits: in a written file, after the point or in all."""

    low: float
    high: float
    unit: str
    about: str
    digits: str = ".5f"
    whole: bool = False


COLUMNS = {
    "row": Column(0, ROWS - 1, "", "of the pixel, 0 in the north", ".0f", True),
    "col": Column(0, COLS - 1, "", "of the pixel, 0 in the west", ".0f", True),
    "outer_deg": Column(-60, 60, "degrees", "stage: about the fixed axis, along the columns", ".3f"),
    "inner_deg": Column(-60, 60, "degrees", "stage: about the axis that it carries, along the rows", ".3f"),
    "wavelength_nm": Column(350, 1000, "nm", "of the light", "g"),
    "celsius": Column(-60, 125, "degrees C", "temperature of the chip", "g"),
    "vdda_v": Column(0.5, 3.3, "V", "reset level, ua[0]", "g"),
    "seconds": Column(1e-6, 1e4, "s", "between both readings", ".6g"),
    "a0_v": Column(-0.1, 3.6, "V", "ua[2], first reading"),
    "b0_v": Column(-0.1, 3.6, "V", "ua[1], first reading"),
    "a1_v": Column(-0.1, 3.6, "V", "ua[2], second reading"),
    "b1_v": Column(-0.1, 3.6, "V", "ua[1], second reading"),
}
HEAD = "kind", *COLUMNS
ANGLES = "outer_deg", "inner_deg", "wavelength_nm"
SECOND = "seconds", "a1_v", "b1_v"
EMPTY = {"sweep": (*ANGLES, *SECOND), "dark": ANGLES, "light": ()}  # columns without a value, by kind


@dataclass(frozen=True, eq=False)
class Readings:
    """Lines of one or more files.

    kind: (n,) texts. values: (n,) by column, NaN where a kind has none. places: file and line of each.
    """

    kind: npt.NDArray[np.str_]
    values: dict[str, Floats]
    places: Sequence[str]

    def __len__(self) -> int:
        return len(self.kind)

    def of(self, *kinds: str) -> "Readings":
        """Return the readings of these kinds."""
        return self.where(np.isin(self.kind, kinds))

    def where(self, chosen: npt.NDArray[np.bool_]) -> "Readings":
        """Return the chosen readings."""
        values = {name: column[chosen] for name, column in self.values.items()}
        return Readings(self.kind[chosen], values, [self.places[i] for i in np.flatnonzero(chosen).tolist()])

    def __getitem__(self, name: str) -> Floats:
        return self.values[name]


def joined(parts: Iterable[Readings]) -> Readings:
    """Return all readings of several files."""
    parts = [*parts]
    values = {name: np.concatenate([part[name] for part in parts]) for name in COLUMNS}
    return Readings(np.concatenate([part.kind for part in parts]), values, sum((list(p.places) for p in parts), []))


def read(path: Path) -> Readings:
    """Read a file. Raises ParameterError with line, field, value and range."""
    if not path.is_file():
        raise ParameterError(f"bench = {str(path)!r}: must be simulated, or a CSV file of readings")
    if path.stat().st_size > BYTES_MAX:
        raise ParameterError(f"bench = {str(path)!r}: must have at most {BYTES_MAX} bytes")
    try:
        text = path.read_bytes().decode("utf-8-sig")
        lines = csv.reader(io.StringIO(text, newline=""), strict=True)
        head = [name.strip() for name in next(lines, [])]
        _check_head(head, path)
        kinds, rows, places = [], [], []
        for cells in lines:
            if any(cell.strip() for cell in cells):
                places.append(f"line {lines.line_num} of {path}")
                kind, row = _line(head, cells, places[-1])
                kinds.append(kind)
                rows.append(row)
    except (UnicodeDecodeError, csv.Error) as error:
        raise ParameterError(f"bench = {str(path)!r}: must be a CSV file ({error})") from None
    if not rows:
        raise ParameterError(f"bench = {str(path)!r}: must have lines of readings after its head")
    columns = np.array(rows, np.float64).T
    return Readings(np.array(kinds), dict(zip(COLUMNS, columns, strict=True)), places)


def text_of(readings: Readings) -> str:
    """Return readings as the text of a file."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(HEAD)
    texts = {name: [_text(value, column.digits) for value in readings[name]] for name, column in COLUMNS.items()}
    writer.writerows(zip(readings.kind, *texts.values(), strict=True))
    return out.getvalue()


def _text(value: float, digits: str) -> str:
    return "" if np.isnan(value) else f"{value:{digits}}"


def _check_head(head: Sequence[str], path: Path) -> None:
    place = f"line 1 of {path}"
    if len(head) == 1 and ";" in head[0]:
        raise ParameterError(f"columns = {head[0]!r} ({place}): must have commas between them, and points in numbers")
    for name in head:
        if name not in HEAD:
            raise ParameterError(f"column = {name!r} ({place}): must be a column of readings{nearest(name, HEAD)}")
        if head.count(name) > 1:
            raise ParameterError(f"column = {name!r} ({place}): must be there once, not {head.count(name)} times")
    for name in HEAD:
        if name not in head:
            raise ParameterError(f"column = {name!r} ({place}): must be there; all are {','.join(HEAD)}")


def _line(head: Sequence[str], cells: Sequence[str], place: str) -> tuple[str, list[float]]:
    if len(cells) != len(head):
        raise ParameterError(f"cells = {len(cells)} ({place}): must be {len(head)}, as the head has")
    texts = {name: cell.strip() for name, cell in zip(head, cells, strict=True)}
    kind = texts["kind"]
    if kind not in KINDS:
        raise ParameterError(f"kind = {kind!r} ({place}): must be one of {', '.join(KINDS)}")
    return kind, [_number(name, texts[name], kind, place) for name in COLUMNS]


def _number(name: str, text: str, kind: str, place: str) -> float:
    column = COLUMNS[name]
    if name in EMPTY[kind]:
        if text:
            raise ParameterError(f"{name} = {text!r} ({place}): must be empty in a line of kind {kind}")
        return np.nan
    try:
        value = float(text)
    except ValueError:
        value = np.nan
    if not column.low <= value <= column.high or column.whole and value != int(value):
        what = "an integer" if column.whole else "a number"
        unit = f" {column.unit}" if column.unit else ""
        raise ParameterError(
            f"{name} = {text!r} ({place}): must be {what} in [{column.low:g}, {column.high:g}]{unit} ({column.about})"
        )
    return value
