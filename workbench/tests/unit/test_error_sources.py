"""Errors of the application carry facts, and no source or script parses the text of an error."""

import ast
import re
from pathlib import Path

from error_sources import family, finished_sentences, sources, taken_apart, without_facts

import rocking_workbench
import rocking_workbench.errors

SOURCE = Path(rocking_workbench.__file__).parent
OTHERS = {"rocking_workbench/api/body.py", "rocking_workbench/inputs.py"}  # texts of other libraries
READ_BACK = re.compile(
    r"\.message(?:\s*\?\?\s*\"\")?\)?\.(?:match|split|replace|slice|startsWith|includes)|\.test\(\w+\.message|\.exec\(\w*message"
)


def test_errors_are_facts():
    names = family(rocking_workbench.errors)
    assert {name for name, text in sources(SOURCE) if taken_apart(text)} <= OTHERS
    for name, text in sources(SOURCE):
        assert finished_sentences(ast.parse(text), names) == [], name
        assert without_facts(ast.parse(text)) == [], name


def test_no_script_parses_a_message():
    scripts = [path for path in (SOURCE / "static").rglob("*.js") if "vendor" not in path.parts]
    assert len(scripts) > 50
    assert [path.name for path in scripts if READ_BACK.search(path.read_text("utf-8"))] == []
    # negative control
    assert READ_BACK.search("const [, key] = error.message.match(/must/)")
