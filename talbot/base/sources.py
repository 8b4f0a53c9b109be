"""The files of the package that decide what a piece of code does, found in its text.

From a module on, the closure of: what it imports (a re-export leads to the file that defines the name), modules that
its strings name (``[sys.executable, "-m", "talbot.rtl.export"]``, ``import_module("a.b")``, f-strings as
``f"talbot.platforms.{pdk}.layers"``; for "pytest" conftest.py), and data files that its strings name (``"bench.sv"``,
``"*.tcl"``). No text is run.
"""

import ast
import contextlib
import json
import re
import sys
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import astuple, dataclass
from functools import cache, cached_property
from itertools import accumulate
from pathlib import Path
from threading import Lock

from talbot.base.cache import digest
from talbot.base.files import write
from talbot.base.paths import BUILD, PACKAGE, ROOT

DATA = frozenset(
    (".md", ".toml", ".sv", ".v", ".cpp", ".vlt", ".rdl", ".tcl", ".lib", ".html", ".css", ".js", ".json", ".yaml")
)
SKIPPED = frozenset(("build", "__pycache__", ".venv", ".git", "node_modules"))
ENDINGS = "|".join(suffix[1:] for suffix in sorted(DATA))
DATA_NAME = re.compile(rf"[\w*./-]*[\w*-]\.(?:{ENDINGS})")
PARSED = BUILD / "sources.json"  # what was read of texts, by their digest
_READING = Lock()  # of trees: a thread at a time
TEXTS = 5000  # that are kept there at most


@dataclass(frozen=True)
class Reference:
    """A module that a file needs, and a name in it ('' for all of it)."""

    module: str
    name: str = ""


@dataclass(frozen=True)
class Text:
    """References of a module's text.

    imports: with the name that each binds; named: modules that strings name; patterns: of f-strings, for modules'
    names; files: data files that strings name; plain: whether it is an __init__.py of re-exports alone.
    """

    path: Path
    imports: list[tuple[str, Reference]]
    named: list[str]
    patterns: list[str]
    files: list[Path]
    plain: bool


@dataclass(frozen=True)
class Syntax:
    """What a module's text says wherever it is: of `Text`, before names are looked up in a tree.

    imports: level (-1: import without from), module, names with what each binds. named: candidates for modules' names;
    files: names of data files, with * too.
    """

    imports: list[tuple[int, str, list[tuple[str, str]]]]
    named: list[str]
    patterns: list[str]
    files: list[str]
    plain: bool


class Tree:
    """The Python modules and data files of the package in ``root`` and what each refers to, by text alone."""

    def __init__(self, root: Path = ROOT) -> None:
        self.root, self.package = root, root / PACKAGE.name
        self._texts: dict[str, Text] = {}
        self._digests: dict[Path, str] = {}
        self._fitting: dict[str, list[str]] = {}

    def digest(self, files: Iterable[Path]) -> str:
        """Return the digest of files: their places below the root and their contents."""
        for file in (files := list(files)):
            self._digests[file] = self._digests.get(file) or digest(file)
        return digest(
            *(part for file in files for part in (file.relative_to(self.root).as_posix(), self._digests[file]))
        )

    def forget(self, name: str) -> None:
        """Drop what was read of the files with a ``name``."""
        self._texts = {module: text for module, text in self._texts.items() if text.path.name != name}
        self._digests = {file: known for file, known in self._digests.items() if file.name != name}

    @cached_property
    def modules(self) -> dict[str, Path]:
        """Every module by its dotted name, and conftest; a package is its __init__.py."""
        found = {"conftest": path} if (path := self.root / "conftest.py").exists() else {}
        for path in _files(self.package, (".py",)):
            parts = path.relative_to(self.root).with_suffix("").parts
            found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
        return found

    @cached_property
    def data(self) -> dict[str, list[Path]]:
        """Data files by their name without folders."""
        found: dict[str, list[Path]] = {}
        for path in _files(self.package, DATA):
            found.setdefault(path.name, []).append(path)
        return found

    def closure(self, starts: Iterable[str | Path], chosen: Mapping[str, str] | None = None) -> list[Path]:
        """All files that decide what ``starts`` (dotted names; files and folders of the package) do, ascending.

        chosen: package -> the one of its members that an f-string with that package in front means; without it all
        that fit. Raises KeyError for a start that is none.
        """
        todo, seen, found = list(self._starts(starts)), set(), set()
        while todo:
            reference = todo.pop()
            if reference not in seen:
                seen.add(reference)
                text, more = self._resolved(reference, chosen or {})
                todo += more
                if text:
                    found |= {text.path, *text.files}
        return sorted(found)

    def _starts(self, starts: Iterable[str | Path]) -> Iterator[Reference]:
        names = {path: name for name, path in self.modules.items()}
        for start in starts:
            if isinstance(start, str) and start in self.modules:
                yield Reference(start)
                continue
            path = next((path for path in (self.package / start, self.root / start) if path.exists()), None)
            if not path:
                raise KeyError(f"{start}: neither a module nor a file of {self.package}")
            for file in [path] if path.is_file() else _files(path, (".py",)):
                yield Reference(names[file])

    def _resolved(self, reference: Reference, chosen: Mapping[str, str]) -> tuple[Text | None, list[Reference]]:
        """Return the text that ``reference`` adds (None: a re-export) and what that refers to."""
        text = self._text(reference.module)
        if text.plain and reference.name in dict(text.imports):
            return None, [dict(text.imports)[reference.name]]
        more = [*(found for _, found in text.imports), *map(Reference, text.named)]
        for pattern in text.patterns:
            more += [Reference(name) for name in self._named(pattern) if _meant(name, chosen)]
        _, *parents = accumulate(reference.module.split("."), "{}.{}".format)  # talbot itself loads nothing
        more += [Reference(name) for name in parents[:-1] if name in self.modules and not self._text(name).plain]
        return text, more

    def _named(self, pattern: str) -> list[str]:
        """Return the modules whose names fit a regular expression."""
        if pattern not in self._fitting:
            self._fitting[pattern] = [name for name in self.modules if re.fullmatch(pattern, name)]
        return self._fitting[pattern]

    def _text(self, module: str) -> Text:
        if module not in self._texts:
            path = self.modules[module]
            syntax = _syntax(path.read_text(encoding="utf-8"))
            package = module if path.name == "__init__.py" else module.rpartition(".")[0]
            self._texts[module] = Text(
                path,
                list(self._imports(syntax, package)),
                [name for name in syntax.named if name in self.modules],
                syntax.patterns,
                [file for name in syntax.files for file in self._files_named(name, path.parent)],
                path.name == "__init__.py" and syntax.plain,
            )
        return self._texts[module]

    def _imports(self, syntax: Syntax, package: str) -> Iterator[tuple[str, Reference]]:
        """Yield the references of import statements by the name that each binds."""
        for level, named, names in syntax.imports:
            if level < 0:
                yield from ((name, Reference(name)) for name, _ in names if name in self.modules)
                continue
            base = _absolute(level, named, package)
            for name, bound in names:
                if (module := f"{base}.{name}") in self.modules:
                    yield bound, Reference(module)
                elif base in self.modules:
                    yield bound, Reference(base, "" if name == "*" else name)

    def _files_named(self, name: str, folder: Path) -> list[Path]:
        if "*" in name:
            return [file for file in folder.rglob(Path(name).name) if not SKIPPED & set(file.parts)]
        same = self.data.get(Path(name).name, [])
        beside = [file for file in same if file.parent == folder]
        below = [file for file in same if file.is_relative_to(folder)]
        return beside or below or same


def _files(folder: Path, suffixes: Iterable[str]) -> list[Path]:
    found = []
    for path in sorted(folder.iterdir()):
        if path.is_dir():
            if path.name not in SKIPPED and not path.name.startswith("."):
                found += _files(path, suffixes)
        elif path.suffix in suffixes:
            found.append(path)
    return found


def _absolute(level: int, module: str, package: str) -> str:
    if not level:
        return module
    parts = package.split(".")
    return ".".join(parts[: len(parts) - level + 1] + ([module] if module else []))


def _syntax(text: str) -> Syntax:
    """Kept by the text itself, so that a tree with one file changed, or a copy of a tree, parses one file."""
    key, known = digest(text), _parsed()
    if key not in known:
        known[key] = _read(text)
    return known[key]


@cache
def _parsed() -> dict[str, Syntax]:
    """Return the texts that earlier processes parsed; nothing where the file is not as `_keep` wrote it."""
    with contextlib.suppress(OSError, ValueError, TypeError):
        check, found = json.loads(PARSED.read_bytes())
        if check == _check(found):
            return {key: Syntax(*values) for key, values in found.items()}
    return {}


def _check(found: object) -> str:
    return digest(Path(__file__), sys.version, json.dumps(found))


def _keep(before: int) -> None:
    """Keep the parsed texts, where they are more than ``before`` texts."""
    known = _parsed()
    if len(known) > before:
        found = {key: astuple(syntax) for key, syntax in list(known.items())[-TEXTS:]}
        with contextlib.suppress(OSError):  # a folder of another user, a full disk
            write(PARSED, json.dumps([_check(found), found]))


def _read(text: str) -> Syntax:
    tree = ast.parse(text)
    nodes = list(ast.walk(tree))
    strings = dict.fromkeys(_strings(nodes))
    programs = {word for text in strings if "import " in text for word in re.findall(r"[\w.]+", text)}
    started = set(_started(nodes))
    dotted = {word for word in programs | {*strings} if "." in word} | started
    return Syntax(
        [
            (node.level, node.module or "", names) if isinstance(node, ast.ImportFrom) else (-1, "", names)
            for node in nodes
            if isinstance(node, (ast.Import, ast.ImportFrom))
            for names in [[(alias.name, alias.asname or alias.name) for alias in node.names]]
        ],
        [name for word in sorted(dotted) for name in (word, f"{word}.__main__")]
        + (["conftest"] if "pytest" in programs | started else []),
        list(dict.fromkeys(_patterns(nodes))),
        [name for text in strings if len(text) < 200 for name in DATA_NAME.findall(text)],
        _plain(tree),
    )


def _strings(nodes: list[ast.AST]) -> Iterator[str]:
    documents = {
        id(node.body[0].value)
        for node in nodes
        if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef)) and node.body
        if isinstance(node.body[0], ast.Expr)
    }
    for node in nodes:
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in documents:
            yield node.value


def _started(nodes: list[ast.AST]) -> Iterator[str]:
    """Yield what follows "-m" in a list: modules that a process runs."""
    for node in nodes:
        if isinstance(node, (ast.List, ast.Tuple)):
            texts = [element.value if isinstance(element, ast.Constant) else None for element in node.elts]
            yield from (str(module) for option, module in zip(texts, texts[1:], strict=False) if option == "-m")


def _patterns(nodes: list[ast.AST]) -> Iterator[str]:
    """Of f-strings that begin as a dotted name does: regular expressions for the names of modules."""
    for node in nodes:
        if isinstance(node, ast.JoinedStr) and isinstance(node.values[0], ast.Constant):
            text = "".join(
                re.escape(str(part.value)) if isinstance(part, ast.Constant) else r"\w+" for part in node.values
            )
            if re.match(r"\w+\\\.", text) and re.fullmatch(r"(\w|\\\.|\\w\+)+", text):
                yield text


def _meant(name: str, chosen: Mapping[str, str]) -> bool:
    return all(
        not name.startswith(f"{package}.") or f"{name}.".startswith(f"{package}.{one}.")
        for package, one in chosen.items()
    )


def _plain(tree: ast.Module) -> bool:
    """Return whether an __init__.py holds a docstring, imports and __all__ alone."""
    return all(
        isinstance(node, (ast.Import, ast.ImportFrom))
        or isinstance(node, ast.Expr)
        and isinstance(node.value, ast.Constant)
        or isinstance(node, ast.Assign)
        and [target.id for target in node.targets if isinstance(target, ast.Name)] == ["__all__"]
        for node in tree.body
    )


@cache
def _tree(root: Path) -> Tree:
    return Tree(root)


def modules(root: Path = ROOT) -> Mapping[str, Path]:
    """Every module of the package by its dotted name."""
    return _tree(root).modules


@cache
def _code(root: Path, starts: tuple[str | Path, ...], chosen: tuple[tuple[str, str], ...]) -> str:
    with _READING:
        tree, before = _tree(root), len(_parsed())
        found = tree.digest(tree.closure(starts, dict(chosen)))
        _keep(before)
        return found


def code(*starts: str | Path, chosen: Mapping[str, str] | None = None, root: Path = ROOT) -> str:
    """Digest of all files that decide what ``starts`` do: text for a key of `base.cache`.

    starts: dotted names of modules, or files and folders relative to the package or ``root``; a module from elsewhere
    decides by its version, which is not looked at here. chosen: see `Tree.closure`. Computed once in a process for the
    same arguments.
    """
    inside = modules(root)
    starts = tuple(start for start in starts if not isinstance(start, str) or start in inside or "/" in start)
    return _code(root, starts, tuple(sorted((chosen or {}).items())))


def forget(file: Path | None = None, root: Path = ROOT) -> None:
    """Drop what was read of all trees: the files of a tree are taken to stay as they are while a process runs.

    file: of the tree in ``root``, to drop what was read of it alone; none is new there and none is gone.
    """
    if file:
        _tree(root).forget(file.name)
    else:
        _tree.cache_clear()
    _code.cache_clear()
