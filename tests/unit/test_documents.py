"""The documents say what the code does."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
_DOCUMENTS = ("architecture", "conventions", "extending", "application")
_THEORY = sorted(path.relative_to(ROOT).as_posix() for path in (ROOT / "docs" / "theory").glob("*.md"))
PAGES = ["README.md", "CHANGELOG.md", *(f"docs/{name}.md" for name in _DOCUMENTS), *_THEORY]


def test_readme_examples_run():
    """The README's lines run, and the numbers in their comments are what they give."""
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(encoding="utf-8"), flags=re.S)
    names = {}
    checked = 0
    for line in "".join(blocks).splitlines():
        code, _, comment = line.partition("#")
        number = re.match(r"\s*(\d\.\d+):", comment)
        if number is None:
            exec(code, names)
            continue
        assert f"{eval(code, names):.{len(number[1]) - 2}f}" == number[1]
        checked += 1
    assert checked == 3


def test_changelog_is_short():
    """CHANGELOG has at most 60 lines; lists of moved numbers and renamed keys are in docs/changes, all in its index."""
    assert len((ROOT / "CHANGELOG.md").read_text(encoding="utf-8").splitlines()) <= 60
    lists = {path.stem for path in (ROOT / "docs/changes").glob("*.md")} - {"index"}
    assert lists == set(re.findall(r"^\w+$", (ROOT / "docs/changes/index.md").read_text(encoding="utf-8"), re.M))


@pytest.mark.parametrize("page", PAGES)
def test_links_lead_somewhere(page):
    """Every relative link and picture of a page exists, and every test it names."""
    text = (ROOT / page).read_text(encoding="utf-8")
    for target in re.findall(r"\]\((?!http)([^)#]+)\)", text):
        assert ((ROOT / page).parent / target).exists(), target
    for target in re.findall(r"(?:workbench/)?tests/[\w/]+\.py", text):
        assert (ROOT / target).exists(), target


def test_the_plan_of_the_house_names_files_that_exist():
    """Rooms, and files of a room, of the engine or of the tests, as docs/architecture.md calls them."""
    text = (ROOT / "docs/architecture.md").read_text(encoding="utf-8")
    named = re.findall(r"`([\w./]+/[\w.]*)`", text)
    assert len(named) > 15
    for path in named:
        assert any((place / path).exists() for place in (ROOT, ROOT / "src" / "rocking")), path


@pytest.mark.parametrize("folder", ["src", "engine", "examples", "benchmarks"])
def test_cited_documents_are_shipped(folder):
    """A document that code cites is in the repository."""
    for path in [p for p in (ROOT / folder).rglob("*") if p.suffix in {".py", ".hpp", ".cpp"}]:
        # a page that a benchmark writes is there once that has run
        text = re.sub(r'table\.keep\("[^"]+"', "", path.read_text(encoding="utf-8"))
        for cited in re.findall(r"[\w./-]+\.md\b", text):
            assert any((place / cited).exists() for place in (ROOT, ROOT / "benchmarks")), (path, cited)
