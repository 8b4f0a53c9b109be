"""The checks of the interface contract for a chip in Verilator."""

from pathlib import Path

FILE = Path(__file__).parent / "contract.sv"
PHASE = {"on": "phase__on", "msg": "phase__recv__msg", "val": "phase__recv__val", "rdy": "phase__recv__rdy"}
NETS = {
    "clk": "clk",
    "reset": "resets__engine",
    "bank_mode": "bank__mode",
    "bank_threshold": "bank__threshold",
    "bank_idle": "bank__idle",
    "scan_val": "bank__scan__val",
    "step_val": "bank__step__val",
    "step_rdy": "bank__step__rdy",
    "amp_start": "seq__amp_start",
    "amp_done": "seq__amp_done",
    "amp_err": "seq__amp_err",
    "hold_free": "seq__hold_free",
    "frame_sync": "frame_status__frame_sync",
    "seq_busy": "frame_status__seq_busy",
}


def contract(lanes: int, has_phase: bool) -> str:
    """Return Verilog that checks the contract in the exported AspChip, and stops the simulation where it is broken."""
    nets = NETS | {f"phase_{port}": net if has_phase else "0" for port, net in PHASE.items()}
    ports = ", ".join(f".{port}({net})" for port, net in nets.items())
    return f"{FILE.read_text(encoding='utf-8')}\nbind AspChip Contract #(.LANES({lanes})) contract ({ports});\n"
