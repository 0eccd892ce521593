"""The types of the page's scripts: faults that `make types` finds, and its message without its tools."""

import runpy
import shutil
from pathlib import Path
from types import SimpleNamespace

import pytest

ROOT = Path(__file__).parents[3]
CHECK = runpy.run_path(str(ROOT / "workbench/types/check.py"), run_name="check")
STATIC = "workbench/src/rocking_workbench/static"
# a script, what stands in it, what is written in its place, and what the checker must say
WRONG = [
    ("app/facts.js", 'app.latest("body", "body",', 'app.latest("body", "bodies",', "TS2345"),  # no such call
    ("app/summary.js", "{ sides, mass }", "{ sides, weight: mass }", "TS2339"),  # no such key of the answer
    ("app/lent.js", "inputs.swap", "inputs.swop", "TS2339"),  # a slip of the pen
    ("charts/save.js", "slug = (title)", "slug = (title, more)", "TS7006"),  # of no known type
    ("drawing/axis.js", "roundStep(high - low, count)", "roundStep(high - low)", "TS2554"),  # one argument too few
    ("drawing/body-picture.js", "body.ground ?? 0", "body.base.ground ?? 0", "TS2339"),  # a shape of answers before
    ("scene/still.js", "= /** @type {Play} */ (stage.play)", "= stage.play", "TS18047"),  # nothing to play yet
]


@pytest.fixture
def check(tmp_path, monkeypatch):
    """The functions of the checker, with everything that they write in a folder of their own."""
    names = CHECK["fetch"].__globals__
    monkeypatch.setitem(names, "COMPILER", tmp_path / "build/typescript/package/lib/tsc.js")
    return names


def test_wrong_scripts_are_rejected(tmp_path):
    """Of copies of which seven are wrong, each in another way, those are named with their fault, and no other."""
    if missing := CHECK["absent"]():
        pytest.skip(f"there is no {missing} here: types are not checked")
    if not CHECK["COMPILER"].is_file():
        pytest.skip("`make types` has not put the compiler into build: types are not checked")
    waiting = [f"static/{line}" for line in CHECK["WAITING"].read_text("utf-8").split("\n") if line and line[0] != "#"]
    for name in (STATIC, "workbench/types"):
        shutil.copytree(ROOT / name, tmp_path / name)
    CHECK["declare"](tmp_path / "build/types/answers.d.ts")  # what the server says now, not at the last run
    shutil.copy(ROOT / "workbench/tsconfig.json", tmp_path / "workbench")
    for path, text, other, _ in WRONG:
        script = tmp_path / STATIC / path
        words = script.read_text("utf-8")
        assert words.count(text) == 1, path
        script.write_text(words.replace(text, other), "utf-8")
    told = [line for line in CHECK["faults"](tmp_path / "workbench") if not any(each in line for each in waiting)]
    found = {(line.partition("(")[0].partition(f"{STATIC}/")[2], line.partition("error ")[2][:6]) for line in told}
    assert {path for path, _ in found} == {path for path, *_ in WRONG}
    assert {(path, code[:6]) for path, _, _, code in WRONG} <= found


def test_shapes_of_the_schema_are_types():
    """A table with keys that are needed or not, a pair, a list, a choice, a table of tables, and anything."""
    number = {"type": "number"}
    shape = {
        "type": "object",
        "properties": {
            "pair": {"type": "array", "minItems": 2, "maxItems": 2, "items": number},
            "words": {"anyOf": [{"type": "array", "items": {"enum": ["a", "b"]}}, {"type": "null"}]},
            "by": {"type": "object", "additionalProperties": {"$ref": "#/components/schemas/Table"}},
            "more": {},
        },
        "required": ["pair"],
    }
    assert CHECK["kind"](shape) == (
        '{ "pair": [number, number]; "words"?: ("a" | "b")[] | null; "by"?: { [key: string]: Table }; "more"?: any }'
    )


def test_longer_addresses_are_asked_for_first():
    """An address with a place in it also fits those below it, so that these stand before it."""
    answer = {"200": {"content": {"application/json": {"schema": {"type": "string"}}}}}
    paths = {path: {"get": {"responses": answer}} for path in ("/api/a/{b}", "/api/a/{b}/c", "/api/a/d")}
    words = "\n".join(CHECK["declarations"]({"components": {"schemas": {}}, "paths": paths}))
    places = [words.index(f"`GET {path}`") for path in ("a/${string}/c", "a/d", "a/${string}")]
    assert places == sorted(places)


def test_another_compiler_is_not_unpacked(check, monkeypatch):
    """An archive whose hash is not that of the lock ends the check before anything of it is there."""

    def pack(words, cwd, **_):
        assert words[:2] == ["npm", "pack"]
        (cwd / "typescript.tgz").write_bytes(b"another")
        return SimpleNamespace(returncode=0)

    monkeypatch.setitem(check, "subprocess", SimpleNamespace(run=pack))
    with pytest.raises(SystemExit, match=r"typescript@\d+\.\d+\.\d+ has the hash [0-9a-f]{128}, typescript\.lock says"):
        check["fetch"]()
    assert not check["COMPILER"].exists()


def test_what_npm_does_not_bring_is_said(check, monkeypatch):
    """Without a way to the release, its name is what is missing, and nothing is there."""
    monkeypatch.setitem(check, "subprocess", SimpleNamespace(run=lambda *_, **__: SimpleNamespace(returncode=1)))
    assert check["fetch"]().startswith("typescript@")
    assert not check["COMPILER"].exists()


@pytest.mark.parametrize(("watched", "code", "word"), [("", 0, "SKIPPED: "), ("true", 1, "FAILED: ")])
def test_without_node_or_npm_it_says_so(check, monkeypatch, capsys, watched, code, word):
    """A machine without them, or without a way to the release, is told that nothing was checked; CI stops there."""
    monkeypatch.setenv("CI", watched)
    nothing = SimpleNamespace(run=lambda *_, **__: SimpleNamespace(returncode=1))
    for which, missing in ((lambda name: None, "node and npm"), (lambda name: name, "typescript@")):
        monkeypatch.setitem(check, "shutil", SimpleNamespace(which=which, rmtree=shutil.rmtree))
        monkeypatch.setitem(check, "subprocess", nothing)
        assert check["main"]() == code
        told = capsys.readouterr().out
        assert told.startswith(word)
        assert f"NOT checked: there is no {missing}" in told
