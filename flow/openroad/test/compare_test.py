"""The table of both libraries of cells."""

import json

from talbot.base.command import main
from talbot.flow.openroad import compare

SUMMARY = {
    "backend": "openroad",
    "wns_ns": {"ss": 1.0, "tt": 2.0},
    "whs_ns": {"ss": 0.3, "tt": 0.1},
    "power_uw": {"tt": 29.0},
    "leakage_uw": {"tt": 0.061, "ss": 1234.4, "ff": 0.5},
    "wall_s": {"route": 600.0, "sta": 37.4},
} | dict.fromkeys(("area_um2", "cells", "f_max_mhz", "wire_um"), 5000)


def test_a_row_stays_where_its_layout_is_not_there(tmp_path, capsys):
    document, folder = tmp_path / "README.md", tmp_path / "layout" / "quad_divider"
    rows = "| quad_divider | sky130_fd_sc_hd | 7 |\n| quad_divider | compact | 8 |\n"
    document.write_text(f"<!-- cells -->\n\n{rows}\n<!-- end of cells -->\n")
    folder.mkdir(parents=True)
    (folder / "summary.json").write_text(json.dumps(SUMMARY))
    line = ["quad_divider", "amp_ctrl", "--out", str(folder.parent)]
    assert main(compare, [*line, "--document", str(document)]) == 0
    written = document.read_text().splitlines()
    assert written[0] == "<!-- cells -->" and "| quad_divider | sky130_fd_sc_hd | 7 |" in written
    (measured,) = [text for text in written if text.startswith("| quad_divider | compact |")]
    assert "| 0.0050 | 5,000 |" in measured and "| 5.0 | 637 |" in measured
    assert "| +1.00, +0.10 | 29 | 0.06 / 1,234 / 0.50 |" in measured
    assert {"No layout with `compact`: `amp_ctrl`.", "No layout with `sky130_fd_sc_hd`: `amp_ctrl`."} <= set(written)
    capsys.readouterr()
    assert main(compare, line) == 0  # of no document nothing is known
    assert "No layout with `sky130_fd_sc_hd`: `quad_divider`, `amp_ctrl`." in capsys.readouterr().out
