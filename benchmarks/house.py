"""The size and shape of the code, measured from the code itself: lines, names, circles, arrows, doors, paths."""

import ast
import re
import subprocess
import sys
from collections import Counter, defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from benchmarks.house_citations import cited, text_of_comments
from benchmarks.house_facts import keys_of_answers, last_name, modules_named, nodes, sentences_read, widths
from benchmarks.house_paths import files_passed

ROOT = Path(__file__).parents[1]
SOURCE, TESTS = ROOT / "src" / "rocking", ROOT / "tests"
# rooms from the lowest up: what stands on one line does not know each other
FLOORS = (
    ("messages",),
    ("conventions", "errors", "version"),
    ("language", "outcome", "checks", "plausibility", "portable"),
    ("quantities",),
    ("answers",),
    ("tables", "statistics"),
    ("exported",),
    ("bodies", "motions"),
    ("restitution", "examples"),
    ("dynamics",),
    ("studies", "identification"),
    ("evidence",),
    ("decision",),
    ("spec",),
    ("campaigns",),
    ("plots",),
    ("reports",),
    ("cli",),
    ("__main__",),
)  # fmt: skip


# methods of results that may import a room above, within themselves, and the rooms that they may import
UPWARD, DRAWN_BY = {"plot", "_plot", "animate", "report"}, ("rocking.plots.", "rocking.reports.")


@dataclass(frozen=True)
class Measure:
    """One line of the table."""

    what: str
    measured: str
    goal: str
    met: bool


@cache
def trees(folder: Path) -> dict[str, ast.Module]:
    """Return the syntax tree of every module below a folder, by its dotted name."""
    by_name = {}
    for path in sorted(folder.rglob("*.py")):
        parts = path.relative_to(folder.parent).with_suffix("").parts
        name = ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
        by_name[name] = ast.parse(path.read_text("utf-8"))
        if (stub := path.with_suffix(".pyi")).exists():
            by_name[name].body.append(_exports(ast.parse(stub.read_text("utf-8")), name))
    return by_name


def _exports(stub: ast.Module, package: str) -> ast.If:
    """Return the names that a package imports at first use, from imports for type checkers."""
    for node in stub.body:
        if isinstance(node, ast.ImportFrom) and node.level:
            node.module, node.level = f"{package}.{node.module}" if node.module else package, 0
    return ast.If(test=ast.Name("TYPE_CHECKING"), body=stub.body, orelse=[])


def lines(folder: Path) -> tuple[int, int, int]:
    """Return the lines below a folder: all, with code, of docstrings."""
    every = code = docstrings = 0
    for path in sorted(folder.rglob("*.py")):
        text = path.read_text("utf-8")
        every += len(text.splitlines())
        documented = _docstring_lines(ast.parse(text))
        docstrings += len(documented)
        code += sum(
            bool(line.strip()) and not line.lstrip().startswith("#") and number not in documented
            for number, line in enumerate(text.splitlines(), 1)
        )
    return every, code, docstrings


def _docstring_lines(tree: ast.Module) -> set[int]:
    numbers: set[int] = set()
    for node in nodes(tree):
        kinds = ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef
        if isinstance(node, kinds) and ast.get_docstring(node):
            text = node.body[0]
            numbers.update(range(text.lineno, (text.end_lineno or text.lineno) + 1))
    return numbers


def classes(folder: Path) -> Counter[str]:
    """Return the number of definitions of each class name below a folder."""
    return Counter(
        node.name for tree in trees(folder).values() for node in nodes(tree) if isinstance(node, ast.ClassDef)
    )


def imports(folder: Path) -> dict[str, set[str]]:
    """Return the imports of each module from the others, also in functions and as strings, except types.

    A name from a package leads to its module.
    """
    modules = trees(folder)
    return {name: set(_imported(name, tree, modules)) - {name} for name, tree in modules.items()}


def _imported(name: str, tree: ast.Module, modules: dict[str, ast.Module]) -> Iterator[str]:
    # a package's table of its own exports is no arrow
    named = set() if name.count(".") and _is_package(name, modules) else {module for module in modules if "." in module}
    for node in _executed(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if alias.name in modules)
        elif isinstance(node, ast.ImportFrom) and node.module in modules:
            for alias in node.names:
                yield _home(node.module, alias.name, modules)
        elif isinstance(node, ast.Constant) and node.value in named:
            yield str(node.value)


def _is_package(name: str, modules: dict[str, ast.Module]) -> bool:
    return any(module.startswith(f"{name}.") for module in modules)


def _executed(tree: ast.AST) -> Iterator[ast.AST]:
    inside = [tree]
    while inside:
        for node in ast.iter_child_nodes(inside.pop()):
            if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.dump(node.test):
                inside += node.orelse
                continue
            if isinstance(node, ast.ClassDef):
                inside += [part for statement in node.body for part in _of_method(statement)]
                continue
            yield node
            inside.append(node)


def _of_method(node: ast.stmt) -> list[ast.AST]:
    """Return the executed code of a statement of a class, without imports for plots and reports."""
    body = ast.Module(body=[node], type_ignores=[])
    if not isinstance(node, ast.FunctionDef) or node.name not in UPWARD:
        return [body]
    drawn = [
        statement
        for statement in node.body
        if isinstance(statement, ast.ImportFrom) and f"{statement.module}.".startswith(DRAWN_BY)
    ]
    return [ast.Module(body=[statement for statement in node.body if statement not in drawn], type_ignores=[])]


def _home(module: str, name: str, modules: dict[str, ast.Module]) -> str:
    if f"{module}.{name}" in modules:
        return f"{module}.{name}"
    for node in ast.walk(modules[module]):
        if name in (getattr(node, "name", None), getattr(node, "id", None)):
            return module
        if not isinstance(node, ast.ImportFrom) or node.module not in modules or node.module == module:
            continue
        if any((alias.asname or alias.name) == name for alias in node.names):
            return _home(node.module, name, modules)
    return ""  # compiled


def circles(arrows: dict[str, set[str]]) -> list[list[str]]:
    """Return the groups of modules that import each other in a loop, by Tarjan's method."""
    number: dict[str, int] = {}
    low: dict[str, int] = {}
    stack: list[str] = []
    cycles: list[list[str]] = []

    def visit(name: str) -> None:
        number[name] = low[name] = len(number)
        stack.append(name)
        for other in sorted(arrows.get(name, ())):
            if other not in number:
                visit(other)
            if other in stack:
                low[name] = min(low[name], low[other])
        if low[name] == number[name]:
            group = stack[stack.index(name) :]
            del stack[stack.index(name) :]
            if len(group) > 1:
                cycles.append(sorted(group))

    sys.setrecursionlimit(10_000)
    for name in sorted(arrows):
        if name not in number:
            visit(name)
    return cycles


def upward(arrows: dict[str, set[str]]) -> list[tuple[str, str]]:
    """Return imports of a package from a higher or equal layer."""
    floor = {room: height for height, rooms in enumerate(FLOORS) for room in rooms}

    def room(name: str) -> str:
        return name.split(".")[1] if "." in name else ""

    return [
        (name, other)
        for name, others in arrows.items()
        for other in sorted(others)
        if room(name) and room(other) and room(name) != room(other) and floor[room(other)] >= floor[room(name)]
    ]


# modules that choose the mechanics, or take its bodies
CHOICE = re.compile(r"rocking\.dynamics\.((\w+\.)?mechanics(_base)?|\w+\.body)")


def choices_of_mechanics(folder: Path) -> dict[str, list[str]]:
    """Return code outside the choice of mechanics with a test of body or friction."""
    locations: dict[str, list[str]] = {"in_space()": [], "friction is None": [], "isinstance(..., Solid)": []}
    for name, tree in trees(folder).items():
        if CHOICE.fullmatch(name):
            continue
        for node in nodes(tree):
            if isinstance(node, ast.Call) and last_name(node.func) == "in_space":
                locations["in_space()"].append(f"{name}:{node.lineno}")
            if isinstance(node, ast.Call) and last_name(node.func) == "isinstance":
                kinds = node.args[1].elts if isinstance(node.args[1], ast.Tuple) else [node.args[1]]
                if "Solid" in map(last_name, kinds):
                    locations["isinstance(..., Solid)"].append(f"{name}:{node.lineno}")
            if (
                isinstance(node, ast.Compare) and last_name(node.left) == "friction"
                and isinstance(node.comparators[0], ast.Constant) and node.comparators[0].value is None
            ):  # fmt: skip
                locations["friction is None"].append(f"{name}:{node.lineno}")
    return locations


def facts_stated_twice(folder: Path) -> dict[str, list[str]]:
    """Return locations of facts that belong elsewhere, by kind of fact."""
    from rocking.quantities import is_named

    scripts = [path for path in sorted(folder.rglob("*.js")) if "vendor" not in path.parts]
    modules = trees(folder)
    return {
        "keys of answers that quantities.py does not name": [
            f"{location} {key}" for key, location in keys_of_answers(modules).items() if not is_named(key)
        ],
        "modules and scripts that declare the width of a block": widths(modules, scripts),
        "sentences of ours that are read back": sentences_read(modules),
        "strings that name modules": modules_named(modules),
    }


def options() -> dict[str, list[str]]:
    """Return the options of each command, by its name."""
    import typer

    from rocking.cli.application import application

    by_command: dict[str, list[str]] = {}

    def collect(command: Any, name: str) -> None:
        if hasattr(command, "commands"):
            for key, subcommand in command.commands.items():
                collect(subcommand, f"{name} {key}".strip())
        else:
            by_command[name] = [
                parameter.opts[-1] for parameter in command.params if parameter.param_type_name == "option"
            ]

    collect(typer.main.get_command(application()), "")
    return by_command


def deep_imports(folder: Path) -> tuple[int, int]:
    """Return the number of test files with imports of inner modules, and the number of these modules."""
    modules = trees(SOURCE)
    faces = {name for name in modules if _is_package(name, modules) or name.count(".") < 2}
    deep: dict[str, set[str]] = defaultdict(set)
    for name, tree in trees(folder).items():
        for node in nodes(tree):
            names = (
                [node.module or ""] if isinstance(node, ast.ImportFrom)
                else [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            )  # fmt: skip
            deep[name].update(module for module in names if module in modules and module not in faces)
    imported = {name: deep_modules for name, deep_modules in deep.items() if deep_modules}
    return len(imported), len(set().union(*imported.values()) if imported else ())


def equations_cited(rooms: tuple[str, ...]) -> tuple[int, int]:
    """Return the number of citations in the comments of packages, and the number of cited equations."""
    paths = [path for room in rooms for path in (SOURCE / room).rglob("*.py")]
    comments = [comment for path in paths for comment in text_of_comments(path.name, path.read_text("utf-8"))]
    ours, paper = cited(comments)
    return len(ours) + len(paper), len(set(ours)) + len(set(paper))


def measures() -> list[Measure]:
    """Return every line of the table."""
    import rocking

    every, code, docstrings = lines(SOURCE)
    kinds = classes(SOURCE)
    arrows = imports(SOURCE)
    twice = sorted(name for name, count in kinds.items() if count > 1)
    loops, up = circles(arrows), upward(arrows)
    spoken, choices, stated = options(), choices_of_mechanics(SOURCE), facts_stated_twice(SOURCE)
    distinct = {option for names in spoken.values() for option in names}
    tests = lines(TESTS)[0]
    files, inner = deep_imports(TESTS)
    count = len(trees(SOURCE))
    counts = [
        ("lines of Python under src", every, 60_000),
        ("lines of code", code, 36_000),
        ("lines of docstrings", docstrings, 13_000),
        ("files", count, 400),
        ("classes", sum(kinds.values()), 420),
        (f"class names defined twice ({', '.join(twice) or 'none'})", len(twice), 0),
        ("circles, lazy ones too", len(loops), 0),
        ("arrows upward", len(up), 0),
        *(
            (f"outside the choice of mechanics: {description}", len(places), 0)
            for description, places in choices.items()
        ),
        *((description, len(places), 3 if "width" in description else 0) for description, places in stated.items()),
        ("names in rk", len(rocking.__all__), 32),
        ("options of rocking simulate", len(spoken["simulate"]), 22),
        ("distinct options", len(distinct), 55),
        *((f"files passed: {description}", passed, most) for description, passed, most in files_passed()),
        ("lines of tests", tests, 36_000),
        (f"test files that import inner modules ({inner} of them)", files, 100),
    ]
    table = [Measure(description, f"{value:,}", f"<= {most:,}", value <= most) for description, value, most in counts]
    citations, equations = equations_cited(("dynamics", "statistics", "studies"))
    table.append(
        Measure(
            f"equations cited in dynamics and studies, statistics too ({equations} different)",
            f"{citations:,}",
            "every one computed",
            citations > 0,
        )
    )
    for loop in loops:
        print("circle:", " ".join(loop))
    for description, places in (choices | stated).items():
        print(*(f"{description}: {location}" for location in places), sep="\n", end="\n" if places else "")
    for module, other in up:
        print(f"upward: {module} -> {other}")
    return table


def main() -> bool:
    """Print the table; whether every goal was met."""
    version = subprocess.run(
        ["git", "rev-parse", "--short", "HEAD"], cwd=ROOT, capture_output=True, text=True, check=False
    ).stdout.strip()
    print(f"The house at {version or 'an unnamed state'}\n\n| measure | measured | goal | |\n|---|---|---|---|")
    results = measures()
    for result in results:
        print(f"| {result.what} | {result.measured} | {result.goal} | {'met' if result.met else 'missed'} |")
    return all(result.met for result in results)
