"""Coriolis's log."""

import re


def open_segments(log: str) -> int:
    """Segments that the router gave up."""
    found = re.search(r"Track Segment.*\[(\d+)\+(\d+)\]", log)
    return int(found[2]) if found else 0


def open_nets(log: str) -> list[str]:
    """Names of the nets with a segment that the router gave up, by its own list: in order, each once."""
    return list(dict.fromkeys(re.findall(r"^\s+\d+\| &<id:\d+ (?:Horizontal|Vertical) (\S+) ", log, re.M)))
