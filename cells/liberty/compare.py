"""Two Liberty descriptions of one cell, table by table; what only one of them has is reported by name."""

import re
from collections.abc import Container, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from talbot.base.liberty.group import Group
from talbot.cells.characterize.table import bilinear

KINDS = {f"cell_{edge}": "delay" for edge in ("rise", "fall")}
KINDS |= {f"{edge}_transition": "slew" for edge in ("rise", "fall")}
KINDS |= {f"{edge}_power": "energy" for edge in ("rise", "fall")}
TIMES = ("setup", "hold", "recovery", "removal")
CONSTRAINTS = {f"{kind}_{edge}": kind for kind in TIMES for edge in ("rising", "falling")}
CONSTRAINTS["min_pulse_width"] = "width"
Floats = npt.NDArray[np.float64]

# Attributes by which two groups are the same, the narrowest first: characterizers differ in whether a release is a
# 'preset' or belongs to 'clear', and in the sense of an edge that only one of them has.
KEYS = (("related_pin", "timing_type", "timing_sense"), ("related_pin", "timing_type"), ("related_pin",))


@dataclass(frozen=True)
class Difference:
    """A table of ``cell`` in both libraries, at the reference's points.

    kind: delay, slew, energy, capacitance, leakage, setup, hold, ...
    what: pin, related pin and table.
    ours, theirs: values in ns, pJ, pF or nW; NaN where a library has no such table.
    """

    cell: str
    kind: str
    what: str
    ours: Floats
    theirs: Floats

    @property
    def relative(self) -> Floats:
        """Relative error of every entry, of energies relative to the mean of |theirs| where that is more.

        0 where both are 0 (the slew of an output let go), NaN where only theirs is.
        """
        scale, error = np.abs(self.theirs), self.ours - self.theirs
        if self.kind == "energy":
            scale = np.maximum(scale, scale.mean())
        return np.where(scale > 0, error / np.where(scale > 0, scale, 1.0), np.where(error == 0, 0.0, np.nan))


def library(tree: Group, known: Mapping[str, Group]) -> list[Difference]:
    """Differences of every cell of the library ``tree`` that is in ``known``, by short name."""
    differences_of_cells = []
    for cell in tree.all("cell"):
        name = cell.name.split("__")[-1]
        if name in known:
            differences_of_cells += differences(name, cell, known[name])
    return differences_of_cells


def differences(name: str, ours: Group, theirs: Group) -> list[Difference]:
    """Differences of one cell."""

    def number(kind: str, what: str, ours: float, theirs: float) -> Difference:
        return Difference(name, kind, what, np.array([ours]), np.array([theirs]))

    rows = [number("leakage", "mean", *(cell.number("cell_leakage_power") for cell in (ours, theirs)))]
    for state in (state for state in theirs.all("leakage_power") if "when" in state.attributes):
        rows.append(number("leakage by state", state.text("when"), _leakage(ours, state), state.number("value")))
    for pin in theirs.all("pin"):
        our_pin, used = ours.one("pin", pin.name) or Group("pin", (pin.name,)), set()
        for key in ("rise_capacitance", "fall_capacitance"):
            if key in pin.attributes:
                rows.append(number("capacitance", f"{pin.name} {key}", our_pin.number(key), pin.number(key)))
        for kind in ("timing", "internal_power"):
            for group in pin.all(kind):
                rows += _tables(name, pin, our_pin, group, used)
            for group in our_pin.all(kind):
                for table in group.groups:
                    if id(table) not in used:
                        values, table_kind = table.array("values"), _kind(group, table) or table.kind
                        alone = np.full(values.shape, np.nan)
                        rows.append(Difference(name, table_kind, _what(pin, group, table), values, alone))
    return rows


def _kind(group: Group, table: Group) -> str | None:
    return CONSTRAINTS.get(group.text("timing_type")) or KINDS.get(table.kind)


def _what(pin: Group, group: Group, table: Group) -> str:
    """'Y A positive_unate cell_rise', 'D setup_rising rise_constraint': unique in a cell without conditions."""
    constraint = _kind(group, table) in CONSTRAINTS.values()
    names = ["timing_type"] if constraint else ["related_pin", "timing_type", "timing_sense", "when"]
    words = [group.text(name) for name in names]
    return " ".join([pin.name, *(w for w in words if w and w != "combinational"), table.kind])


def _leakage(ours: Group, state: Group) -> float:
    """The mean (nW) over our states in which the condition of ``state`` holds, for the pins that both name."""
    required, values = _literals(state.text("when")), []
    for our_power in ours.all("leakage_power"):
        literals = _literals(our_power.text("when"))
        if all(literals.get(pin, level) == level for pin, level in required.items()):
            values.append(our_power.number("value"))
    return float(np.mean(values)) if values else np.nan


def _literals(product: str) -> dict[str, bool]:
    """The pins of a product like 'CLK&D&!Q', and whether each must be high."""
    return {pin: not inverted for inverted, pin in re.findall(r"(!?)\s*(\w+)", product)}


def _tables(name: str, pin: Group, our_pin: Group, group: Group, used: set[int]) -> Iterator[Difference]:
    for table in group.groups:
        kind = _kind(group, table)
        if kind is None:
            continue
        values, mine = table.array("values"), _same(our_pin, group, table.kind, kind)
        used.add(id(mine))
        ours = np.full(values.shape, np.nan) if mine is None else _at(mine, table)
        yield Difference(name, kind, _what(pin, group, table), ours, values)


def _same(our_pin: Group, group: Group, table: str, kind: str) -> Group | None:
    """Our table that corresponds to ``table`` (its kind) of ``group``, or None."""
    for keys in KEYS[:2] if kind in CONSTRAINTS.values() else KEYS:
        attributes = {k: group.attributes[k] for k in keys if k in group.attributes}
        for mine in our_pin.all(group.kind, **attributes):
            our_table = mine.one(table)
            if our_table and _kind(mine, our_table) == kind:
                return our_table
    return None


def _at(mine: Group, theirs: Group) -> Floats:
    """Table ``mine`` at the points of ``theirs``, bilinear; its first value where theirs is one number."""
    if "index_1" not in theirs.attributes:
        return np.full(theirs.array("values").shape, mine.array("values").flat[0])
    rows = theirs.array("index_1")
    if "index_2" not in theirs.attributes:
        return np.interp(rows, mine.array("index_1"), np.ravel(mine.array("values")))
    columns = theirs.array("index_2")
    axes = mine.array("index_1"), mine.array("index_2"), mine.array("values")
    return np.array([[bilinear(*axes, row, column) for column in columns] for row in rows])


def summary(differences: Sequence[Difference], fitted: Container[str] = ()) -> dict[str, Any]:
    """The errors of cells that are not among ``fitted`` ('error') and of those ('error_of_fit'): summary.json has them.

    By kind: see `errors`. 'only_theirs', 'only_ours': names of tables that one alone has.
    """
    return {
        "error": errors([d for d in differences if d.cell not in fitted]),
        "error_of_fit": errors([d for d in differences if d.cell in fitted]),
        "only_theirs": [f"{d.cell}: {d.what}" for d in differences if np.isnan(d.ours).all()],
        "only_ours": [f"{d.cell}: {d.what}" for d in differences if np.isnan(d.theirs).all()],
    }


def errors(differences: Sequence[Difference]) -> dict[str, dict[str, Any]]:
    """Absolute errors over all entries, by kind.

    Of each its unit ('%', of constraints 'ps'), number of entries, of missing ones, median, 95th percentile (p95) and
    worst; of constraints 'optimistic', the most by which ours is shorter.
    """
    out: dict[str, dict[str, Any]] = {}
    both = [d for d in differences if not np.isnan(d.theirs).all()]
    for kind in dict.fromkeys(d.kind for d in both):
        same = [d for d in both if d.kind == kind]
        if kind in CONSTRAINTS.values():
            signed, unit = np.concatenate([np.ravel(d.ours - d.theirs) * 1e3 for d in same]), "ps"
        else:
            signed, unit = np.concatenate([np.ravel(d.relative) * 100 for d in same]), "%"
        finite = np.abs(signed[np.isfinite(signed)])
        out[kind] = {"unit": unit, "entries": int(signed.size), "missing": int(signed.size - finite.size)}
        if finite.size:
            found_errors = {"median": np.median(finite), "p95": np.percentile(finite, 95), "worst": finite.max()}
            if unit == "ps":
                found_errors["optimistic"] = max(0.0, -np.nanmin(signed))
            out[kind] |= {name: round(float(error), 3) for name, error in found_errors.items()}
    return out
