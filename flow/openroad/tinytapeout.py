"""Tiny Tapeout: a block behind a byte bus in a few tiles, as a project that its tools take: info.yaml, src/, docs/."""

import json
import re
from dataclasses import dataclass

from talbot.flow.layout.design import Design
from talbot.models.parameters import ParameterError
from talbot.platforms.sky130.tinytapeout import CONFIG, FRAME


@dataclass(frozen=True)
class Project:
    """Text of a project's page. ui, uo, uio: pins 0..7, '' for unused."""

    title: str
    description: str
    ui: tuple[str, ...]
    uo: tuple[str, ...]
    uio: tuple[str, ...]
    test: str

    def __post_init__(self) -> None:
        for name in ("ui", "uo", "uio"):
            if len(getattr(self, name)) != 8:
                raise ParameterError(f"{name} = {len(getattr(self, name))} pins: must be 8")


_DATA = tuple(f"data {k}" for k in range(8))
PROJECTS = {  # by design
    "tt_quad_divider": Project(
        "Quadrature divider",
        "Octant, ratio, amplitude and 8-bit phase of a signed 9-bit vector, by a radix-4 division",
        _DATA,
        tuple(f"result {k}" for k in range(8)),
        ("strobe", "is address", "", "", "", "", "busy", "valid"),
        "Write the address 0, then the bytes of x, y and their signs, then any byte to start. When valid is high, "
        "address 0 shows the phase: x = 100, y = 100 gives 32, an eighth of a turn.",
    ),
    "tt_amp_ctrl": Project(
        "Amplifier control of an angle-sensitive pixel",
        "Phases of a differential pixel amplifier with common-mode reset and correlated double sampling",
        _DATA,
        ("pixel_reset", "shutter", "ref_ctl", "integrate", "cm_reset", "read", "sample", "busy"),
        ("strobe", "is address", "hold free", "", "tap 0", "tap 1", "cfg_err", "done"),
        "Write the address 0, then the six durations, n_cm, and the byte that starts a row, with hold free high. The "
        "outputs then show one row's phases: no two of pixel_reset, integrate, cm_reset and read are high at once.",
    ),
    "tt_asp_chip": Project(
        "Readout chip of an angle-sensitive-pixel sensor",
        "Readout, converters' logic, phase divider and run-length encoder of a 384 x 384 light-field sensor",
        ("sclk", "csn", "mosi", "link_rdy", "", "", "", ""),
        tuple(f"link_data {k}" for k in range(8)),
        ("pixel_reset", "integrate", "read", "hold", "miso", "frame_sync", "link_val", "busy"),
        "Write a frame's registers over SPI, test_pattern among them, and the command start: the frame of a digital "
        "image comes out of the link. talbot.models.chip gives its bytes, talbot decode the image.",
    ),
}


def project_files(design: Design, verilog: str) -> dict[str, str]:
    """Files of the project of ``design``: text by path. verilog: all of its modules, the top first."""
    project = PROJECTS[design.name]
    config = {"CLOCK_PERIOD": design.clock.period_ns, "CLOCK_PORT": design.clock.port, **CONFIG}
    return {
        "tinytapeout/info.yaml": info(project, design),
        "tinytapeout/docs/info.md": page(project, verilog),
        "tinytapeout/src/config.json": json.dumps(config, indent=2) + "\n",
        f"tinytapeout/src/{design.top}.sv": verilog,
    }


def info(project: Project, design: Design) -> str:
    """Text of info.yaml, version 6; a JSON string is a YAML string."""
    text = f"""project:
  title: {json.dumps(project.title)}
  author: "Talbot"
  description: {json.dumps(project.description)}
  language: "SystemVerilog"
  clock_hz: {round(1e9 / design.clock.period_ns)}
  tiles: {json.dumps(design.frame.removeprefix(FRAME))}
  top_module: {json.dumps(design.top)}
  source_files:
    - {json.dumps(f"{design.top}.sv")}

pinout:
"""
    for bank in ("ui", "uo", "uio"):
        text += "".join(f"  {bank}[{k}]: {json.dumps(name)}\n" for k, name in enumerate(getattr(project, bank)))
    return text + "\nyaml_version: 6\n"


def page(project: Project, verilog: str) -> str:
    """Return the page docs/info.md of the shuttle's datasheet; the protocol is the comment at the head of our files."""
    heads = re.findall(r"(?m)((?:^//.*\n)+)\n`default_nettype none", verilog)
    works = "\n".join(re.sub(r"(?m)^// ?", "", head) for head in heads)
    sections = ("How it works", works), ("How to test", project.test), ("External hardware", "None.")
    return "\n".join(f"## {title}\n\n{text}\n" for title, text in sections)
