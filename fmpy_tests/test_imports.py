"""Modules of the Python package import each other in no circle, imports for annotations included."""

import ast
import graphlib
from pathlib import Path

ROOT = Path(__file__).parent.parent / "python" / "src"


def name_of(path):
    """Parts of the name of a module or package."""
    parts = path.relative_to(ROOT).with_suffix("").parts
    return parts[:-1] if parts[-1] == "__init__" else parts


def imports(path, known):
    """Modules of the package that a file names, at its top, in functions or for annotations."""
    package = name_of(path) if path.name == "__init__.py" else name_of(path)[:-1]
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.level:
            of = (*package[: len(package) - node.level + 1], *(node.module or "").split("."))
            of = tuple(filter(None, of))
            for alias in node.names:
                yield (*of, alias.name) if (*of, alias.name) in known else of


def test_no_import_runs_in_a_circle():
    files = {name_of(path): path for path in ROOT.rglob("*.py")}
    graph = {name: {other for other in imports(path, files) if other != name} for name, path in files.items()}
    assert all(other in files for others in graph.values() for other in others)
    assert sum(map(len, graph.values())) > 100, "imports are found"
    graphlib.TopologicalSorter(graph).prepare()  # CycleError names the circle
