"""Functional cover points by folder of rtl/: conditions on ports, true in the cycles that reach the point."""

from talbot.verif.coverage.points import (
    adc_bank,
    amp_ctrl,
    asp_chip,
    edge_adc,
    phase_path,
    quad_divider,
    readout_seq,
    reg_file,
    run_length,
)

POINTS = {
    "adc_bank": adc_bank.POINTS,
    "amp_ctrl": amp_ctrl.POINTS,
    "asp_chip": asp_chip.POINTS,
    "edge_adc": edge_adc.POINTS,
    "phase_path": phase_path.POINTS,
    "quad_divider": quad_divider.POINTS,
    "readout_seq": readout_seq.POINTS,
    "reg_file": reg_file.POINTS,
    "run_length": run_length.POINTS,
}
