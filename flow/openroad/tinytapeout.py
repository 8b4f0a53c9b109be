"""Tiny Tapeout: a block behind a byte bus in a few tiles, as a project that its tools take: info.yaml, src/, docs/."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import takewhile
from pathlib import Path

from flow.layout.design import Design
from models.parameters import ParameterError, check_choice
from platforms.sky130.tinytapeout import CONFIG, SIZES_UM

TOPS = Path(__file__).parent / "tops"
BUS = "tt_bytes.v"


@dataclass(frozen=True)
class Project:
    """A project of the shuttle.

    top: its module, file <top>.v in tops/. tiles: of SIZES_UM. ui, uo, uio: pins 0..7, '' for unused.
    """

    top: str
    title: str
    description: str
    tiles: str
    ui: tuple[str, ...]
    uo: tuple[str, ...]
    uio: tuple[str, ...]
    test: str

    def __post_init__(self) -> None:
        check_choice("tiles", self.tiles, tuple(SIZES_UM))
        if not self.top.startswith("tt_um_"):
            raise ParameterError(f"top = {self.top!r}: must begin with tt_um_")
        for name in ("ui", "uo", "uio"):
            if len(getattr(self, name)) != 8:
                raise ParameterError(f"{name} = {len(getattr(self, name))} pins: must be 8")


_DATA = tuple(f"data {k}" for k in range(8))
PROJECTS = {
    "quad_divider": Project(
        "tt_um_talbot_divider",
        "Quadrature divider",
        "Octant, ratio, amplitude and 8-bit phase of a signed 9-bit vector, by a radix-4 division",
        "1x1",
        _DATA,
        tuple(f"result {k}" for k in range(8)),
        ("strobe", "is address", "", "", "", "", "busy", "valid"),
        "Write the address 0, then the bytes of x, y and their signs, then any byte to start. When valid is high, "
        "address 0 shows the phase: x = 100, y = 100 gives 32, an eighth of a turn.",
    ),
    "amp_ctrl": Project(
        "tt_um_talbot_amp_ctrl",
        "Amplifier control of an angle-sensitive pixel",
        "Phases of a differential pixel amplifier with common-mode reset and correlated double sampling",
        "1x2",
        _DATA,
        ("pixel_reset", "shutter", "ref_ctl", "integrate", "cm_reset", "read", "sample", "busy"),
        ("strobe", "is address", "hold free", "", "tap 0", "tap 1", "cfg_err", "done"),
        "Write the address 0, then the six durations, n_cm, and the byte that starts a row, with hold free high. The "
        "outputs then show one row's phases: no two of pixel_reset, integrate, cm_reset and read are high at once.",
    ),
}


def sources(project: Project, design: Design) -> list[str]:
    """Names of the Verilog files of ``project``: its only list, from which all others are generated."""
    return [f"{project.top}.v", BUS, f"{design.top}.sv"]


def project_files(project: Project, design: Design, verilog: str) -> dict[str, str]:
    """Files of the project: text by path. verilog: of ``design``."""
    config = {"CLOCK_PERIOD": design.clock.period_ns, "CLOCK_PORT": "clk", **CONFIG}
    ours = [(TOPS / name).read_text() for name in (f"{project.top}.v", BUS)]
    texts = dict(zip(sources(project, design), [*ours, verilog], strict=True))
    return {
        "tinytapeout/info.yaml": info(project, design),
        "tinytapeout/docs/info.md": page(project, texts),
        "tinytapeout/src/config.json": json.dumps(config, indent=2) + "\n",
        **{f"tinytapeout/src/{name}": text for name, text in texts.items()},
    }


def info(project: Project, design: Design) -> str:
    """Text of info.yaml, version 6; a JSON string is a YAML string."""
    text = f"""project:
  title: {json.dumps(project.title)}
  author: "Talbot"
  description: {json.dumps(project.description)}
  language: "SystemVerilog"
  clock_hz: {round(1e9 / design.clock.period_ns)}
  tiles: {json.dumps(project.tiles)}
  top_module: {json.dumps(project.top)}
  source_files:
"""
    text += "".join(f"    - {json.dumps(name)}\n" for name in sources(project, design)) + "\npinout:\n"
    for bank in ("ui", "uo", "uio"):
        text += "".join(f"  {bank}[{k}]: {json.dumps(name)}\n" for k, name in enumerate(getattr(project, bank)))
    return text + "\nyaml_version: 6\n"


def page(project: Project, texts: Mapping[str, str]) -> str:
    """The page docs/info.md of the shuttle's datasheet; the protocol is the comment at the head of each file."""
    files = (texts[name].splitlines() for name in (f"{project.top}.v", BUS))
    heads = [takewhile(lambda line: line.startswith("//"), lines) for lines in files]
    works = "\n\n".join("\n".join(line.removeprefix("//").strip() for line in head) for head in heads)
    sections = ("How it works", works), ("How to test", project.test), ("External hardware", "None.")
    return "\n".join(f"## {title}\n\n{text}\n" for title, text in sections)
