"""Sources that parse the text of an error, or state values in it that are no facts of the error."""

import ast
import re
from collections.abc import Iterable
from pathlib import Path
from types import ModuleType

import rocking.campaigns.disk
from rocking import errors
from rocking.errors import RockingError

TAKEN_APART = re.compile(
    r"str\(\w*error\w*\)\s*\.\s*(?:partition|rpartition|split|startswith|endswith|removeprefix|removesuffix)"
    r"|re\.\w+\([^\n]*str\(\w*error\w*\)|\bin str\(\w*error\w*\)|str\(\w*error\w*\)\[?:"
)


def taken_apart(text: str) -> list[str]:
    """Return the expressions that parse the text of an error."""
    return TAKEN_APART.findall(text)


def family(*modules: ModuleType) -> set[str]:
    """Return the names of the errors of modules and of the library."""
    return {
        name
        for module in (errors, rocking.campaigns.disk, *modules)
        for name, kind in vars(module).items()
        if isinstance(kind, type) and issubclass(kind, RockingError)
    }


def finished_sentences(tree: ast.AST, names: set[str]) -> list[int]:
    """Return the lines that make an error of a finished sentence in place of a template and its facts."""
    return [
        call.lineno
        for call in ast.walk(tree)
        if isinstance(call, ast.Call)
        and (getattr(call.func, "id", "") in names or getattr(call.func, "attr", "") == "error")
        and any(isinstance(text, ast.JoinedStr) for text in call.args)
    ]


def without_facts(tree: ast.AST) -> list[int]:
    """Return the lines whose error has a field in its text that is not one of its facts."""
    lines = []
    for call in ast.walk(tree):
        if not (isinstance(call, ast.Call) and isinstance(call.func, ast.Name) and call.func.id.endswith("Error")):
            continue
        names = {keyword.arg for keyword in call.keywords}
        if not call.args or not isinstance(call.args[0], ast.Constant) or None in names or not names - {"hint"}:
            continue
        fields = set(re.findall(r"\{(\w+)[!:}]", str(call.args[0].value)))
        if not fields <= names | {"parameter", "value", "allowed"}:
            lines.append(call.lineno)
    return lines


def sources(folder: Path) -> Iterable[tuple[str, str]]:
    """Yield the Python files below the folder of a package: name from the package on, and text."""
    for path in sorted(folder.rglob("*.py")):
        yield path.relative_to(folder.parent).as_posix(), path.read_text("utf-8")
