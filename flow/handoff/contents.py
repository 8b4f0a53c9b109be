"""Contents of the archive and the source of each part."""

import json
import re
from collections.abc import Mapping, Sequence
from importlib.metadata import version
from pathlib import Path

from talbot.flow.handoff.archive import sha256
from talbot.flow.handoff.pages import datasheet, pinout
from talbot.flow.handoff.power import powered
from talbot.flow.layout.block import SCRIPTS
from talbot.flow.layout.design import Design
from talbot.flow.layout.report.metrics import broken
from talbot.flow.openroad.tinytapeout import PROJECTS, project_files
from talbot.models.parameters import ParameterError
from talbot.platforms.layout import layout_platform
from talbot.signoff.netlist.netlist import SUPPLIES

WAIVERS = Path(__file__).parent / "waivers.json"
# suffix of build/layout/<design>/<design>.* -> folder in the archive
REQUIRED = {
    "gds": "layout",
    "lef": "layout",
    "v": "netlist",
    "sdc": "timing",
    "drc.lyrdb": "reports",
    "lvsdb": "reports",
}
OPTIONAL = {
    "lib": ("timing", "no model of the block: time it as its netlist, with the SPEF and the cells' Liberty"),
    "spef": ("timing", "no wires extracted: the timing, if there is one, is that of estimated wires"),
    "sdf": ("timing", "no delays: back-annotate from the Liberty and the SPEF"),
    "sta.txt": ("reports", "no static timing was run"),
}
OF_A_RUN = "wall_s", "peak_mib"  # figures that differ from run to run of the same layout
RUN = re.compile(rb"(?s)<!-- run -->.*?<!-- end of run -->")
SHOWN = re.compile(r'\bsrc="([^":/]+)"')  # files that the report's page shows


class Broken(RuntimeError):
    """The layout breaks rules that no waiver covers; one line each."""


def waived(design: Design, path: Path = WAIVERS) -> list[dict[str, str]]:
    """Waivers of a design, each with design, rule and reason. Raises ParameterError for one without a reason."""
    found = [waiver for waiver in json.loads(Path(path).read_text(encoding="utf-8")) if waiver["design"] == design.name]
    for waiver in found:
        if not waiver.get("reason"):
            raise ParameterError(f"waiver of {waiver['rule']} = no reason: must have one")
    return found


def contents(
    design: Design, folder: Path, waivers: Sequence[Mapping[str, str]]
) -> tuple[dict[str, bytes], dict[str, str]]:
    """Contents of the files by name, without the manifest, and the substitute of each optional file that is missing.

    Raises ParameterError that names every required file that is not there, Broken for rules not waived.
    """
    sources = {
        "reports/summary.json": folder / "summary.json",
        "reports/report.html": folder / "report.html",
        f"rtl/{design.top}.sv": folder / "rtl" / f"{design.top}.sv",
        **{f"{place}/{design.name}.{suffix}": folder / f"{design.name}.{suffix}" for suffix, place in REQUIRED.items()},
    }
    if (page := sources["reports/report.html"]).is_file():
        sources |= {f"reports/{name}": folder / name for name in SHOWN.findall(page.read_text(encoding="utf-8"))}
    if missing := sorted(str(path.relative_to(folder)) for path in sources.values() if not path.is_file()):
        must = f"must be a finished layout (make layout DESIGN={design.name}{' SENSOR=FILE' if design.label else ''})"
        raise ParameterError(f"{folder} = without {', '.join(missing)}: {must}")
    summary = json.loads(sources["reports/summary.json"].read_text(encoding="utf-8"))
    rules = {waiver["rule"] for waiver in waivers}
    if lines := [line for line in broken(summary) if line.partition(" = ")[0] not in rules]:
        raise Broken("\n".join(lines))
    files, substitutes = {name: plain(path.read_bytes(), folder) for name, path in sources.items()}, {}
    files["reports/summary.json"] = _json({name: value for name, value in summary.items() if name not in OF_A_RUN})
    corners = summary["wns_ns"] if isinstance(summary.get("wns_ns"), dict) else {}
    for suffix, (place, substitute) in OPTIONAL.items():
        paths = [folder / f"{design.name}.{part}" for part in (suffix, *(f"{corner}.{suffix}" for corner in corners))]
        files |= {f"{place}/{path.name}": plain(path.read_bytes(), folder) for path in paths if path.is_file()}
        if not any(path.is_file() for path in paths):
            substitutes[suffix] = substitute
    netlist = files[f"netlist/{design.name}.v"].decode()
    lef = files[f"layout/{design.name}.lef"].decode()
    frame = layout_platform(summary["pdk"]).frame(design.frame) if design.frame else None
    supplies: dict[str, str] = dict(zip(SUPPLIES, frame.supplies if frame else SUPPLIES, strict=True))
    files |= {
        f"netlist/{design.name}.power.v": powered(netlist, supplies).encode(),
        "pinout.md": pinout(lef).encode(),
        "datasheet.md": datasheet(design, summary, lef, waivers).encode(),
        "waivers.json": _json(waivers),
    }
    files |= {f"{SCRIPTS}/{path.name}": path.read_bytes() for path in sorted((folder / SCRIPTS).glob("*"))}
    if design.name in PROJECTS:
        files |= shuttle_files(design, files)
    return files, substitutes


def shuttle_files(design: Design, files: Mapping[str, bytes]) -> dict[str, bytes]:
    """Tiny Tapeout's project of a finished layout: its files, and the layout's by the name of the top."""
    verilog = files[f"rtl/{design.top}.sv"].decode()
    made = {name: text.encode() for name, text in project_files(design, verilog).items()}
    own = {"gds": "layout/{}.gds", "lef": "layout/{}.lef", "v": "netlist/{}.power.v"}
    for suffix, source in own.items():
        if (name := source.format(design.name)) in files:
            made[f"tinytapeout/{design.top}.{suffix}"] = files[name]
    return made


def plain(data: bytes, folder: Path) -> bytes:
    """``data`` without run times and without the path of the layouts."""
    return RUN.sub(b"", data).replace(f"{folder.resolve().parent}/".encode(), b"")


def manifest(design: Design, files: Mapping[str, bytes], substitutes: Mapping[str, str]) -> bytes:
    """The file manifest.json: size and SHA-256 of every file, versions of the tools, substitutes of missing files."""
    summary = json.loads(files["reports/summary.json"])
    return _json(
        {"design": design.name, "top": design.top}
        | {name: summary.get(name) for name in ("pdk", "backend")}
        | {"versions": {"talbot": version("talbot"), **summary.get("tools", {})}, "substitutes": substitutes}
        | {"files": {name: {"bytes": len(data), "sha256": sha256(data)} for name, data in sorted(files.items())}}
    )


def _json(value: object) -> bytes:
    return (json.dumps(value, indent=1) + "\n").encode()
