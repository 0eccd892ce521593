"""Deliberate errors in the numerical core, and the number that the tests detect: `make mutants`.

A random sample of the mutations of Cosmic Ray's operators that keep a program meaningful (arithmetic, numbers,
comparisons, signs, conditions, loops), each with the tests of its line, the most likely and fastest first, for 90
seconds; and the hand-made errors of mutants.toml. A later run continues: every result is a line in build/mutants/. A
sample of some packages (--packages) uses the tests in mutants.toml for each.
"""

import argparse
import ast
import hashlib
import json
import math
import os
import re
import shlex
import shutil
import subprocess
import sys
import time
import tomllib
from collections import Counter, defaultdict
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor, as_completed
from functools import cache
from pathlib import Path
from queue import SimpleQueue
from typing import Any, NamedTuple

from cosmic_ray.ast import ast_nodes, get_ast
from cosmic_ray.mutating import mutate_code
from cosmic_ray.plugins import get_operator

from benchmarks import table
from benchmarks.mutant_tests import ROOT, Covering, record

CORE = {
    "bodies": ("bodies/*.py", "bodies/solid/*.py", "bodies/solid/repair/*.py"),
    "restitution": ("restitution/*.py", "restitution/space/*.py"),
    "plane": ("dynamics/*.py",),
    "contact": ("dynamics/plane_frictional/*.py",),
    "space": ("dynamics/rolling/*.py", "dynamics/rolling/batch/*.py"),
    "contact bed": ("restitution/bed/*.py",),
    "motions": ("motions/*.py", "motions/synthetic/*.py"),
    "readers": ("motions/formats/*.py",),
    "fragility": ("statistics/*.py", "studies/fragility/*.py"),
    "evidence": ("evidence/*.py",),
    "hull": ("dynamics/frictional/*.py",),
    "prediction": ("decision/prediction/*.py",),
    "identification": ("identification/*.py", "identification/readers/*.py"),
    "code methods": ("decision/code_methods/*.py",),
    "equilibria": ("bodies/equilibria/*.py",),
    "floors": ("motions/floors.py",),
}
NOT_NUMERICAL = ("export", "nrml", "lines.py", "tables.py", "words.py", "__init__")

_SWAPS = (
    "Add_Sub",
    "Sub_Add",
    "Mul_Div",
    "Div_Mul",
    "Pow_Mul",
    "FloorDiv_Div",
    "Mod_Mul",
    "BitAnd_BitOr",
    "BitOr_BitAnd",
)
_RELATIONS = (
    "Eq_NotEq",
    "NotEq_Eq",
    "Lt_LtE",
    "Lt_Gt",
    "LtE_Lt",
    "LtE_Gt",
    "Gt_GtE",
    "Gt_Lt",
    "GtE_Gt",
    "GtE_Lt",
    "Is_IsNot",
    "IsNot_Is",
)
OPERATORS = (
    *(f"core/ReplaceBinaryOperator_{swap}" for swap in _SWAPS),
    *(f"core/ReplaceComparisonOperator_{relation}" for relation in _RELATIONS),
    *(f"core/ReplaceUnaryOperator_{change}" for change in ("Delete_USub", "Delete_Not", "Delete_Invert")),
    *(f"core/Replace{change}" for change in ("AndWithOr", "OrWithAnd", "TrueWithFalse", "FalseWithTrue")),
    *(f"core/{change}" for change in ("NumberReplacer", "AddNot", "ReplaceBreakWithContinue", "ZeroIterationForLoop")),
)
STAGES = (4.0, 15.0, 90.0)  # seconds of tests: most errors die in the first
ENGINE_LIMIT = 900.0  # seconds for the tests of an engine
PAGE = "RESULTS-mutants.md"
HANGS = 3.0  # a mutant that takes this many times the processor's time that the tests take under coverage hangs


class Mutant(NamedTuple):
    """One deliberate error."""

    package: str
    path: str
    operator: str
    occurrence: int
    first: int
    last: int

    @property
    def key(self) -> str:
        """Name in the ledger; a changed file is judged again."""
        seal = hashlib.sha256((ROOT / self.path).read_bytes()).hexdigest()[:8]
        return f"{self.path}:{self.first} {self.operator} {self.occurrence} {seal}"

    @property
    def lines(self) -> range:
        """Its lines."""
        return range(self.first, self.last + 1)

    def code(self) -> str:
        """The module with the error in it."""
        mutated = mutate_code(
            (ROOT / self.path).read_text(encoding="utf-8"), get_operator(self.operator)(), self.occurrence
        )
        assert mutated is not None
        return str(mutated)

    def change(self) -> tuple[str, str]:
        """The first line that it changes, before and after."""
        old, new = (ROOT / self.path).read_text(encoding="utf-8").splitlines(), self.code().splitlines()
        return next((a.strip(), b.strip()) for a, b in zip([*old, ""], [*new, ""], strict=False) if a != b)


def mutants(package: str) -> list[Mutant]:
    """Return every meaningful mutation of a package, without annotations and messages."""
    drawn = []
    for path in sorted(path_ for pattern in CORE[package] for path_ in (ROOT / "src/rocking").glob(pattern)):
        if any(word in path.name for word in NOT_NUMERICAL):
            continue
        source = path.read_text(encoding="utf-8")
        quiet = set(_quiet_lines(ast.parse(source)))
        nodes = list(ast_nodes(get_ast(source)))
        for name in OPERATORS:
            operator = get_operator(name)()
            places = (position for node in nodes for position in operator.mutation_positions(node))
            for occurrence, (start, end) in enumerate(places):
                if start[0] not in quiet:
                    drawn.append(Mutant(package, str(path.relative_to(ROOT)), name, occurrence, start[0], end[0]))
    return drawn


def _quiet_lines(tree: ast.AST) -> Iterator[int]:
    """Lines of messages, annotations and decorators."""
    for node in ast.walk(tree):
        quiet: list[ast.AST | None] = []
        if isinstance(node, ast.Raise):
            quiet = [node.exc]
        elif isinstance(node, (ast.JoinedStr, ast.AnnAssign)) and not getattr(node, "value", None):
            quiet = [node]
        elif isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            quiet = [*node.decorator_list]
            if isinstance(node, ast.FunctionDef):
                every = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]
                quiet += [node.returns, *(argument.annotation for argument in every)]
        for annotation in filter(None, quiet):
            yield from range(annotation.lineno, (annotation.end_lineno or annotation.lineno) + 1)


def sample(seed: int, count: int, packages: list[str]) -> tuple[list[Mutant], dict[str, int]]:
    """Return equal numbers of mutants of every package, mixed, and the total number.

    Each mutant has a rank by seed, file, line and operator, and the first ranks are selected: another edit keeps them.
    """
    every, ranks = {}, {}
    for package in packages:
        candidates = mutants(package)
        every[package], position = len(candidates), Counter[str]()
        ranked = {}
        for mutant in candidates:
            line = _lines(mutant.path)[mutant.first - 1].strip()
            of = f"{seed} {mutant.path} {mutant.operator} {line}"
            ranked[mutant] = hashlib.sha256(f"{of} {position[of]}".encode()).hexdigest()
            position[of] += 1
        ranks |= dict(sorted(ranked.items(), key=lambda item: item[1])[:count])
    return sorted(ranks, key=lambda mutant: ranks[mutant]), every


@cache
def _lines(path: str) -> list[str]:
    return (ROOT / path).read_text(encoding="utf-8").splitlines()


class Worker:
    """A copy of the sources in which one error at a time is put."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        shutil.rmtree(folder, ignore_errors=True)
        skip = shutil.ignore_patterns("__pycache__")
        for name in ("src", "tests", "benchmarks", "engine", "examples", "docs", "requirements"):
            shutil.copytree(ROOT / name, folder / name, ignore=skip)
        for name in ("pyproject.toml", "CMakeLists.txt", "Makefile", "README.md", "CHANGELOG.md", "CITATION.cff"):
            shutil.copy2(ROOT / name, folder / name)
        # an installation that finds the sources where they stand would test those, without an error
        (folder / "sitecustomize.py").write_text(
            "import sys\nsys.meta_path[:] = [it for it in sys.meta_path if '_editable_' not in type(it).__module__]\n",
            encoding="utf-8",
        )
        env = os.environ | {
            "PYTHONPATH": os.pathsep.join([str(folder / "src"), str(folder)]),
            "OPENBLAS_NUM_THREADS": "1",
        }
        command = [sys.executable, "-c", "import rocking; print(rocking.__file__)"]
        output = subprocess.run(command, cwd=folder, env=env, check=True, capture_output=True, text=True).stdout
        if folder not in Path(output).parents:
            raise SystemExit(
                f"errors go into {folder}, and the tests import {output.strip()}: remove that installation"
            )
        command = [sys.executable, "-m", "benchmarks.mutant_server"]
        pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.DEVNULL}
        self._server = subprocess.Popen(command, cwd=folder, env=env, text=True, **pipes)
        self._writes, self._sound = 0, dict[str, bool]()

    def write(self, path: str, text: str) -> None:
        """Write a module with a time of its own, since compiled files are recognised by time and size."""
        target = self.folder / path
        target.write_text(text, encoding="utf-8")
        self._writes += 1
        os.utime(target, (2e9 + self._writes, 2e9 + self._writes))

    def fails(self, tests: list[str], limit: float) -> str:
        """Return the first failed test, or another failure; empty if all pass.

        The limit is CPU time [s]: the load of other processes has no effect.
        """
        if not tests:
            return ""
        listed = self.folder / "tests.txt"
        listed.write_text("\n".join(tests) + "\n", encoding="utf-8")
        assert self._server.stdin is not None
        assert self._server.stdout is not None
        print(listed, round(limit), file=self._server.stdin, flush=True)
        code, _, failed = self._server.stdout.readline().strip().partition(" ")
        return "" if code == "0" else failed or f"code {code}"

    def sound(self, test: str) -> bool:
        """Whether a test passes here without an error in the sources."""
        if test not in self._sound:
            self._sound[test] = not self.fails([test], 600.0)
            if not self._sound[test]:
                print(f"fails without an error too, and does not count: {test}", flush=True)
        return self._sound[test]


def staged(tests: list[str], durations: dict[str, float]) -> list[list[str]]:
    """Tests in batches of a few seconds, up to a limit for those that survive."""
    batches: list[list[str]] = [[] for _ in STAGES]
    spent, stage = 0.0, 0
    for test in tests:
        spent += durations[test]
        while stage < len(STAGES) and spent > STAGES[stage]:
            stage += 1
        if stage == len(STAGES):
            break
        batches[stage].append(test)
    return [batch for batch in batches if batch]


def verdict(mutant: Mutant, worker: Worker, covering: Covering, noticed: Counter[str]) -> dict[str, object]:
    """Return detection of a mutant, number of tests, and duration.

    Tests that detected other errors in the file come first.
    """
    began, text = time.monotonic(), (ROOT / mutant.path).read_text(encoding="utf-8")
    tests = covering.tests(mutant.path, mutant.lines)
    tests.sort(key=lambda test: -noticed[test])
    left, failed = staged(tests, covering.durations), ""
    while left and not failed:
        worker.write(mutant.path, mutant.code())
        failed = worker.fails(left[0], 20.0 + HANGS * sum(covering.durations[test] for test in left[0]))
        worker.write(mutant.path, text)
        if failed not in left[0] or worker.sound(failed):
            left.pop(0)
        else:  # it fails without the error too
            left[0], failed = [test for test in left[0] if test != failed], ""
    seconds = round(time.monotonic() - began, 1)
    entry = {"key": mutant.key, "killed": bool(failed), "by": failed, "of": len(tests), "seconds": seconds}
    return entry | {"tests": covering.seal(tests)}


def run(chosen: list[Mutant], folder: Path, workers: int, hours: float) -> dict[str, dict[str, object]]:
    """Judge mutants absent from the ledger, and survivors of changed tests, until the end of the time."""
    ledger, covering = folder / "verdicts.jsonl", Covering(folder, by_hand()["elsewhere"])
    lines = ledger.read_text(encoding="utf-8").splitlines() if ledger.exists() else []
    known: dict[str, dict[str, object]] = {}
    for entry in map(json.loads, lines):
        known[entry["key"]] = entry | {"first": known.get(entry["key"], {"first": entry["killed"]})["first"]}
    reasons = harmless()

    def stands(mutant: Mutant) -> bool:
        entry = known.get(mutant.key)
        if entry is None or entry["killed"]:
            return entry is not None
        if (mutant.path, mutant.change()[1]) in reasons:
            return True
        tests = covering.tests(mutant.path, mutant.lines)
        return bool(entry.get("tests") == covering.seal(tests))

    left = [mutant for mutant in chosen if not stands(mutant)]
    if not left:
        return known
    # new ones first: a survivor takes the longest
    left.sort(key=lambda mutant: mutant.key in known)
    free: SimpleQueue[Worker] = SimpleQueue()
    for number in range(workers):
        free.put(Worker(folder / f"worker-{number}"))
    stop = time.monotonic() + 3600.0 * hours
    noticed: dict[str, Counter[str]] = defaultdict(Counter)
    for entry in known.values():
        noticed[str(entry["key"]).partition(":")[0]][str(entry["by"])] += 1

    def judge(mutant: Mutant) -> dict[str, object] | None:
        if time.monotonic() > stop:
            return None
        worker = free.get()
        try:
            return verdict(mutant, worker, covering, noticed[mutant.path])
        finally:
            free.put(worker)

    with ThreadPoolExecutor(workers) as pool, ledger.open("a", encoding="utf-8") as out:
        for entry in filter(
            None, (future.result() for future in as_completed([pool.submit(judge, mutant) for mutant in left]))
        ):
            known[str(entry["key"])] = entry | {"first": known.get(str(entry["key"]), {}).get("first", entry["killed"])}
            noticed[str(entry["key"]).partition(":")[0]][str(entry["by"])] += 1
            out.write(json.dumps(entry) + "\n")
            out.flush()
            print(
                f"{len(known):5d} of {len(chosen)}  {'killed  ' if entry['killed'] else 'SURVIVED'}  {entry['key']}",
                flush=True,
            )
    return known


def engines(folder: Path, workers: int) -> list[tuple[str, str, bool]]:
    """The hand-made errors of the compiled engines: each built, and judged by the tests that its entry names."""
    entries, tests = by_hand()["engine"], by_hand()["tests"]
    ledger = folder / "engines.json"
    known: dict[str, bool] = json.loads(ledger.read_text(encoding="utf-8")) if ledger.exists() else {}
    left = [entry for entry in entries if entry["name"] not in known]

    def judge(entry: dict[str, str], worker: Worker) -> bool:
        target, text = worker.folder / entry["file"], (ROOT / entry["file"]).read_text(encoding="utf-8")
        target.write_text(text.replace(entry["old"], entry["new"]), encoding="utf-8")
        _build(worker.folder)
        failed = worker.fails(tests[entry["of"]], ENGINE_LIMIT)
        target.write_text(text, encoding="utf-8")
        return bool(failed)

    def judged(number: int) -> None:
        mine = left[number::workers]
        if not mine:
            return
        worker = Worker(folder / f"worker-engine-{number}")
        _build(worker.folder)
        for of in sorted({entry["of"] for entry in mine}):
            if failed := worker.fails(tests[of], ENGINE_LIMIT):
                raise SystemExit(f"fails without an error too: {failed}")
        for entry in mine:
            known[entry["name"]] = judge(entry, worker)
            ledger.write_text(json.dumps(known), encoding="utf-8")
            print(f"{'killed  ' if known[entry['name']] else 'SURVIVED'}  {entry['file']}: {entry['name']}", flush=True)

    with ThreadPoolExecutor(workers) as pool:
        list(pool.map(judged, range(workers)))
    return [(entry["file"], entry["name"], known[entry["name"]]) for entry in entries]


def planted(folder: Path) -> list[tuple[str, str, bool]]:
    """The hand-made errors in Python, each judged by the tests that its entry names."""
    entries, worker = by_hand()["python"], Worker(folder / "worker-planted")
    for tests in sorted({tuple(entry["tests"]) for entry in entries}):
        if failed := worker.fails(list(tests), ENGINE_LIMIT):
            raise SystemExit(f"fails without an error too: {failed}")
    verdicts = []
    for entry in entries:
        text = (ROOT / entry["file"]).read_text(encoding="utf-8")
        worker.write(entry["file"], text.replace(entry["old"], entry["new"]))
        verdicts.append((entry["file"], entry["name"], bool(worker.fails(entry["tests"], ENGINE_LIMIT))))
        worker.write(entry["file"], text)
    return verdicts


def _build(folder: Path) -> None:
    """Build the plain kernels, which have the bits of the others, less optimised."""
    tools = Path(sys.executable).parent
    options = [
        "-G",
        "Ninja",
        f"-DCMAKE_MAKE_PROGRAM={tools / 'ninja'}",
        "-DROCKING_INPLACE=ON",
        "-DROCKING_PLAIN=ON",
        "-DROCKING_OPTIMISATION=-O2",
        f"-DPython_EXECUTABLE={sys.executable}",
    ]
    for command in (["-S", ".", "-B", "build/engine", *options], ["--build", "build/engine"]):
        subprocess.run([str(tools / "cmake"), *command], cwd=folder, check=True, stdout=subprocess.DEVNULL)


@cache
def by_hand() -> dict[str, Any]:
    """Return the tables of mutants.toml; refuse a hand-made error whose old text is not exactly once in its file."""
    tables = tomllib.loads((Path(__file__).parent / "mutants.toml").read_text(encoding="utf-8"))
    for entry in [*tables["engine"], *tables["python"]]:
        count = (ROOT / entry["file"]).read_text(encoding="utf-8").count(entry["old"])
        if count != 1:
            raise SystemExit(f"mutants.toml: {entry['name']}: {entry['file']} has {entry['old']!r} {count} times")
    return tables


def harmless() -> dict[tuple[str, str], str]:
    """Why an error changes no result, by file and wrong line."""
    return {(entry["file"], entry["line"]): str(entry["why"]) for entry in by_hand().get("survivor", [])}


def wilson(killed: float, count: int) -> tuple[float, float]:
    """Return the 95 % interval of a fraction (Wilson 1927, doi:10.1080/01621459.1927.10502953)."""
    z = 1.959964
    share, spread = killed / count, z * z / count
    half = z * math.sqrt(share * (1.0 - share) / count + spread / (4.0 * count))
    return tuple((share + spread / 2.0 + sign * half) / (1.0 + spread) for sign in (-1.0, 1.0))  # type: ignore[return-value]


def page(
    chosen: list[Mutant],
    every: dict[str, int],
    known: dict[str, dict[str, object]],
    made: list[tuple[str, str, bool]],
    command: str,
    *,
    whole: bool,
) -> bool:
    """Print and store the scores and all survivors; return True if the lower end of the score is at least 85 %.

    The score excludes equivalent mutants: survivors with a reason in mutants.toml (Jia and Harman 2011,
    doi:10.1109/TSE.2010.62).
    """
    reasons = harmless()
    judged = [mutant for mutant in chosen if mutant.key in known]
    survivors = {mutant: mutant.change() for mutant in sorted(judged) if not known[mutant.key]["killed"]}
    same_results = {mutant for mutant, (_, new) in survivors.items() if (mutant.path, new) in reasons}
    heading = "# Deliberate errors" if whole else f"## Deliberate errors in {', '.join(every)}"
    text = [
        heading,
        "",
        f"Made by `{command}`.",
        "",
        "| package | mutations | judged | noticed | change no result | noticed of the others | 95 % |",
        "|---|---|---|---|---|---|---|",
    ]
    low = 0.0
    for package in (*every, "all"):
        of = [mutant for mutant in judged if package in {mutant.package, "all"}]
        killed, same = len(of) - sum(mutant in survivors for mutant in of), sum(mutant in same_results for mutant in of)
        if len(of) > same:
            low, high = wilson(killed, len(of) - same)
            count = sum(every.values()) if package == "all" else every[package]
            text.append(
                f"| {package} | {count:,} | {len(of)} | {killed} | {same} | {killed / (len(of) - same):.1%} "
                f"| {low:.1%} to {high:.1%} |"
            )
    first, same = sum(known[mutant.key]["first"] is True for mutant in judged), len(same_results)
    low_first, high_first = wilson(first, len(judged) - same)
    text += [
        "",
        "Tests were written for errors of this sample that nothing had noticed. As each was judged first, before them, "
        f"{first} were noticed: {first / (len(judged) - same):.1%} ({low_first:.1%} to {high_first:.1%}) of those that "
        "change a result. Another seed takes another sample.",
    ]
    text += ["", "Survivors, with the reason where they change no result:", ""]
    for mutant, (old, new) in survivors.items():
        text.append(f"- `{mutant.path}`: `{old}` -> `{new}`: {reasons.get((mutant.path, new), 'not noticed')}")
    if made:
        text += ["", f"By hand: {sum(entry[2] for entry in made)} of {len(made)} noticed.", ""]
        text += [f"- {file}: {name}: {'noticed' if killed else 'SURVIVED'}" for file, name, killed in made]
    # the page of all packages comes first, then one part per sample of some packages
    first_part, *others = re.split(r"(?m)^(?=## )", (Path(__file__).parent / PAGE).read_text(encoding="utf-8"))
    others = [section for section in others if not section.startswith(heading + "\n")]
    parts = ["\n".join(text), *others] if whole else [first_part, *others, "\n".join(text)]
    table.keep(PAGE, "\n\n".join(section.strip() for section in parts).splitlines())
    return low >= 0.85


def main() -> None:
    """Sample, judge, report; leave with 1 if the score is too low."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.mutants", description="Deliberate errors, and which are noticed."
    )
    parser.add_argument("--seed", type=int, default=2024)
    parser.add_argument("--count", type=int, default=105, help="mutations of each package")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--hours", type=float, default=3.0, help="stop after this; the next call goes on")
    parser.add_argument("--packages", nargs="+", choices=CORE, metavar="NAME", help=f"of {', '.join(CORE)} [all]")
    parser.add_argument("--no-engines", action="store_true", help="leave out the compiled engines")
    parser.add_argument(
        "--forks", type=float, metavar="SECONDS", help="judge in forks first, each by tests of so many seconds"
    )
    options = parser.parse_args()
    folder = ROOT / "build/mutants"
    folder.mkdir(parents=True, exist_ok=True)
    packages = options.packages or list(CORE)
    record(folder, [test for name in options.packages or () for test in by_hand()["tests"][name]], options.workers)
    chosen, every = sample(options.seed, options.count, packages)
    hand_made = [] if options.no_engines else engines(folder, options.workers)
    if options.forks:
        numbers = map(str, (options.seed, options.count, options.forks))
        command = [sys.executable, "-m", "benchmarks.mutant_forks", *numbers, *packages]
        subprocess.run(command, cwd=ROOT, check=True)
    judged = run(chosen, folder, options.workers, options.hours)
    hand_made += planted(folder)
    command = f"python -m benchmarks.mutants --seed {options.seed} --count {options.count}"
    if options.packages:
        command += (
            f" --forks {options.forks:g}" * bool(options.forks)
            + f" --no-engines --packages {shlex.join(options.packages)}"
        )
    raise SystemExit(not page(chosen, every, judged, hand_made, command, whole=not options.packages))


if __name__ == "__main__":
    main()
