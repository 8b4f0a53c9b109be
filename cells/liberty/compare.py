"""Two Liberty descriptions of one cell, table by table."""

from dataclasses import dataclass

import numpy as np

from cells.characterize.table import bilinear

KINDS = {"cell_rise": "delay", "cell_fall": "delay", "rise_transition": "slew", "fall_transition": "slew",
         "rise_power": "energy", "fall_power": "energy"}
CONSTRAINTS = {"setup_rising": "setup", "setup_falling": "setup", "hold_rising": "hold", "hold_falling": "hold",
               "recovery_rising": "recovery", "recovery_falling": "recovery", "removal_rising": "removal",
               "removal_falling": "removal", "min_pulse_width": "width"}


@dataclass(frozen=True)
class Difference:
    """One table of ``cell``. kind: delay, slew, energy, capacitance, leakage, setup, hold, ...; what: where it stands.

    ours, theirs: arrays of one shape at their points (ns, pJ, pF, nW); missing: whether ours is not there.
    """

    cell: str
    kind: str
    what: str
    ours: np.ndarray
    theirs: np.ndarray

    @property
    def relative(self):
        """Error of every entry in shares of theirs, of energies in shares of the mean of |theirs| along the row."""
        scale = np.abs(self.theirs)
        if self.kind == "energy":
            scale = np.maximum(scale, scale.mean())
        return (self.ours - self.theirs) / scale


def library(tree, known):
    """Differences of every cell of ``tree`` (Group library) that ``known`` (short name -> Group) has: list."""
    found = []
    for cell in tree.all("cell"):
        name = cell.name.split("__")[-1]
        if name in known:
            found += differences(name, cell, known[name])
    return found


def differences(name, ours, theirs):
    """Differences of one cell: list; a table that ours lacks has NaN."""
    found = [Difference(name, "leakage", "mean", np.array([ours.attributes["cell_leakage_power"]]),
                        np.array([theirs.attributes["cell_leakage_power"]]))]
    for pin in theirs.all("pin"):
        own = ours.one("pin", pin.name)
        for attribute in ("rise_capacitance", "fall_capacitance"):
            if attribute in pin.attributes:
                found.append(Difference(name, "capacitance", f"{pin.name} {attribute}",
                                        np.array([own.attributes[attribute]]), np.array([pin.attributes[attribute]])))
        for kind in ("timing", "internal_power"):
            for group in pin.all(kind):
                found += _tables(name, pin, own, group)
    return found


def _tables(name, pin, own, group):
    keys = ("related_pin", "timing_type", "timing_sense")
    wanted = {k: group.attributes[k] for k in keys if k in group.attributes}
    same = own.all(group.kind, **wanted)
    for table in group.groups:
        kind = CONSTRAINTS.get(group.attributes.get("timing_type")) or KINDS.get(table.kind)
        if kind is None:
            continue
        values = table.array("values")
        mine = next((t for g in same for t in g.groups if t.kind == table.kind), None)
        cause = wanted.get("timing_type") if kind in CONSTRAINTS.values() else wanted.get("related_pin", "")
        what = f"{pin.name} {cause} {table.kind}"
        yield Difference(name, kind, what, np.full(values.shape, np.nan) if mine is None else _at(mine, table), values)


def _at(mine, theirs):
    """Table ``mine`` at the points of ``theirs``, bilinear."""
    rows = theirs.array("index_1")
    if "index_2" not in theirs.attributes:
        return np.interp(rows, mine.array("index_1"), np.ravel(mine.array("values")))
    columns = theirs.array("index_2")
    axes = mine.array("index_1"), mine.array("index_2"), mine.array("values")
    return np.array([[bilinear(*axes, row, column) for column in columns] for row in rows])


def summary(found):
    """{'error': kind -> median and 95th percentile of the absolute error, ...} over all entries.

    Relative errors in per cent; constraints (setup ...) in ps.
    """
    out = {}
    for kind in dict.fromkeys(d.kind for d in found):
        same = [d for d in found if d.kind == kind]
        if kind in CONSTRAINTS.values():
            errors, unit = np.concatenate([np.ravel(d.ours - d.theirs) * 1e3 for d in same]), "ps"
        else:
            errors, unit = np.concatenate([np.ravel(d.relative) * 100 for d in same]), "%"
        there = np.abs(errors[np.isfinite(errors)])
        out[kind] = {"unit": unit, "entries": int(errors.size), "missing": int(errors.size - there.size)}
        if there.size:
            out[kind] |= {"median": round(float(np.median(there)), 3),
                          "p95": round(float(np.percentile(there, 95)), 3), "worst": round(float(there.max()), 3)}
    return {"error": out}
