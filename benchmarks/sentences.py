"""A random sample of the sentences of the project from 19 sources, for a reader.

`python -m benchmarks.sentences [--seed N] [--count N]` prints JSON lines with source, file, line and sentence. A reader
marks each sentence that an engineer who is not a native speaker would not understand at once.
"""

import argparse
import ast
import json
import random
import re
import runpy
from collections.abc import Iterator
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
PROSE = runpy.run_path(str(ROOT / "packaging" / "prose.py"))
DOCS = {
    "manual: get started": ("index", "install", "choose_a_tool", "read_results"),
    "manual: tutorials": ("tutorials/*",),
    "manual: how-to guides": ("how_to/*",),
    "manual: command line": ("commands/*",),
    "manual: reference": ("questions", "terms", "record_formats", "conventions", "application"),
    "manual: background": ("theory/*",),
    "manual: quality": ("limits", "verified", "speed", "predictions", "which_model", "measurements"),
    "manual: development": ("architecture", "extending", "contributing", "releasing", "governance"),
}
"""Pages of the manual by their part, below docs/."""
CODE = [ROOT / "src", ROOT / "workbench/src"]
FEWEST_WORDS = 4  # of a sentence that is drawn


def sentences(text: str) -> Iterator[tuple[int, str]]:
    """Yield line offset and text of each sentence of prose, without tables, headings and lists of parameters."""
    for block in re.finditer(r"(?:.+\n?)+", text):
        lines = [line.strip() for line in block[0].splitlines()]
        if any(re.match(r"[#|>]|-{3,}|\w+ : ", line) for line in lines):
            continue
        joined = " ".join(line.lstrip("-*0123456789. ") for line in lines)
        for sentence in re.split(r"(?<=[.:!?])\s+(?=[A-Z`*])", joined):
            if len(sentence.split()) >= FEWEST_WORDS:
                yield text.count("\n", 0, block.start()), sentence


def sources() -> dict[str, list[tuple[str, int, str]]]:
    """Return file, line and text of all sentences, by source."""
    by_source: dict[str, list[tuple[str, int, str]]] = {}

    def add(source: str, paths: list[Path], kind: str = "", keep: str = "") -> None:
        rows = by_source.setdefault(source, [])
        for path in paths:
            for text in PROSE["texts"](path):
                if kind in {"", text.kind} and re.search(keep, text.text):
                    rows += [
                        (text.path, text.line + offset, sentence) for offset, sentence in sentences(_unmarked(text))
                    ]

    add("README", [ROOT / "README.md"])
    for section, patterns in DOCS.items():
        add(section, [path for pattern in patterns for path in sorted((ROOT / "docs").glob(f"{pattern}.md"))])
    add("changes", [ROOT / "CHANGELOG.md", *sorted((ROOT / "docs/changes").glob("*.md"))])
    python = [path for path in PROSE["files"](CODE) if path.suffix == ".py"]
    add("docstrings: public", python, "docstrings", r"\n +Parameters\n")
    add("docstrings: other", python, "docstrings", r"\A(?!.*\n +Parameters\n)")
    add("comments: Python", python, "comments")
    compiled = [*sorted((ROOT / "engine").rglob("*.hpp")), *sorted((ROOT / "engine").rglob("*.cpp"))]
    add("comments: C++ and scripts", [*compiled, *(p for p in PROSE["files"](CODE) if p.suffix == ".js")])
    places = {
        "errors": lambda name, _: name.endswith("Error") or name in {"Refused", "NotFound", "Busy", "TooLarge"},
        "help of commands": lambda _, keyword: keyword == "help",
        "labels and texts of the page": None,
        "reports and results": lambda name, _: name in {"Message", "say"},
        "descriptions of keys": lambda _, keyword: keyword in {"words", "description", "title", "summary"},
    }
    for source, is_wanted in places.items():
        if is_wanted is not None:
            by_source[source] = [row for path in python for row in _literals(path, is_wanted)]
    pages = [path for path in PROSE["files"](CODE) if path.suffix == ".js"]
    quoted = re.compile(r'"((?:[^"\\\n]|\\.){12,})"|>([^<>{}`$\n]{12,})<')
    by_source["labels and texts of the page"] = [
        (path.relative_to(ROOT).as_posix(), text.count("\n", 0, hit.start()) + 1, " ".join((hit[1] or hit[2]).split()))
        for path in pages
        for text in [path.read_text("utf-8")]
        for hit in quoted.finditer(text)
        if len((hit[1] or hit[2]).split()) >= FEWEST_WORDS
    ]
    return by_source


def _unmarked(text: Any) -> str:
    return re.sub(r"^[ \t]*(?:#|//|/\*+|\*+/?) ?", "", text.text, flags=re.M) if text.kind == "comments" else text.text


def _literals(path: Path, is_wanted: object) -> Iterator[tuple[str, int, str]]:
    for call in ast.walk(ast.parse(path.read_text("utf-8"))):
        if not isinstance(call, ast.Call):
            continue
        name = getattr(call.func, "id", getattr(call.func, "attr", ""))
        for keyword, node in [("", node) for node in call.args[:1]] + [(k.arg or "", k.value) for k in call.keywords]:
            is_text = isinstance(node, ast.Constant) and isinstance(node.value, str)
            if is_text and is_wanted(name, keyword) and len(node.value.split()) >= FEWEST_WORDS:  # type: ignore[operator, attr-defined]
                yield path.relative_to(ROOT).as_posix(), node.lineno, " ".join(node.value.split())  # type: ignore[attr-defined]


def main() -> None:
    """Print the sentences."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=32)
    options = parser.parse_args()
    draw = random.Random(options.seed)
    for source, rows in sorted(sources().items()):
        for path, line, sentence in draw.sample(rows, min(options.count, len(rows))):
            print(json.dumps({"source": source, "file": path, "line": line, "sentence": sentence}, ensure_ascii=False))


if __name__ == "__main__":
    main()
