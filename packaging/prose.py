"""Check the English of manual, messages, docstrings and comments, and the names in the code. `make lint` runs it.

`python packaging/prose.py [PATH ...]` lists every hit in files or folders; `--counts` prints the counts, `--keep`
stores those that fell. Without options, the counts are compared with `packaging/prose.json`, and none may rise.
"""

import argparse
import ast
import io
import json
import re
import sys
import tokenize
from collections import Counter
from collections.abc import Iterable, Iterator
from os.path import relpath
from pathlib import Path
from typing import NamedTuple

from babel.messages.pofile import read_po
from proselint.checks import archaism, redundancy, uncomparables, weasel_words
from proselint.registry.checks import Check
from proselint.registry.checks.types import ExistenceSimple

ROOT = Path(__file__).parents[1]
KEPT = ROOT / "packaging" / "prose.json"

CLAUSE = r"(?:what|how (?:far|much|many|often|long|it|a|an|the|this|one|each|sure|well)|of which|of whom)"
RULES = {
    "clause for a noun": rf"(?i)\b{CLAUSE}\b",
    "files that speak": r"(?i)\b(?:says?|said|tells?|told|asks|asked|knows?)\b",
    "private words": r"(?i)\b(?:shares?|least|anew|alike|beside|drawn|likeliest|halvings?|ways round)\b",
    "stand for appear": r"(?i)\b(?:stands?|stood)\b",
    "idiom": r"(?i)\b(?:let go|all the same|as it is|left aside|lean(?:s|ed|ing)?|once more|in line|at hand|by hand"
    r"|hangs on|gives way|too sure|brought to|so often|either way|goes on)\b",
    "chain of semicolons": r";[^.;\n]{3,}(?:\n[^.;\n]+)*;",
}
"""Rules of this project, as regular expressions; more of proselint are checked in the manual."""
PLAIN = re.compile(r"(?i)\bat least\b|\bleast[ -]squares\b")  # words in their usual meaning
CODE = re.compile(r"`[^`]*`|\{[^{}]*\}|\$[^$]*\$|https?://\S+|\[@[^\]]*\]")
FENCE = re.compile(r"^( *)(`{3,}|~{3,}|\${2}|:{3,}).*?^\1\2`*$|^---\n.*?^---$", re.M | re.S)

VAGUE = set(
    "each found some one place words told asked said known made given part what whole least wanted why rest".split()  # noqa: SIM905
)
"""Names that do not name a quantity, a role or an action; `part` is a name in modules that use the class `Part`."""
_NAME = r"\b(?:" + "|".join(VAGUE) + r")\b"
SCRIPT = re.compile(rf"(?:\b(?:const|let|var)\s+|[(,{{\[]\s*)({_NAME})(?=\s*(?:[=,)}}\]:]|of\b|in\b))")
ENGINE = re.compile(rf"(?:[\w>&*]\s+[&*]?)({_NAME})(?=\s*[=;,){{:\[(])")


class Hit(NamedTuple):
    """A place in a text that breaks a rule."""

    path: str
    line: int
    rule: str
    text: str


class Text(NamedTuple):
    """A text of one kind, with its first line in the file."""

    path: str
    line: int
    kind: str
    text: str


def texts(path: Path) -> Iterator[Text]:
    """Yield the texts of one file for readers: docstrings and comments, messages, paragraphs of a page."""
    name, source = relpath(path, ROOT), path.read_text("utf-8")
    if path.suffix == ".py":
        yield from _texts_of_python(name, source)
    elif path.suffix in {".js", ".hpp", ".cpp"}:
        for comment in re.finditer(r"(?<![:\"'])//[^\n]*|/\*.*?\*/", source, re.S):
            yield Text(name, source.count("\n", 0, comment.start()) + 1, "comments", comment[0])
    elif path.suffix == ".md":
        yield Text(name, 1, "manual", FENCE.sub(lambda block: "\n" * block[0].count("\n"), source))
    elif path.suffix == ".pot":
        for message in read_po(path.open("rb")):
            for text in [message.id] if isinstance(message.id, str) else message.id:
                yield Text(name, message.lineno or 1, "messages", text)


def _texts_of_python(name: str, source: str) -> Iterator[Text]:
    kinds = ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, kinds) and (docstring := ast.get_docstring(node, clean=False)):
            yield Text(name, node.body[0].lineno, "docstrings", docstring)
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type == tokenize.COMMENT and not re.match(r"#\s*(?:noqa|fmt:|type:|!|pragma|mypy:)", token.string):
            yield Text(name, token.start[0], "comments", token.string.split("# noqa")[0])


def names(path: Path) -> Iterator[tuple[int, str]]:
    """Yield line and name of each binding of a file; in scripts and C++ those of vague names alone."""
    source = path.read_text("utf-8")
    if path.suffix != ".py":
        pattern = SCRIPT if path.suffix == ".js" else ENGINE
        yield from ((source.count("\n", 0, hit.start(1)) + 1, hit[1]) for hit in pattern.finditer(source))
        return
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            yield node.lineno, node.id
        elif isinstance(node, ast.arg):
            yield node.lineno, node.arg


def _checks() -> list[Check]:
    ours = [Check(check_type=ExistenceSimple(pattern=rule), path=name, message="{}") for name, rule in RULES.items()]
    return ours + [
        check for module in (archaism, redundancy, uncomparables, weasel_words) for check in module.__register__
    ]


def hits(path: Path) -> Iterator[Hit]:
    """Yield the hits of all rules in one file."""
    checks = _checks()
    for text in texts(path):
        plain = CODE.sub(lambda code: "X" + "\n" * code[0].count("\n"), PLAIN.sub("X", text.text))
        for check in checks:
            if check.path not in RULES and text.kind != "manual":
                continue
            for result in check.check_with_flags(f"\n{plain}\n"):
                start = result.span[0] - 1
                yield Hit(
                    text.path, text.line + plain.count("\n", 0, max(start, 0)),
                    f"{text.kind}: {check.path.split('.')[0] if check.path not in RULES else check.path}",
                    " ".join(plain[max(start - 30, 0) : result.span[1] + 30].split()),
                )  # fmt: skip
        if text.kind == "messages" and text.text.rstrip().endswith("?"):
            yield Hit(text.path, text.line, "messages: question", text.text)
    if path.suffix in {".py", ".js", ".hpp", ".cpp"}:
        vague = VAGUE - {"part"} if re.search(r"\bPart\b", path.read_text("utf-8")) else VAGUE
        yield from (Hit(relpath(path, ROOT), line, "names: vague", name) for line, name in names(path) if name in vague)


_UNCHECKED = {"vendor", "build", "changes", "keys", "gallery"}
"""Folders of other authors, of builds, of lists of changes, and of generated pages."""


def files(paths: Iterable[Path]) -> list[Path]:
    """Return the files under paths that are checked."""
    endings = {".py", ".js", ".hpp", ".cpp", ".md", ".pot"}
    every = (file for path in paths for file in (sorted(path.rglob("*")) if path.is_dir() else [path]))
    return [file for file in every if file.suffix in endings and not _UNCHECKED & {*file.parts}]


def everything() -> list[Path]:
    """Return all files of the project that are checked."""
    return files([ROOT / "src", ROOT / "workbench/src", ROOT / "engine", ROOT / "docs", ROOT / "README.md"])


def counts(paths: Iterable[Path]) -> dict[str, int]:
    """Return the number of hits of each rule."""
    return dict(sorted(Counter(hit.rule for path in paths for hit in hits(path)).items()))


def main(arguments: list[str]) -> int:
    """Run the check; return its exit status."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("paths", nargs="*", type=Path)
    parser.add_argument("--counts", action="store_true")
    parser.add_argument("--keep", action="store_true")
    options = parser.parse_args(arguments)
    paths = files(path.resolve() for path in options.paths) if options.paths else everything()
    if options.paths and not options.counts:
        for hit in (hit for path in paths for hit in hits(path)):
            print(f"{hit.path}:{hit.line}: {hit.rule}: {hit.text}")
        return 0
    now = counts(paths)
    if options.counts:
        bindings = sum(1 for path in paths if path.suffix == ".py" for _ in names(path))
        print("\n".join(f"{count:6,} {rule}" for rule, count in now.items()), f"\n{bindings:6,} bindings in Python")
        return 0
    kept = json.loads(KEPT.read_text("utf-8")) if KEPT.exists() else now
    risen = {rule: count for rule, count in now.items() if count > kept.get(rule, 0)}
    for rule, count in risen.items():
        print(f"{rule}: {count} hits, {kept.get(rule, 0)} allowed; `python packaging/prose.py PATH` lists them")
    if options.keep and not risen:
        KEPT.write_text(json.dumps(now, indent=1) + "\n", "utf-8")
    return bool(risen)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
