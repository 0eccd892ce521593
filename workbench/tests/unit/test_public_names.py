"""The application uses the documented names of the library; the number of inner names may only fall."""

import ast
import importlib
import runpy
from pathlib import Path

import rocking_workbench

SOURCE = Path(rocking_workbench.__file__).parent
REFERENCE = runpy.run_path(str(Path(__file__).parents[3] / "docs/_ext/reference.py"))
INNER = 127  # names of spec, reports, plots and others that have no page in the manual yet


def imported(text):
    """Return the names that a source imports from the library, each with its module."""
    return {
        (node.module, name.name)
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.ImportFrom) and node.module and node.module.partition(".")[0] == "rocking"
        for name in node.names
    }


def inner(names):
    """Return the names that no documented package exports."""
    exported = {room: set(REFERENCE["names_of"](importlib.import_module(room))) for room in REFERENCE["ROOMS"]}
    return sorted((module, name) for module, name in names if name not in exported.get(module, ()))


def test_the_application_uses_documented_names():
    names = {name for path in SOURCE.rglob("*.py") for name in imported(path.read_text("utf-8"))}
    assert len(inner(names)) <= INNER, inner(names)
    # negative control
    assert inner(imported("from rocking import Block\nfrom rocking.spec.fields import Values")) == [
        ("rocking.spec.fields", "Values")
    ]
