"""From a block's Verilog to a layout with all its checks: `talbot layout quad_divider`."""
