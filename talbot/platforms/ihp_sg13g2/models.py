"""SG13G2's transistors by polarity, from which a cell's function follows; there are no device models."""

POLARITY = {"sg13_lv_nmos": "n", "sg13_lv_pmos": "p"}
SUPPLIES = {"vdd": 1, "vss": 0}  # rail: its logic level
