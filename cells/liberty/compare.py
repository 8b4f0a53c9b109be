"""Two Liberty descriptions of one cell, table by table; what only one of them has is told by name."""

import re
from dataclasses import dataclass

import numpy as np

from base.liberty.group import Group
from cells.characterize.table import bilinear

KINDS = {
    "cell_rise": "delay",
    "cell_fall": "delay",
    "rise_transition": "slew",
    "fall_transition": "slew",
    "rise_power": "energy",
    "fall_power": "energy",
}
CONSTRAINTS = {
    "setup_rising": "setup",
    "setup_falling": "setup",
    "hold_rising": "hold",
    "hold_falling": "hold",
    "recovery_rising": "recovery",
    "recovery_falling": "recovery",
    "removal_rising": "removal",
    "removal_falling": "removal",
    "min_pulse_width": "width",
}


# What makes two groups mean the same, the narrowest first: characterizers differ in whether a release is a 'preset' or
# belongs to 'clear', and in the sense of an edge that each has alone.
KEYS = (("related_pin", "timing_type", "timing_sense"), ("related_pin", "timing_type"), ("related_pin",))


@dataclass(frozen=True)
class Difference:
    """One table of ``cell``. kind: delay, slew, energy, capacitance, leakage, setup, hold, ...; what: where it stands.

    ours, theirs: arrays of one shape at their points (ns, pJ, pF, nW), NaN where one of the two has no such table.
    """

    cell: str
    kind: str
    what: str
    ours: np.ndarray
    theirs: np.ndarray

    @property
    def relative(self):
        """Error of every entry in shares of theirs, of energies in shares of the mean of |theirs| where that is more;

        0 where both are 0 (the slew of an output let go), NaN where theirs alone is.
        """
        scale, error = np.abs(self.theirs), self.ours - self.theirs
        if self.kind == "energy":
            scale = np.maximum(scale, scale.mean())
        return np.where(scale > 0, error / np.where(scale > 0, scale, 1.0), np.where(error == 0, 0.0, np.nan))


def library(tree, known):
    """Differences of every cell of ``tree`` (Group library) that ``known`` (short name -> Group) has: list."""
    found = []
    for cell in tree.all("cell"):
        name = cell.name.split("__")[-1]
        if name in known:
            found += differences(name, cell, known[name])
    return found


def differences(name, ours, theirs):
    """Differences of one cell: list. A table that one of the two lacks has NaN there."""
    found = [
        Difference(
            name,
            "leakage",
            "mean",
            np.array([ours.attributes.get("cell_leakage_power", np.nan)]),
            np.array([theirs.attributes.get("cell_leakage_power", np.nan)]),
        )
    ]
    found += [
        Difference(
            name,
            "leakage by state",
            state.attributes["when"],
            np.array([_leakage(ours, state)]),
            np.array([state.attributes["value"]]),
        )
        for state in theirs.all("leakage_power")
        if "when" in state.attributes
    ]
    for pin in theirs.all("pin"):
        own, used = ours.one("pin", pin.name) or Group("pin", (pin.name,)), set()
        for attribute in ("rise_capacitance", "fall_capacitance"):
            if attribute in pin.attributes:
                found.append(
                    Difference(
                        name,
                        "capacitance",
                        f"{pin.name} {attribute}",
                        np.array([own.attributes.get(attribute, np.nan)]),
                        np.array([pin.attributes[attribute]]),
                    )
                )
        for kind in ("timing", "internal_power"):
            for group in pin.all(kind):
                found += _tables(name, pin, own, group, used)
            found += [
                Difference(
                    name,
                    _kind(group, table),
                    _what(pin, group, table),
                    table.array("values"),
                    np.full(np.shape(table.array("values")), np.nan),
                )
                for group in own.all(kind)
                for table in group.groups
                if id(table) not in used
            ]
    return found


def _kind(group, table):
    return CONSTRAINTS.get(group.attributes.get("timing_type")) or KINDS.get(table.kind)


def _what(pin, group, table):
    """'Y A positive_unate cell_rise', 'D setup_rising rise_constraint': unique in a cell without conditions."""
    at = group.attributes
    words = (
        [at["timing_type"]]
        if _kind(group, table) in CONSTRAINTS.values()
        else [at.get("related_pin"), at.get("timing_type"), at.get("timing_sense"), at.get("when")]
    )
    return " ".join([pin.name, *(w for w in words if w and w != "combinational"), table.kind])


def _leakage(ours, state):
    """nW: mean over our states in which the condition of ``state`` holds, as far as both name the same pins."""
    wanted, values = _literals(state.attributes["when"]), []
    for own in ours.all("leakage_power"):
        literals = _literals(own.attributes["when"])
        if all(literals.get(pin, level) == level for pin, level in wanted.items()):
            values.append(own.attributes["value"])
    return np.mean(values) if values else np.nan


def _literals(product):
    """{pin: level} of a product like 'CLK&D&!Q'."""
    return {pin: not inverted for inverted, pin in re.findall(r"(!?)\s*(\w+)", product)}


def _tables(name, pin, own, group, used):
    for table in group.groups:
        kind = _kind(group, table)
        if kind is None:
            continue
        values = table.array("values")
        mine = _same(own, group, table.kind, kind)
        used.add(id(mine))
        yield Difference(
            name,
            kind,
            _what(pin, group, table),
            np.full(values.shape, np.nan) if mine is None else _at(mine, table),
            values,
        )


def _same(own, group, table, kind):
    """Our table that means what ``table`` (its kind) of ``group`` does, or None."""
    for keys in KEYS[:2] if kind in CONSTRAINTS.values() else KEYS:
        wanted = {k: group.attributes[k] for k in keys if k in group.attributes}
        for mine in own.all(group.kind, **wanted):
            if mine.one(table) and _kind(mine, mine.one(table)) == kind:
                return mine.one(table)
    return None


def _at(mine, theirs):
    """Table ``mine`` at the points of ``theirs``, bilinear; at its own first point where theirs is one number."""
    if "index_1" not in theirs.attributes:
        return np.full(theirs.array("values").shape, mine.array("values").flat[0])
    rows = theirs.array("index_1")
    if "index_2" not in theirs.attributes:
        return np.interp(rows, mine.array("index_1"), np.ravel(mine.array("values")))
    columns = theirs.array("index_2")
    axes = mine.array("index_1"), mine.array("index_2"), mine.array("values")
    return np.array([[bilinear(*axes, row, column) for column in columns] for row in rows])


def summary(found):
    """{'error': kind -> median and 95th percentile of the absolute error, ...} over all entries; 'only_theirs' and

    'only_ours': the tables that the other does not have, by name. Relative errors in per cent; constraints in ps.
    """
    out = {}
    both = [d for d in found if not np.isnan(d.theirs).all()]
    for kind in dict.fromkeys(d.kind for d in both):
        same = [d for d in both if d.kind == kind]
        if kind in CONSTRAINTS.values():
            errors, unit = np.concatenate([np.ravel(d.ours - d.theirs) * 1e3 for d in same]), "ps"
        else:
            errors, unit = np.concatenate([np.ravel(d.relative) * 100 for d in same]), "%"
        there = np.abs(errors[np.isfinite(errors)])
        out[kind] = {"unit": unit, "entries": int(errors.size), "missing": int(errors.size - there.size)}
        if there.size:
            out[kind] |= {
                "median": round(float(np.median(there)), 3),
                "p95": round(float(np.percentile(there, 95)), 3),
                "worst": round(float(there.max()), 3),
            }
    return {
        "error": out,
        "only_theirs": [f"{d.cell}: {d.what}" for d in both if np.isnan(d.ours).all()],
        "only_ours": [f"{d.cell}: {d.what}" for d in found if np.isnan(d.theirs).all()],
    }
