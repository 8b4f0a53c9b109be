"""RTL imports of models/ the parameters alone, not the golden models; FL, CL and host drivers may use more."""

import ast
from pathlib import Path

import pytest

RTL = Path(__file__).parents[1]
FILES = [
    path
    for path in sorted(RTL.rglob("*.py"))
    if not {"test", "formal", "host"} & set(path.relative_to(RTL).parts)
    and not path.stem.endswith(("_fl", "_cl", "golden", "golden_run"))
]


def imported(path):
    """Modules that the file imports from outside its own folder."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom) and not node.level:
            yield node.module
        elif isinstance(node, ast.Import):
            yield from (name.name for name in node.names)


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(RTL)))
def test_the_rtl_imports_of_the_models_only_their_parameters(path):
    golden = [
        name
        for name in imported(path)
        if name.startswith("talbot.models") and not name.startswith("talbot.models.parameters")
    ]
    assert not golden, f"{path.name} imports {', '.join(golden)}: must import talbot.models.parameters only"
