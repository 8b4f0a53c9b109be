"""From a block's Verilog to a layout with all its checks: `python -m flow.layout quad_divider`."""
