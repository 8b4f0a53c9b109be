"""SkyWater's tables, one JSON file a cell (<cell>.lib.json), as Liberty trees."""

import json
from pathlib import Path
from typing import Any

from talbot.base.liberty.group import Group
from talbot.models.parameters import ParameterError


def files(path: str | Path, corner: str) -> dict[str, Path]:
    """The files *.lib.json of ``corner`` in a folder and all within it, by name of the cell. Raises ParameterError.

    SkyWater's (<library>__<cell>__<corner>[_ccsnoise].lib.json) name their corner, others (<cell>.lib.json) fit any.
    """
    paths: dict[str, Path] = {}
    for file in sorted(Path(path).rglob("*.lib.json")):
        parts = file.name.removesuffix(".lib.json").split("__")
        if len(parts) < 3 or parts[2].removesuffix("_ccsnoise") == corner:
            paths[_short(file.name)] = file
    if not paths:
        raise ParameterError(f"reference = {str(path)!r}: must be a folder with <cell>.lib.json of {corner}")
    return paths


def folder(path: str | Path, corner: str) -> dict[str, Group]:
    """The cells of the `files` of a folder, by name. Raises ParameterError."""
    return {name: cell(file) for name, file in files(path, corner).items()}


def cell(path: str | Path) -> Group:
    """The group 'cell' of one file. Raises ParameterError."""
    try:
        return _group("cell", (_short(Path(path).name),), json.loads(Path(path).read_text(encoding="utf-8")))
    except (ValueError, AttributeError, RecursionError) as error:
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
