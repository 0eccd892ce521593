"""The notebooks that the tutorials offer: valid, clean, and run by whoever downloads them, in an empty folder."""

import os
import re
import sys
from importlib import import_module
from pathlib import Path

import nbformat
import pytest
from myst_nb.core.config import NbParserConfig
from myst_nb.core.read import create_nb_reader
from myst_parser.config.main import MdParserConfig
from waiting import HANG

DOCS = Path(__file__).parents[2] / "docs"
PAGES = sorted(path for path in (DOCS / "tutorials").glob("*.md") if path.name != "index.md")
sys.path.append(str(DOCS / "_ext"))
cleaned = import_module("notebooks").cleaned

PATH_IS_SET = 'os.environ["PATH"] = sysconfig.get_path("scripts")'
pytestmark = [
    pytest.mark.slow,
    pytest.mark.verifies("behaviour", room="doors"),
    pytest.mark.filterwarnings("ignore"),  # those of kernels and their sockets are not ours
]


def offered(text, name="page.md"):
    """The notebook to download of a page."""
    config = MdParserConfig(enable_extensions={"dollarmath", "colon_fence"})
    return cleaned(create_nb_reader(name, config, NbParserConfig(), text).read(text))


def sources(notebook, kind):
    return [cell.source for cell in notebook.cells if cell.cell_type == kind]


def run(notebook, folder):
    """Run it as Jupyter does, in a folder, where the shell does not know of this environment."""
    nbclient = pytest.importorskip("nbclient")
    scripts = str(Path(sys.executable).parent)
    kept = [part for part in os.environ["PATH"].split(os.pathsep) if part != scripts]
    environment = os.environ | {"PATH": os.pathsep.join(kept)}
    client = nbclient.NotebookClient(notebook, timeout=HANG, resources={"metadata": {"path": str(folder)}})
    client.execute(env=environment)
    return notebook


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.stem)
def test_a_page_offers_a_clean_notebook(path):
    """It is valid, holds the page's code without answers, no link into the manual, and the command before its use."""
    text = path.read_text("utf-8")
    notebook = offered(text, str(path))
    nbformat.validate(notebook)
    code, words = sources(notebook, "code"), "\n".join(sources(notebook, "markdown"))
    assert len(code) == text.count("```{code-cell}")
    assert not any(cell.get("outputs") for cell in notebook.cells)
    assert not re.findall(r"\]\((?!https?:)|\{\w+\}`|\.ipynb", words)
    assert re.search(r"\]\((?!https?:)", text), "the page itself leads on"
    assert f'<a href="{path.stem}.ipynb" download>' in text
    shell = next((k for k, source in enumerate(code) if re.search(r"^\s*!", source, flags=re.M)), None)
    if shell is not None:
        assert any(PATH_IS_SET in source for source in code[:shell])


def test_every_page_is_in_the_index():
    """The table of tutorials has each, with its notebook."""
    index = (DOCS / "tutorials" / "index.md").read_text("utf-8")
    for path in PAGES:
        assert f"]({path.name})" in index
        assert f'<a href="{path.stem}.ipynb" download>' in index


def page(*cells):
    front = "---\nfile_format: mystnb\nkernelspec: {name: python3}\n---\n# A page\n\n"
    return front + "\n\n".join(f"```{{code-cell}} ipython3\n{cell}\n```" for cell in cells)


@pytest.mark.verifies(control="within")
def test_a_notebook_finds_the_command(tmp_path):
    """A kernel whose shell does not know the environment finds `rocking` after the cell of the pages, not before."""
    setting = f'import os, sysconfig\n{PATH_IS_SET} + os.pathsep + os.environ["PATH"]'
    asked = "assert 'rocking 0' in ''.join(get_ipython().getoutput('rocking --version'))\nprint('found')"
    shown = run(offered(page(setting, asked)), tmp_path)
    assert shown.cells[-1].outputs[0].text == "found\n"
    with pytest.raises(Exception, match="AssertionError"):
        run(offered(page(asked)), tmp_path)


@pytest.mark.skipif("ROCKING_CAMPAIGN" not in os.environ, reason="the manual runs them")
@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.stem)
def test_a_notebook_runs_in_an_empty_folder(path, tmp_path):
    """Downloaded and run from first cell to last without the manual, the checkout or data."""
    run(offered(path.read_text("utf-8"), str(path)), tmp_path)
