"""The archive: the same to the byte, whole, refused by name where something is missing or broken."""

import hashlib
import json
import os
import tarfile
import time

import pytest

from talbot.base.command import main
from talbot.base.lef.read import read_macro
from talbot.flow.handoff import command, contents
from talbot.flow.handoff.power import powered
from talbot.flow.layout.design import design
from talbot.flow.layout.report.metrics import RULES
from talbot.models.parameters import ParameterError

NAME, TOP, TILE = "quad_divider", "QuadDividerRadix4", "tt_quad_divider"
LEF = f"""VERSION 5.8 ;
MACRO {TOP}
  SIZE 120.000 BY 98.600 ;
  PIN x[10]
    DIRECTION INPUT ;
    USE SIGNAL ;
    PORT
      LAYER met2 ;
        RECT 1.0 0.0 1.4 0.8 ;
    END
  END x[10]
  PIN x[9]
    DIRECTION INPUT ;
    PORT
      LAYER met3 ;
        RECT 0.0 2.0 0.8 2.4 ;
    END
  END x[9]
END {TOP}
END LIBRARY
"""
NETLIST = f"""module {TOP} (a, q);
  input a;
  output q;
  inv_x1 \\u$1  (.i(a), .nq(q));
  dff_x1 r_reg (.clk(a), .i(a), .q(\\state[0] ));
endmodule
"""


def passing():
    """A summary that keeps every rule, whatever rules there are."""
    summary = {"design": NAME, "pdk": "sky130", "tools": {"yosys": "0.23"}}
    for name, rule in RULES.items():
        *way, last = name.split(".")
        at = summary
        for part in way:
            at = at.setdefault(part, {})
        at[last] = rule.get("is", rule.get("least", rule.get("most")))
    return summary


@pytest.fixture
def layouts(tmp_path):
    """A folder of layouts with two that are complete but for the optional files."""
    for name in (NAME, TILE):
        folder, top = tmp_path / "layout" / name, design(name).top
        (folder / "rtl").mkdir(parents=True)
        (folder / "rtl" / f"{top}.sv").write_text("// rtl\n")
        (folder / "report.html").write_text('<html><img src="picture.png"><img src="data:x"></html>\n')
        (folder / "picture.png").write_text("picture\n")
        (folder / "summary.json").write_text(json.dumps(passing()))
        texts = dict.fromkeys(contents.REQUIRED, "text\n") | {"lef": LEF, "v": NETLIST}
        for suffix, text in texts.items():
            (folder / f"{name}.{suffix}").write_text(text)
    return tmp_path / "layout"


def run(layouts, out, name=NAME):
    return main(command, ["--design", name, "--layouts", str(layouts), "--out", str(out)])


def test_made_twice_it_is_the_same_to_the_byte(layouts, tmp_path):
    assert run(layouts, tmp_path / "a") == 0
    for path in layouts.rglob("*"):
        os.utime(path, (time.time() + 9999,) * 2)
        path.chmod(0o700)
    assert run(layouts, tmp_path / "b") == 0
    first, second = ((tmp_path / name / f"{NAME}.tar.gz").read_bytes() for name in "ab")
    assert first == second


def test_the_manifest_has_every_file_with_its_hash(layouts, tmp_path):
    assert run(layouts, tmp_path) == 0
    with tarfile.open(tmp_path / f"{NAME}.tar.gz") as tar:
        data = {entry.name.removeprefix(f"{NAME}/"): tar.extractfile(entry).read() for entry in tar}
    listed = json.loads(data.pop("manifest.json"))
    assert {name: hashlib.sha256(text).hexdigest() for name, text in data.items()} == {
        name: entry["sha256"] for name, entry in listed["files"].items()
    }
    assert listed["versions"]["yosys"] == "0.23" and set(listed["substitutes"]) == set(contents.OPTIONAL)
    assert {
        "layout/quad_divider.gds",
        "layout/quad_divider.lef",
        "rtl/QuadDividerRadix4.sv",
        "netlist/quad_divider.v",
        "netlist/quad_divider.power.v",
        "pinout.md",
        "datasheet.md",
        "waivers.json",
        "reports/picture.png",
    } <= set(data)
    assert "| x[10] | input | signal | met2 | 1.2 | 0.4 |" in data["pinout.md"].decode()
    assert "120 x 98.6 um" in data["datasheet.md"].decode()


def test_a_shuttles_project_is_beside_its_layout(layouts, tmp_path):
    assert run(layouts, tmp_path, TILE) == 0
    with tarfile.open(tmp_path / f"{TILE}.tar.gz") as tar:
        data = {entry.name.removeprefix(f"{TILE}/"): tar.extractfile(entry).read() for entry in tar}
    top = design(TILE).top
    assert data[f"tinytapeout/{top}.gds"] == data[f"layout/{TILE}.gds"]
    assert data[f"tinytapeout/{top}.lef"] == data[f"layout/{TILE}.lef"]
    assert b".vdd(VPWR), .vss(VGND)" in data[f"tinytapeout/{top}.v"]
    assert data[f"tinytapeout/src/{top}.sv"] == data[f"rtl/{top}.sv"]
    assert b'tiles: "1x1"' in data["tinytapeout/info.yaml"]


def test_timing_of_every_corner_goes_along(layouts, tmp_path):
    summary = passing() | {"wns_ns": {"tt": 1.0, "ss": 0.5}, "whs_ns": {"tt": 0.1, "ss": 0.2}}
    (layouts / NAME / "summary.json").write_text(json.dumps(summary))
    for corner in ("tt", "ss", "old"):
        (layouts / NAME / f"{NAME}.{corner}.sdf").write_text(corner)
    assert run(layouts, tmp_path) == 0
    with tarfile.open(tmp_path / f"{NAME}.tar.gz") as tar:
        names = {entry.name for entry in tar}
        listed = json.load(tar.extractfile(f"{NAME}/manifest.json"))
        assert "| setup slack, ns (ss) | 0.5 |" in tar.extractfile(f"{NAME}/datasheet.md").read().decode()
    assert {name for name in names if name.endswith(".sdf")} == {
        f"{NAME}/timing/{NAME}.{corner}.sdf" for corner in ("tt", "ss")
    }
    assert "sdf" not in listed["substitutes"] and "spef" in listed["substitutes"]


def test_one_changed_byte_is_another_archive(layouts, tmp_path):
    assert run(layouts, tmp_path / "a") == 0
    (layouts / NAME / f"{NAME}.gds").write_text("texT\n")
    assert run(layouts, tmp_path / "b") == 0
    first, second = ((tmp_path / name / f"{NAME}.tar.gz").read_bytes() for name in "ab")
    assert first != second


def test_what_is_missing_is_named_and_nothing_written(layouts, tmp_path, capsys):
    (layouts / NAME / f"{NAME}.sdc").unlink()
    (layouts / NAME / "rtl" / f"{TOP}.sv").unlink()
    assert run(layouts, tmp_path / "out") == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1 and f"without {NAME}.sdc, rtl/{TOP}.sv: must be a finished layout" in error
    assert not (tmp_path / "out").exists()


def test_a_broken_rule_is_no_archive_unless_waived(layouts, tmp_path, capsys, monkeypatch):
    summary = passing() | {"drc_violations": 3}
    (layouts / NAME / "summary.json").write_text(json.dumps(summary))
    assert run(layouts, tmp_path / "out") == 1
    assert "drc_violations = 3: must be 0" in capsys.readouterr().err
    assert not (tmp_path / "out" / f"{NAME}.tar.gz").exists()
    waiver = {"design": NAME, "rule": "drc_violations", "reason": "agreed with the foundry"}
    monkeypatch.setattr(command, "waived", lambda design: [waiver])
    assert run(layouts, tmp_path / "out") == 0
    with tarfile.open(tmp_path / "out" / f"{NAME}.tar.gz") as tar:
        page = tar.extractfile(f"{NAME}/datasheet.md").read().decode()
    assert "drc_violations: agreed with the foundry" in page


def test_a_waiver_without_a_reason_is_refused(tmp_path):
    path = tmp_path / "waivers.json"
    path.write_text(json.dumps([{"design": NAME, "rule": "lvs_match", "reason": ""}]))
    with pytest.raises(ParameterError, match="waiver of lvs_match = no reason"):
        contents.waived(design(NAME), path)
    assert contents.waived(design("amp_ctrl"), path) == []


def test_every_cell_gets_its_supplies():
    text = powered(NETLIST, {"vdd": "VPWR", "vss": "VGND"})
    assert f"module {TOP} (a, q, VPWR, VGND);" in text and "inout VGND;" in text
    assert text.count(", .vdd(VPWR), .vss(VGND));") == 2
    assert "inv_x1 \\u$1  (.i(a), .nq(q), .vdd(VPWR), .vss(VGND));" in text
    with pytest.raises(ParameterError, match="not one module"):
        powered(NETLIST + NETLIST, {"vdd": "vdd", "vss": "vss"})


def test_lef_is_read_in_the_order_of_the_bits():
    macro = read_macro(LEF)
    assert (macro.name, macro.width_um, macro.height_um) == (TOP, 120.0, 98.6)
    assert list(macro.pins) == ["x[9]", "x[10]"]
    with pytest.raises(ParameterError, match="no MACRO"):
        read_macro("VERSION 5.8 ;")
    with pytest.raises(ParameterError, match="no SIZE"):
        read_macro("MACRO A\nEND A\n")
    with pytest.raises(ParameterError, match="pin a: must have"):
        read_macro("MACRO A\n  SIZE 1 BY 1 ;\n  PIN a\n  DIRECTION INPUT ;\n  END a\nEND A\n")


def test_what_tells_of_a_run_stays_behind(layouts, tmp_path):
    folder = layouts / NAME
    summary = json.loads((folder / "summary.json").read_text())
    archives = []
    for seconds in (1.0, 2.0):
        (folder / "summary.json").write_text(json.dumps(summary | {"wall_s": {"drc": seconds}}))
        (folder / "report.html").write_text(f"<p>page</p><!-- run -->{seconds} s<!-- end of run -->")
        (folder / f"{NAME}.drc.lyrdb").write_text(f"<file>{folder.resolve()}/steps/a.gds</file>")
        assert run(layouts, tmp_path / str(seconds)) == 0
        archives.append((tmp_path / str(seconds) / f"{NAME}.tar.gz").read_bytes())
    assert archives[0] == archives[1]
    with tarfile.open(tmp_path / "1.0" / f"{NAME}.tar.gz") as archive:
        text = archive.extractfile(f"{NAME}/reports/{NAME}.drc.lyrdb").read()
    assert text == f"<file>{NAME}/steps/a.gds</file>".encode()
