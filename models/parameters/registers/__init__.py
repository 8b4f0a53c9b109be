"""The chip's registers: one SystemRDL source (asp_chip.rdl) for RTL, host and document."""

from .host import command, decode_status, frame_writes, read_transfer, status_transfers, write_transfers
from .map import Field, RegisterMap, register_map, trim_range

__all__ = [
    "Field",
    "RegisterMap",
    "command",
    "decode_status",
    "frame_writes",
    "read_transfer",
    "register_map",
    "status_transfers",
    "trim_range",
    "write_transfers",
]
