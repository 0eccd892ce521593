"""The gate on prose and names finds each pattern that it counts, and accepts plain English."""

import runpy
from pathlib import Path

import pytest

pytest.importorskip("proselint", reason="the prose linter is part of the extra lint")
PROSE = runpy.run_path(str(Path(__file__).parents[2] / "packaging/prose.py"))


def rules(folder, name, text):
    """Return the rules that a file with a text breaks."""
    (folder / name).write_text(text, "utf-8")
    return {hit.rule for hit in PROSE["hits"](folder / name)}


@pytest.mark.parametrize(
    ("rule", "sentence"),
    [
        ("clause for a noun", "What an impact costs depends on the model."),
        ("files that speak", "The file says that the unit is g."),
        ("private words", "The least factor of all motions is printed."),
        ("stand for appear", "The units stand in the header."),
        ("idiom", "The verdict hangs on the model."),
        ("chain of semicolons", "The body rocks; it stops; it stands."),
        ("weasel_words", "The method is very accurate."),
    ],
)
def test_each_rule_finds_its_sentence(tmp_path, rule, sentence):
    """The rule is broken in a page; in code, formulas and fences nothing is read."""
    assert f"manual: {rule}" in rules(tmp_path, "page.md", sentence + "\n")
    if rule != "weasel_words":
        assert f"docstrings: {rule}" in rules(tmp_path, "code.py", f'"""{sentence}"""\n')
    assert rules(tmp_path, "fence.md", f"```\n{sentence}\n```\nThe body is `{sentence}` long.\n") == set()


def test_plain_english_passes(tmp_path):
    """Sentences as the rules want them have no hit."""
    assert rules(tmp_path, "page.md", "The body rocks but does not overturn. The smallest margin is 1.8.\n") == set()


def test_vague_names_are_found(tmp_path):
    """Variables, parameters and comprehensions of Python, declarations of scripts and C++."""
    assert rules(tmp_path, "a.py", "models = [each for each in range(3)]\n") == {"names: vague"}
    assert rules(tmp_path, "b.py", "def f(found): return found\n") == {"names: vague"}
    assert rules(tmp_path, "c.js", "const place = 3;\n") == {"names: vague"}
    assert rules(tmp_path, "d.cpp", "double least = 3.0;\n") == {"names: vague"}
    assert rules(tmp_path, "e.py", "models = [model for model in range(3)]\n") == set()


def test_counts_may_not_rise(tmp_path, monkeypatch, capsys):
    """A rule with more hits than the file of counts allows fails, and is named."""
    (tmp_path / "page.md").write_text("What an impact costs.\n", "utf-8")
    kept = tmp_path / "kept.json"
    main = PROSE["main"]
    monkeypatch.setitem(main.__globals__, "KEPT", kept)
    monkeypatch.setitem(main.__globals__, "everything", lambda: [tmp_path / "page.md"])
    assert main(["--keep"]) == 0
    assert main([]) == 0
    kept.write_text("{}", "utf-8")
    assert main([]) == 1
    assert "manual: clause for a noun: 1 hits, 0 allowed" in capsys.readouterr().out
