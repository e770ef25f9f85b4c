"""Modules of the Python package, and what they say about themselves: for a page of the site each, and for their tables."""

import ast
import re
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent.parent / "python" / "src" / "wheelrail"


def said(node):
    """First line of what a module, class or function says about itself."""
    return (ast.get_docstring(node) or "").split("\n", 1)[0]


def modules():
    """Modules of the Python package by their dotted names, with the first line of what each says about itself."""
    found = {}
    for path in sorted(PACKAGE.rglob("*.py")):
        parts = ("wheelrail", *path.relative_to(PACKAGE).with_suffix("").parts)
        name = ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
        if not re.search(r"\.(_|examples)", name):
            found[name] = said(ast.parse(path.read_text()))
    del found["wheelrail"]
    return found


def exported():
    """Functions and classes that `import wheelrail` gives, with the module that defines each and the first line about it."""
    tree = ast.parse((PACKAGE / "__init__.py").read_text())
    for taken in (node for node in tree.body if isinstance(node, ast.ImportFrom) and node.module):
        for name in (alias.name for alias in taken.names):
            module, node = defined(taken.module, name)
            yield name, f"wheelrail.{module}.{name}", said(node)


def defined(module, name):
    """The module in which a name is defined, and its definition: modules hand on what they import from each other."""
    tree = ast.parse((PACKAGE / f"{module.replace('.', '/')}.py").read_text())
    for node in tree.body:
        if isinstance(node, (ast.ClassDef, ast.FunctionDef)) and node.name == name:
            return module, node
        if isinstance(node, ast.ImportFrom) and node.level and any(alias.name == name for alias in node.names):
            return defined(node.module, name)
    raise LookupError(f"{module}.py does not define {name}")
