"""Tiny Tapeout: a block behind a byte bus in a few tiles, as a project that its tools take: info.yaml, src/, docs/."""

import json
from dataclasses import dataclass
from pathlib import Path

from models.parameters import ParameterError, check_choice
from platforms.sky130.tinytapeout import CONFIG, SIZES_UM

TOPS = Path(__file__).parent / "tops"
BUS = "tt_bytes.v"


@dataclass(frozen=True)
class Project:
    """top: its module, file <top>.v in tops/. tiles: of SIZES_UM. ui, uo, uio: pins 0..7, '' for unused."""

    top: str
    title: str
    description: str
    tiles: str
    ui: tuple
    uo: tuple
    uio: tuple
    test: str

    def __post_init__(self):
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


def sources(project, design):
    """Names of the Verilog files of a Project: its only list, from which all others are made."""
    return [f"{project.top}.v", BUS, f"{design.top}.v"]


def project_files(project, design, verilog):
    """Files of the project: dict path -> text. verilog: of the Design."""
    config = {"CLOCK_PERIOD": design.clock.period_ns, "CLOCK_PORT": "clk", **CONFIG}
    texts = dict(
        zip(
            sources(project, design),
            ((TOPS / f"{project.top}.v").read_text(), (TOPS / BUS).read_text(), verilog),
            strict=True,
        )
    )
    return {
        "tinytapeout/info.yaml": info(project, design),
        "tinytapeout/docs/info.md": page(project, texts),
        "tinytapeout/src/config.json": json.dumps(config, indent=2) + "\n",
        **{f"tinytapeout/src/{name}": text for name, text in texts.items()},
    }


def info(project, design):
    """Text of info.yaml, version 6."""

    def quoted(text):
        return json.dumps(text)  # a JSON string is a YAML string

    lines = [
        "project:",
        f"  title: {quoted(project.title)}",
        '  author: "Talbot"',
        f"  description: {quoted(project.description)}",
        '  language: "SystemVerilog"',
        f"  clock_hz: {round(1e9 / design.clock.period_ns)}",
        f"  tiles: {quoted(project.tiles)}",
        f"  top_module: {quoted(project.top)}",
        "  source_files:",
        *(f"    - {quoted(name)}" for name in sources(project, design)),
        "",
        "pinout:",
    ]
    for bank in ("ui", "uo", "uio"):
        lines += [f"  {bank}[{k}]: {quoted(name)}" for k, name in enumerate(getattr(project, bank))]
    return "\n".join([*lines, "", "yaml_version: 6", ""])


def page(project, texts):
    """docs/info.md: the page of the shuttle's datasheet; the protocol as the top's own comment says it."""

    def comment(name):
        lines = texts[name].splitlines()
        end = next(k for k, line in enumerate(lines) if not line.startswith("//"))
        return "\n".join(line.removeprefix("//").strip() for line in lines[:end])

    return "\n".join(
        [
            "## How it works",
            "",
            comment(f"{project.top}.v"),
            "",
            comment(BUS),
            "",
            "## How to test",
            "",
            project.test,
            "",
            "## External hardware",
            "",
            "None.",
            "",
        ]
    )
