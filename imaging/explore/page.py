"""The page of a search: one file, by Plotly's JavaScript in it; it needs no server."""

import base64
import io
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from markupsafe import Markup
from PIL import Image
from plotly.offline import get_plotlyjs

from talbot.base.charts import curves, svg
from talbot.base.page import Section, Tile, render
from talbot.imaging.explore.results import command_of, name_of, sensor_of_row, short
from talbot.imaging.explore.search import Findings, Row
from talbot.imaging.explore.task import MORE
from talbot.imaging.explore.tasks import figures_of
from talbot.models.parameters import sensor_text

NAMES = ("explore.html", "summary.json", "trials.csv")
MARK = "<script>PLOTLY</script>"
AXIS_PX = 95  # of parallel coordinates


def write(folder: Path, findings: Findings, summary: Mapping[str, Any]) -> None:
    """Write explore.html into ``folder``."""
    front = findings.front or [row for row in findings.rows if row.full]
    first = min(front, key=lambda row: (row.full or {})["figures"]["error"], default=None)
    text = render(
        Path(__file__).with_name("page.html"),
        f"{summary['task']}: sensors for a task",
        picture=_image(first) if first else None,
        about=f"{summary['about']}; {summary['trials']} points, seed {summary['seed']}, {summary['sampler']}",
        tiles=_tiles(findings, summary),
        sections=_sections(findings, summary),
        parallel_width=AXIS_PX * (len(findings.plan.space) + len(figures_of(findings.plan.task))),
        data=_data(findings, summary, first),
    )
    before, after = text.split(MARK)
    (folder / "explore.html").write_text(f"{before}<script>{get_plotlyjs()}</script>{after}", encoding="utf-8")


def _image(row: Row) -> Image.Image:
    return Image.open(io.BytesIO(base64.b64decode((row.full or {})["picture"])))


def _data(findings: Findings, summary: Mapping[str, Any], first: Row | None) -> Markup:
    """What the script shows, as JSON that may stand in HTML. first: the point that is chosen at the start."""
    points = []
    for row in [*findings.thesis_in_full, *(row for row in findings.rows if row.full)]:
        record, values = row.full or {}, findings.effective(row)
        shown = row.front or row.number < 0
        points.append(
            {
                "point": name_of(row),
                "front": row.front,
                "values": {name: values.get(name) for name in findings.plan.space},
                "figures": record["figures"],
                "picture": record["picture"],
                "command": command_of(findings, row, summary["folder"]),
                "toml": sensor_text(sensor_of_row(findings, row)) if shown else "",
            }
        )
    objectives = list(findings.plan.objectives)
    names = [*objectives, *(name for name in figures_of(findings.plan.task) if name not in objectives)]
    data = {"points": points, "figures": names, "keys": list(findings.plan.space), "more": list(MORE)}
    data["first"] = name_of(first) if first else ""
    data["start"] = [*objectives[1:2], *objectives[:1]] if len(objectives) > 1 else [names[1], names[0]]
    return Markup(json.dumps(data, allow_nan=False).replace("<", "\\u003c"))


def _tiles(findings: Findings, s: Mapping[str, Any]) -> list[Tile]:
    counts, refused = s["counts"], sum(s["refused_before"].values())
    tiles = [Tile(str(len(s["front"])), f"sensors on the front, of {counts['full']} in full", "good")]
    if s["front"]:
        best = min(entry["figures"]["error"] for entry in s["front"])
        free = "" if s["free_error"] is None else f" (nothing: {s['free_error']:.3g})"
        tiles.append(Tile(f"{best:.3g}", f"least error{free}"))
    if s["thesis"]:
        tiles.append(Tile(f"{s['thesis']['figures']['error']:.3g}", "error of the thesis's sensor"))
    tiles.append(Tile(str(refused), "refused before any simulation"))
    if robust := s.get("robustness"):
        share = "-" if robust["yield"] is None else f"{100 * robust['yield']:.0f} %"
        tiles.append(Tile(share, f"yield of {robust['chips']} chips of point {robust['point']:04}"))
    if counts["failed"]:
        tiles.append(Tile(str(counts["failed"]), "trials failed", "bad"))
    return tiles


def _sections(findings: Findings, s: Mapping[str, Any]) -> list[Section]:
    names = figures_of(findings.plan.task)
    front = [*([s["thesis"]] if s["thesis"] else []), *s["front"]]
    keys = list(findings.plan.space)
    rows = [
        (entry["point"], *(short(entry["figures"][n]) for n in names), *(short(entry["values"].get(k)) for k in keys))
        for entry in front
    ]
    out = [Section("The front", head=("point", *names, *keys), rows=rows, kind="pinned")]
    worth = s["importances"]
    if any(worth.values()):
        out.append(
            Section(
                "What each key is worth",
                "Share of each figure's variation that the key explains, by PED-ANOVA of all points at the same "
                "fidelity; 1 together.",
                head=("key", *worth),
                rows=[(key, *(f"{worth[name].get(key, 0):.2f}" for name in worth)) for key in keys],
            )
        )
    out.append(Section("The search", _about(s), charts=_convergence(s)))
    if robust := s.get("robustness"):
        cells = [
            (c["case"], *(short(c["figures"][n]) if c["figures"] else "-" for n in names), c["why"] or "good")
            for c in robust["cases"]
        ]
        nominal = ("nominal", *(short(robust["nominal"][n]) for n in names), "")
        about = f"Point {robust['point']:04}, in full; a chip is good with {', '.join(robust['limits'])}."
        out.append(Section("Robustness", about, head=("case", *names, ""), rows=[nominal, *cells]))
    p = s["provenance"]
    made = [("Talbot", f"{p['talbot']} {p['commit']}"), ("search", p["search"]), ("task and scenes", p["task"])]
    made += [("Python", p["python"]), *p["packages"].items()]
    out.append(Section("Made by", head=("what", "version or digest"), rows=made, numbers=False))
    return out


def _about(s: Mapping[str, Any]) -> str:
    counts = s["counts"]
    reasons = ", ".join(f"{reason}: {count}" for reason, count in sorted(s["refused_before"].items()))
    parts = [f"{counts['full']} points in full, {counts['small']} in the small scene alone, {counts['failed']} failed"]
    parts.append(f"refused before any simulation: {reasons}" if reasons else "none refused before a simulation")
    if s["budget"]:
        parts.append(f"budget {', '.join(s['budget'])}")
    return "; ".join(parts) + "."


def _convergence(s: Mapping[str, Any]) -> list[Markup]:
    places = [(c["cpu_s"], c["share"], str(c["trials"])) for c in s["convergence"]]
    if len(places) < 2:
        return []
    labels = "processor seconds of evaluations; number: trials", "part of the objectives' box that is dominated"
    return [svg(curves({s["sampler"]: places}, *labels, "Convergence"))]
