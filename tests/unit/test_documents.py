"""The documents say what the code does."""

import re
import runpy
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGES = ["README.md", *(f"docs/{name}.md" for name in ("conventions", "theory", "gallery", "extending"))]


def test_readme_example_runs():
    """The README's lines run, and the numbers in their comments are what they give."""
    (block,) = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(encoding="utf-8"), flags=re.S)
    names = {}
    checked = 0
    for line in block.splitlines():
        code, _, comment = line.partition("#")
        number = re.match(r"\s*(\d\.\d+):", comment)
        if number:
            value = eval(code, names)
            assert f"{value:.{len(number[1]) - 2}f}" == number[1]
            checked += 1
        else:
            exec(code, names)
    assert checked == 3


@pytest.mark.parametrize("page", PAGES)
def test_links_lead_somewhere(page):
    """Every relative link and picture of a page exists, and every test it names."""
    text = (ROOT / page).read_text(encoding="utf-8")
    for target in re.findall(r"\]\((?!http)([^)#]+)\)", text):
        assert ((ROOT / page).parent / target).exists(), target
    for target in re.findall(r"tests/[\w/]+\.py", text):
        assert (ROOT / target).exists(), target


@pytest.mark.parametrize("path", sorted((ROOT / "examples").glob("*.py")), ids=lambda path: path.stem)
def test_examples_run(path, tmp_path, monkeypatch, capsys):
    """Every example of the gallery runs and its assertions hold."""
    monkeypatch.chdir(tmp_path)
    runpy.run_path(str(path), run_name="__main__")
    assert capsys.readouterr().out
