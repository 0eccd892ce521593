"""Claims of the tests, from their marks: the directive `claims` and the roles `claim` and `stated` of docs/verified.md.

The claim of a test is the first paragraph of its docstring. Its mark, or the mark of its file, contains the method:
``@pytest.mark.verifies(kind, against, within=..., control=..., doi=..., room=...)``. Files are parsed and nothing is
run. With ``build/tests-*.xml`` the tables contain the deviations of the last ``make test-all``. `faults` lists
incorrect marks, and tests/unit/test_verified.py checks that there are none.
"""

import ast
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any, ClassVar
from xml.etree import ElementTree

from docutils import nodes
from docutils.parsers.rst import directives
from sphinx.application import Sphinx
from sphinx.errors import ExtensionError
from sphinx.util.docutils import SphinxDirective, SphinxRole

ROOT = Path(__file__).parents[2]
RUNS = tuple(f"build/tests-{tier}.xml" for tier in ("quick", "slow", "workbench"))
TESTS = ("tests", "workbench/tests")
ALL_MARKED = ("verification", "validation")  # folders whose tests all need a mark
KINDS = {
    "closed form": "an exact solution, a limit of it or a series of it",
    "computed anew": "the same number by an independent method: quadrature, a general integrator, computer algebra,"
    " exact fractions, sums over points, reference numbers",
    "order": "decrease of the error with the declared power of the step",
    "invariant": "conserved or irrelevant quantities: energy, mirror images, size, units, position",
    "second engine": "two engines for the same mechanics, which share only the input values",
    "other program": "programs of other authors: rigid-body programs, programs that read our files",
    "published": "numbers of the literature",
    "measured": "measured coefficients of restitution",
    "repeated sampling": "coverage of intervals and distribution of samples",
    "same bits": "identical results in all digits, independent of computer, chunks and interruptions",
    "damage": "refusal of damaged, hostile or meaningless input; no loss after an interruption",
    "behaviour": "behaviour in a stated situation",
    "negative control": "a deliberate error that the test must detect",
}
ROOMS = (
    "bodies", "motions and records", "restitution in the plane", "restitution in space", "contact bed",
    "rocking in the plane", "sliding, hopping and flight", "rocking in space", "statistics", "studies", "campaigns",
    "evidence", "doors", "benchmarks",
)  # fmt: skip
NEEDS_NO_REFERENCE = {"behaviour", "damage", "negative control"}


# ---- marks ----------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Claim:
    """Claim of a test; `control` is the test of its file that must fail otherwise, or "within"."""

    path: str
    test: str
    description: str
    kind: str = ""
    against: str = ""
    within: str = ""
    control: str = ""
    doi: str = ""
    room: str = ""
    unknown: tuple[str, ...] = ()
    numbers: frozenset[float] = field(default=frozenset(), repr=False)  # in the test or outside of all tests


@cache
def claims(root: Path = ROOT) -> list[Claim]:
    """Return the claims of all marked tests, and of tests without a required mark."""
    marked = []
    for path in (path for folder in TESTS for path in sorted((root / folder).rglob("test_*.py"))):
        marked += claims_of(path.read_text("utf-8"), path.relative_to(root).as_posix())
    return marked


def claims_of(source: str, path: str) -> list[Claim]:
    """Return the claims of one file."""
    tree = ast.parse(source)
    tests = [node for node in tree.body if isinstance(node, ast.FunctionDef) and node.name.startswith("test_")]
    others = [node for node in tree.body if node not in tests]
    of_file: dict[str, str] = {}
    for node in others:
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "pytestmark":
            of_file |= _mark(node.value)
    shared, marked = _numbers(others), []
    for test in tests:
        own = {key: value for call in test.decorator_list for key, value in _mark(call).items()}
        if not own and not of_file.get("kind") and path.partition("tests/")[2].split("/")[0] not in ALL_MARKED:
            continue
        description = " ".join((ast.get_docstring(test) or "").split("\n\n")[0].split())
        marks = {key: of_file[key] for key in of_file if key == "room" or "kind" not in own} | own
        known_fields = {
            key: marks.pop(key) for key in ("kind", "against", "within", "control", "doi", "room") if key in marks
        }
        marked.append(
            Claim(path, test.name, description, **known_fields, unknown=tuple(marks), numbers=shared | _numbers([test]))
        )
    return marked


def _mark(node: ast.expr) -> dict[str, str]:
    for call in ast.walk(node):
        if isinstance(call, ast.Call) and ast.unparse(call.func) == "pytest.mark.verifies":
            values = zip(("kind", "against"), map(ast.literal_eval, call.args), strict=False)
            return dict(values) | {str(word.arg): ast.literal_eval(word.value) for word in call.keywords}
    return {}


def _numbers(roots: list[Any]) -> frozenset[float]:
    """Return the numbers in code, including numeric texts."""
    values = [constant.value for node in roots for constant in ast.walk(node) if isinstance(constant, ast.Constant)]
    plain = [value for value in values if isinstance(value, int | float) and not isinstance(value, bool)]
    return frozenset(map(float, plain)) | {float(v) for v in values if isinstance(v, str) and v.isdecimal()}


def faults(marked: list[Claim]) -> list[str]:
    """Return the faults of marks."""
    wrong = []
    for path in dict.fromkeys(claim.path for claim in marked):
        here = [claim for claim in marked if claim.path == path]
        kinds = {claim.test: claim.kind for claim in here}
        wrong += [f"{path}::{claim.test} {fault}" for claim in here for fault in _faults(claim, kinds)]
    return wrong


def _faults(claim: Claim, kinds: dict[str, str]) -> Iterator[str]:
    if not claim.kind:
        yield "has no mark that says what it verifies"
        return
    if not claim.description:
        yield "does not say in its docstring what it proves"
    if claim.kind not in KINDS:
        yield f"is of the unknown kind {claim.kind!r}"
    if claim.room not in ROOMS:
        yield f"is of the unknown room {claim.room!r}"
    if not claim.against and claim.kind not in NEEDS_NO_REFERENCE:
        yield "does not say against what"
    yield from (f"has the unknown word {name!r} in its mark" for name in claim.unknown)
    if claim.doi and not re.fullmatch(r"10\.\d{4,9}/[^\s<>]+", claim.doi):
        yield f"has the malformed DOI {claim.doi!r}"
    for number in figures(claim.within):
        # of a per cent, a thousandth, a million
        if not any(number * unit in claim.numbers for unit in (1.0, 1e-2, 1e-3, 1e6)):
            yield f"states {number:g} in its mark, which does not stand in the test"
    if claim.control not in {"", "within"} and kinds.get(claim.control) != "negative control":
        yield f"names the control {claim.control!r}, which is no negative control of its file"


def figures(text: str) -> list[float]:
    """Return the numbers in a text, except zero."""
    numbers = [float(word.replace(",", "")) for word in re.findall(r"\d[\d,]*(?:\.\d+)?(?:e-?\d+)?", text)]
    return [number for number in numbers if number]


# ---- results of the last run -----------------------------------------------------------------------------------------


@dataclass
class Outcome:
    """Cases of a test in the last run, and the largest deviation that it recorded."""

    passed: int = 0
    failed: int = 0
    skipped: int = 0
    measured: float | None = None


@cache
def outcomes(root: Path = ROOT) -> tuple[dict[tuple[str, str], Outcome], str]:
    """Return the results per test and the date of the files of pytest's ``--junitxml``; nothing without a file."""
    by_test: dict[tuple[str, str], Outcome] = {}
    trees = [ElementTree.parse(root / run).getroot() for run in RUNS if (root / run).exists()]
    for case in (case for tree in trees for case in tree.iter("testcase")):
        key = case.get("classname", "").replace(".", "/") + ".py", case.get("name", "").partition("[")[0]
        outcome = by_test.setdefault(key, Outcome())
        tags = {node.tag for node in case}
        outcome.failed += bool(tags & {"failure", "error"})
        outcome.skipped += "skipped" in tags
        outcome.passed += not tags & {"failure", "error", "skipped"}
        for recorded in case.iter("property"):
            if recorded.get("name") == "deviation":
                outcome.measured = max(outcome.measured or 0.0, float(recorded.get("value", "nan")))
    return by_test, max((next(tree.iter("testsuite")).get("timestamp", "")[:10] for tree in trees), default="")


def how_closely(claim: Claim) -> str:
    """Return tolerance, measured deviation, and failures."""
    outcome = outcomes()[0].get((claim.path, claim.test), Outcome())
    parts = [claim.within] if claim.within else []
    parts += [] if outcome.measured is None else [f"measured {outcome.measured:.2g}"]
    parts += [f"failed in {outcome.failed} cases"] if outcome.failed else []
    parts += ["skipped in the last run"] if outcome.skipped and not outcome.passed else []
    return "; ".join(parts)


# ---- figures that files of this project state -----------------------------------------------------------------------

ENGINE, SPATIAL, MUTANTS = (f"benchmarks/RESULTS-{name}.md" for name in ("engine", "spatial", "mutants"))
STATED = {
    "histories": (ENGINE, r"\| Verdicts of ([\d,]+) histories \| reference engine"),
    "verdicts": (ENGINE, r"\| Verdicts of [\d,]+ histories \| reference engine \| (.+?) \|"),
    "verdicts of MuJoCo": (ENGINE, r"\| MuJoCo, [^|]*\| [^|]*; ([\d,]+ of [\d,]+) verdicts wrong"),
    "verdicts of pymunk": (ENGINE, r"\| pymunk, [^|]*\| [^|]*; ([\d,]+ of [\d,]+) verdicts wrong"),
    "verdicts of DOP853": (ENGINE, r"DOP853 with events, [^|]*\| [^|]*; ([\d,]+ of [\d,]+) verdicts wrong"),
    "verdicts of numba": (ENGINE, r"\| numba RK4, 2 substeps \| [^|]*; ([\d,]+ of [\d,]+) verdicts wrong"),
    "verdicts of diffrax": (ENGINE, r"\| diffrax [^|]*\| [^|]*; ([\d,]+ of [\d,]+) verdicts wrong"),
    "errors": (MUTANTS, r"drawn later: of (\d+) errors judged"),
    "errors noticed": (MUTANTS, r"drawn later: of \d+ errors judged, (\d+) noticed"),
    "errors without effect": (MUTANTS, r"drawn later: [^.]*? and (\d+) that change no result"),
    "share noticed": (MUTANTS, r"drawn later: [^.]*? that change no result, (\S+ \([^)]+\))"),
    "first errors": (MUTANTS, r"\| all \| [\d,]+ \| (\d+) \|"),
    "first share": (MUTANTS, r"before them, \d+ were noticed: (\S+ \([^)]+\))"),
    "damaged copies": ("tests/verification/test_fuzz_readers.py", r'"ROCKING_FUZZ", "(\d+)"'),
    "more damaged copies": ("Makefile", r"ROCKING_FUZZ=(\d+)"),
    "kills": ("tests/verification/test_campaign_durability.py", r'"ROCKING_KILLS", "(\d+)"'),
    "more kills": ("Makefile", r"ROCKING_KILLS=(\d+)"),
}
"""Figures by name: the file that states each, and where in it."""


def stated(name: str) -> str:
    """Return a figure where it is stated, or counted."""
    if name in COUNTED:
        return COUNTED[name]()
    path, pattern = STATED[name]
    match = re.search(pattern, (ROOT / path).read_text("utf-8"))
    if match is None:
        raise LookupError(f"docs/_ext/verified.py looks for the {name} in {path}, which no longer says them")
    return f"{int(match[1]):,}" if match[1].isdecimal() else match[1]


def _peer(name: str, word: str) -> str:
    """Return the number of 3D cases in which another program agrees or differs."""
    rows = re.findall(rf"^\|  \| {name} \|.*\| (agrees|differs)[^|]*\|$", (ROOT / SPATIAL).read_text("utf-8"), re.M)
    if not rows:
        raise LookupError(f"{SPATIAL} has no cases of {name}")
    return str(Counter(rows)[word])


def _settings() -> str:
    return str(
        len(re.findall(r'^        ("[^"]+"|[A-Z_0-9]+): \{', (ROOT / "tests/portable.py").read_text("utf-8"), re.M))
    )


def _records() -> str:
    trees = (ast.parse(path.read_text("utf-8")) for path in (ROOT / "tests").rglob("test_*.py"))
    functions = (node for tree in trees for node in ast.walk(tree) if isinstance(node, ast.FunctionDef))
    return str(sum("shared_records" in [argument.arg for argument in node.args.args] for node in functions))


def _errata() -> str:
    from rocking.evidence import errata

    return str(sum(erratum.is_confirmed for erratum in errata()))


def _verdicts() -> str:
    from rocking.evidence import claims as of_the_paper

    counts = Counter(claim.verdict for claim in of_the_paper())
    return f"of {counts.total()} claims " + ", ".join(f"{count} {verdict}" for verdict, count in counts.most_common())


def _measured() -> str:
    from rocking.evidence import all_measurements

    return str(all_measurements().slenderness.size)


def _error(name: str) -> str:
    """Root mean square error of a model over the measurements."""
    import numpy as np

    from rocking.evidence import all_measurements
    from rocking.restitution import model

    rows = all_measurements()
    return f"{np.sqrt(np.mean((model(name).of_slenderness(rows.slenderness) - rows.coefficient) ** 2)):.3f}"


def _without_measurement() -> str:
    measured = {claim.room for claim in claims() if claim.kind == "measured"}
    return "; ".join(
        room for room in ROOMS if "rocking" in room or "hopping" in room or "space" in room if room not in measured
    )


def _run() -> str:
    found, day = outcomes()
    if not day:
        return "The results of a test run are not available, so the tables contain the tolerances only."
    passed, failed, skipped = (sum(getattr(o, n) for o in found.values()) for n in ("passed", "failed", "skipped"))
    return (
        f"The measured deviations are from the test run of {day}: {passed:,} cases passed, {failed:,} failed, and"
        f" {skipped:,} were skipped because a program or a file was missing."
    )


COUNTED = {
    "claims": lambda: f"{len(claims()):,}",
    "controlled": lambda: str(sum(bool(claim.control) for claim in claims())),
    "agree MuJoCo": lambda: _peer("MuJoCo", "agrees"),
    "differ MuJoCo": lambda: _peer("MuJoCo", "differs"),
    "agree Bullet": lambda: _peer("Bullet", "agrees"),
    "differ Bullet": lambda: _peer("Bullet", "differs"),
    "settings": _settings,
    "tests with records": _records,
    "errata": _errata,
    "claims of the paper": _verdicts,
    "measurements": _measured,
    "error of housner": lambda: _error("housner"),
    "error of ked": lambda: _error("ked"),
    "error of horizontal-momentum": lambda: _error("horizontal-momentum"),
    "rooms without measurement": _without_measurement,
    "last run": _run,
}
"""Figures by name that are counted here."""


# ---- for the page ---------------------------------------------------------------------------------------------------


def table(look: str, head: list[str], rows: list[list[list[nodes.Node] | str]], widths: list[int]) -> nodes.table:
    """Return a table of texts or nodes, in the style of manual.css."""
    group = nodes.tgroup(cols=len(head))
    group += [nodes.colspec(colwidth=width) for width in widths]
    group += nodes.thead("", _line(head))
    group += nodes.tbody("", *map(_line, rows))
    return nodes.table("", group, classes=[look])


def _line(cells: Sequence[list[nodes.Node] | str]) -> nodes.row:
    filled = [[nodes.Text(cell)] if isinstance(cell, str) else cell for cell in cells]
    return nodes.row("", *(nodes.entry("", nodes.paragraph("", "", *cell)) for cell in filled))


def text_nodes(text: str) -> list[nodes.Node]:
    """Words of a docstring, with code between backticks."""
    pieces = enumerate(re.split(r"`+", text))
    return [nodes.literal(piece, piece) if k % 2 else nodes.Text(piece) for k, piece in pieces if piece]


def row(claim: Claim) -> list[list[nodes.Node] | str]:
    """Return the row of a claim: text and test, reference, tolerance, control."""
    where = f"{claim.path.removeprefix('tests/')}::{claim.test}"
    test = nodes.literal(where, where, ids=[nodes.make_id(where)])
    against = [
        nodes.strong(claim.kind, claim.kind),
        nodes.Text(": " if claim.against else ""),
        *text_nodes(claim.against),
    ]
    if claim.doi:
        address = f"https://doi.org/{claim.doi}"
        link = nodes.reference(address, f"doi:{claim.doi}", refuri=address, internal=False)
        against += [nodes.Text(" ("), link, nodes.Text(")")]
    control: list[nodes.Node] = [nodes.Text("in the test")] if claim.control == "within" else []
    if claim.control.startswith("test_"):
        anchor = nodes.make_id(where.removesuffix(claim.test) + claim.control)
        control = [nodes.reference("", "another test", refid=anchor, internal=True)]
    return [[*text_nodes(claim.description), nodes.Text(" "), test], against, how_closely(claim), control]


class Claims(SphinxDirective):
    """Tables of claims: of one subject, or the counts of all subjects."""

    option_spec: ClassVar = {"room": directives.unchanged_required}

    def run(self) -> list[nodes.Node]:
        """Return a table."""
        for path in {claim.path for claim in claims()}.union(RUNS):
            self.env.note_dependency(str(ROOT / path))
        if "room" in self.options:
            here = [claim for claim in claims() if claim.room == self.options["room"]]
            here.sort(key=lambda claim: (list(KINDS).index(claim.kind), claim.path))
            head = ["claim and test", "reference", "tolerance", "negative control"]
            return [table("claims", head, [row(claim) for claim in here], [45, 25, 15, 15])]
        by_kind = Counter((claim.room, claim.kind) for claim in claims())
        count = Counter(claim.kind for claim in claims())
        kinds = table(
            "kinds", ["kind", "tests", "meaning"], [[k, str(count[k]), w] for k, w in KINDS.items()], [20, 10, 70]
        )
        rows = [
            [room, *(str(by_kind[room, k] or "") for k in KINDS), str(sum(by_kind[room, k] for k in KINDS))]
            for room in ROOMS
        ]
        return [kinds, table("counts", ["subject", *KINDS, "all"], rows, [20] + [6] * (len(KINDS) + 1))]


class ClaimRole(SphinxRole):
    """One claim as a sentence, by FILE::TEST, with its tolerance."""

    def run(self) -> tuple[list[nodes.Node], list[nodes.system_message]]:
        """Return description, figure and test."""
        (claim,) = [marked for marked in claims() if f"{marked.path.rpartition('/')[2]}::{marked.test}" == self.text]
        figure = f"tolerance {how_closely(claim)}; " if claim.within else ""
        plain = claim.description.removeprefix("REF: ").rstrip(".")
        sentence = nodes.Text(f"{plain[:1].upper()}{plain[1:]} ({figure}")
        return [sentence, nodes.literal(claim.path, claim.path.removeprefix("tests/")), nodes.Text(")")], []


class Stated(SphinxRole):
    """A figure by its name."""

    def run(self) -> tuple[list[nodes.Node], list[nodes.system_message]]:
        """Return the figure."""
        return [nodes.Text(stated(self.text))], []


def setup(app: Sphinx) -> dict[str, bool]:
    """Register with Sphinx; wrong marks end the build here, since a later failure can leave kernels running."""
    if wrong := faults(claims()):
        raise ExtensionError("\n".join(wrong))
    app.add_directive("claims", Claims)
    app.add_role("claim", ClaimRole())
    app.add_role("stated", Stated())
    return {"parallel_read_safe": True, "parallel_write_safe": True}
