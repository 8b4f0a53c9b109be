"""Cells' timing as it was measured once and is shipped: a layout begins without an hour of simulations.

`<pdk>.json` has the key of what was measured and how many simulations that took, `<pdk>.<corner>.lib.xz` the tables.
Where a layout's cells, models, corners or grid are others, the key is another and the cells are measured.
"""

import json
import lzma
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict
from functools import cache
from pathlib import Path
from types import ModuleType

from talbot.base.cache import digest
from talbot.base.files import staged
from talbot.base.liberty.read import names
from talbot.cells.characterize.conditions import Conditions
from talbot.cells.characterize.job import Source
from talbot.cells.netlist.spice import parse
from talbot.cells.spice.circuit import circuit

SHIPPED = Path(__file__).parent
INDEX = "*.json"  # by the name of the process; the text tells base.sources that a step's key counts these


def key(sources: Iterable[Source], conditions: Sequence[Conditions], models: ModuleType, *constants: Path) -> str:
    """Digest of all that decides the tables but the code: what ngspice reads of each cell, and the conditions.

    models: of the devices (`platforms.extraction.device_models`). constants: files of what is not measured.
    """
    parts: list[object] = [json.dumps([asdict(one) for one in conditions]), *constants]
    for source in sources:
        netlist = parse(source.netlist, origin=source.name)
        parts += (source.name, source.area)
        for one in conditions:
            for leakage in (False, True):
                parts += map(_read, circuit(netlist, models, one.models, one.corner, leakage))
    return digest(*parts)


def _read(line: str) -> object:
    """What ngspice reads of a line: of a file that is included its content, wherever it lies."""
    return Path(line.split('"')[1]) if line.startswith(".include") else line


def shipped(pdk: str, wanted: str, folder: Path = SHIPPED) -> tuple[dict[str, str], int] | None:
    """Liberty text by corner and the simulations behind it, if those of ``pdk`` have the key ``wanted``; else None."""
    file = folder / INDEX.replace("*", pdk)
    if not file.is_file() or (about := json.loads(file.read_text(encoding="utf-8")))["key"] != wanted:
        return None
    texts = {c: lzma.decompress((folder / f"{pdk}.{c}.lib.xz").read_bytes()).decode() for c in about["corners"]}
    return texts, about["simulations"]


@cache
def cells(pdk: str, folder: Path = SHIPPED) -> frozenset[str]:
    """Names of the cells in the tables of ``pdk``; none where no tables are shipped."""
    file = next(iter(sorted(folder.glob(f"{pdk}.*.lib.xz"))), None)
    return frozenset(names(lzma.decompress(file.read_bytes()).decode()) if file else ())


def write(folder: Path, pdk: str, made: str, libraries: Mapping[str, Path], simulations: int) -> None:
    """The files of the tables ``libraries`` (corner -> Liberty) of ``pdk``, whose key is ``made``, into ``folder``."""
    with staged(folder) as part:
        for corner, path in libraries.items():
            packed = lzma.compress(path.read_bytes(), preset=9 | lzma.PRESET_EXTREME)
            (part / f"{pdk}.{corner}.lib.xz").write_bytes(packed)
        tables = {corner: digest(path) for corner, path in libraries.items()}
        about = {"key": made, "simulations": simulations, "corners": tables}
        (part / INDEX.replace("*", pdk)).write_text(json.dumps(about, indent=1) + "\n", encoding="utf-8")
