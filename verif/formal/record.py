"""The record of what is proven: proven.txt has a line for each wrapper, with a digest of all its proofs.

The digest is of the exported Verilog, the wrapper, the depths, the tools' versions and the code of this folder that
decides a result.
`talbot formal --changed` leaves out the wrappers whose digest is in the record: a fresh clone proves only what differs
from it. `talbot formal --record` writes the record after a whole run without a problem.
"""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from talbot.base.cache import digest
from talbot.base.files import write
from talbot.verif.formal.plan import Piece
from talbot.verif.formal.proof import Proof

FOLDER = Path(__file__).parent
RECORD = FOLDER / "proven.txt"
CALLERS = "command.py", "record.py"  # which decide no result
HEAD = "# Written by `talbot formal --record`: each wrapper, with the digest of its proofs' jobs\n"


def digests(planned: Iterable[tuple[Proof, Sequence[Piece]]]) -> dict[str, str]:
    """Return wrapper -> digest of all its proofs. planned: each proof with its pieces."""
    code = digest(*sorted(path for path in FOLDER.glob("*.py") if path.name not in CALLERS))
    jobs: dict[str, list[str]] = {}
    for proof, parts in planned:
        jobs.setdefault(_name(proof), []).extend(digest(code, piece.job.name, *piece.job.inputs) for piece in parts)
    return {name: digest(*sorted(parts)) for name, parts in sorted(jobs.items())}


def unproven(
    planned: Sequence[tuple[Proof, Sequence[Piece]]], record: Path = RECORD
) -> list[tuple[Proof, Sequence[Piece]]]:
    """Return the entries of ``planned`` whose wrapper is not in the record with this digest."""
    recorded, now = read(record), digests(planned)
    return [(proof, parts) for proof, parts in planned if recorded.get(_name(proof)) != now[_name(proof)]]


def read(record: Path = RECORD) -> dict[str, str]:
    """Return wrapper -> digest from the record; {} where there is none."""
    if not record.exists():
        return {}
    lines = record.read_text(encoding="utf-8").splitlines()
    return dict(line.split(" ", 1) for line in lines if line and not line.startswith("#"))


def keep(proven: Mapping[str, str], record: Path = RECORD) -> None:
    """Write the record. proven: wrapper -> digest."""
    write(record, HEAD + "".join(f"{name} {value}\n" for name, value in proven.items()))


def _name(proof: Proof) -> str:
    return f"{proof.wrapper.parent.parent.name}/{proof.wrapper.name}"
