"""From a block's Verilog to a layout that is checked: `python -m flow.layout quad_divider`."""
