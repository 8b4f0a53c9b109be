"""The CSV file of readings: there and back, and what is refused."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from talbot.base.paths import ROOT
from talbot.imaging.bench.readings import COLUMNS, EMPTY, HEAD, KINDS, Readings, read, text_of
from talbot.models.parameters import ParameterError

DARK = "dark,0,1,,,,25,2,3,1.9,1.9,1.8,1.8"
LIGHT = "light,0,1,5,-5,575,25,2,0.01,1.9,1.9,1.8,1.8"
SWEEP = "sweep,0,1,,,,25,1.5,,1.7,1.7,,"


def written(tmp_path, text, head):
    path = tmp_path / "m.csv"
    path.write_text(f"{head}\n{text}\n")
    return path


def test_the_protocol_has_every_column():
    lines = (ROOT / "pixels" / "test_chip" / "bench.md").read_text().splitlines()
    for name, column in COLUMNS.items():
        (row,) = (line for line in lines if line.startswith("| `") and f"`{name}`" in line.split("|")[1])
        assert f"{column.low:g} to {column.high:g}" in row, name


def line():
    """Values of a line of some kind, within the columns' ranges."""

    def values(kind):
        inside = {
            name: st.integers(int(c.low), int(c.high)) if c.whole else st.floats(c.low, c.high)
            for name, c in COLUMNS.items()
        }
        cells = {name: st.just(np.nan) if name in EMPTY[kind] else values for name, values in inside.items()}
        return st.tuples(st.just(kind), st.fixed_dictionaries(cells))

    return st.sampled_from(KINDS).flatmap(values)


@given(st.lists(line(), min_size=1, max_size=5))
def test_what_is_written_is_read(tmp_path_factory, lines):
    kinds = np.array([kind for kind, _ in lines])
    values = {name: np.array([float(row[name]) for _, row in lines]) for name in COLUMNS}
    path = tmp_path_factory.mktemp("readings") / "m.csv"
    path.write_text(text_of(Readings(kinds, values, [""] * len(lines))))
    again = read(path)
    assert list(again.kind) == list(kinds) and again.places[0] == f"line 2 of {path}"
    for name in COLUMNS:
        np.testing.assert_allclose(again[name], values[name], rtol=1e-5, atol=6e-4)


def test_other_orders_of_columns_spaces_and_a_mark_of_windows(tmp_path):
    path = tmp_path / "m.csv"
    head, cells = [*HEAD][::-1], LIGHT.split(",")[::-1]
    path.write_bytes(("\ufeff" + ", ".join(head) + "\r\n" + ", ".join(cells) + "\r\n\r\n").encode())
    assert read(path)["outer_deg"] == [5] and len(read(path)) == 1


@pytest.mark.parametrize(
    "text, head, said",
    [
        (LIGHT, ",".join(HEAD).replace("outer_deg", "outer"), r"column = 'outer' \(line 1 .*; did you mean outer_deg"),
        (LIGHT, ",".join(HEAD[:-1]), r"column = 'b1_v' \(line 1 .*: must be there; all are kind,row"),
        (LIGHT, ",".join((*HEAD, "row")), "column = 'row' .*: must be there once, not 2 times"),
        (LIGHT, ";".join(HEAD), "must have commas between them, and points in numbers"),
        (LIGHT.replace("-5", "-95"), None, r"inner_deg = '-95' \(line 2 of .*\): must be a number in \[-60, 60\] deg"),
        (LIGHT.replace("light,0", "light,5"), None, r"row = '5' \(line 2 .*: must be an integer in \[0, 4\]"),
        (LIGHT.replace("light,0", "light,0.5"), None, "row = '0.5' .*: must be an integer"),
        (LIGHT.replace("0.01", "nan"), None, r"seconds = 'nan' .*: must be a number in \[1e-06, 10000\] s"),
        (LIGHT.replace("0.01", ""), None, "seconds = '' .*: must be a number"),
        (LIGHT.replace("light", "Light"), None, "kind = 'Light' .*: must be one of sweep, dark, light"),
        (f"{DARK}\n{LIGHT},7", None, r"cells = 14 \(line 3 .*: must be 13, as the head has"),
        (SWEEP.replace("1.7,,", "1.7,1.6,"), None, "a1_v = '1.6' .*: must be empty in a line of kind sweep"),
        ("", None, "must have lines of readings after its head"),
        ('"', None, "must be a CSV file"),
    ],
)
def test_refused(tmp_path, text, head, said):
    path = written(tmp_path, text, head or ",".join(HEAD))
    with pytest.raises(ParameterError, match=said):
        read(path)
