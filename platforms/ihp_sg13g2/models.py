"""SG13G2's transistors: enough to tell what a cell does."""

POLARITY = {"sg13_lv_nmos": "n", "sg13_lv_pmos": "p"}
SUPPLIES = {"vdd": 1, "vss": 0}  # rail: its logic level
