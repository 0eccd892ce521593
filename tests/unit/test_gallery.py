"""The gallery: every script has its place, a title, prose and a picture, which its page and its notebook show.

`make docs` runs all of them, and stops at one that fails.
"""

import ast
import base64
import importlib.util
import json
import os
import re
from pathlib import Path

import pytest
from waiting import HANG

ROOT = Path(__file__).parents[2]
EXAMPLES = ROOT / "examples"
SCRIPTS = sorted(EXAMPLES.glob("**/*.py"))


@pytest.fixture(scope="module")
def gallery():
    """The extension of the manual that orders the gallery."""
    pytest.importorskip("sphinx_gallery")
    spec = importlib.util.spec_from_file_location("gallery_pictures", ROOT / "docs" / "_ext" / "gallery_pictures.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def faults_of(script: str, named: re.Pattern) -> list[str]:
    """What a script of the gallery lacks."""
    words = ast.get_docstring(ast.parse(script)) or ""
    title, rule, *prose = words.split("\n")
    code = script.split('"""', 2)[2]
    wanted = {
        "a title over a line of its length": rule == "=" * len(title),
        "a title on one line of a card": len(title) <= 55,
        "its readers": "For " in " ".join(prose),
        "prose between its blocks": code.count("# %%\n# ") >= 2,
        "a picture": bool(named.search(code)),
        "something printed": "print(" in code,
        "an assertion": "assert " in code,
        "at most 100 lines": script.count("\n") <= 100,
    }
    return [lack for lack, there in wanted.items() if not there]


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: path.stem)
def test_a_script_is_complete(path, gallery):
    """Title, prose, readers, picture, numbers and assertions."""
    assert faults_of(path.read_text("utf-8"), gallery.NAMED) == []


def test_a_bare_script_is_noticed(gallery):
    """Negative control: a script without any of it."""
    assert len(faults_of('"""Title\n===\n"""\nx = 1\n', gallery.NAMED)) == 6


def test_every_script_has_its_place(gallery):
    """Sections are folders with a header, and their scripts are those that are there, each once."""
    there = {path.relative_to(EXAMPLES).with_suffix("").as_posix() for path in SCRIPTS}
    ordered = [f"{section}/{script}" for section, scripts in gallery.SECTIONS.items() for script in scripts]
    assert sorted(ordered) == sorted(there)
    assert set(gallery.PARTS) <= {name.split("/")[1] for name in ordered}
    assert all((EXAMPLES / section / "GALLERY_HEADER.rst").is_file() for section in gallery.SECTIONS)


_FEW = {"own_model", "one_cabinet_three_models"}
_RUN = SCRIPTS if os.environ.get("ROCKING_CAMPAIGN") else [path for path in SCRIPTS if path.stem in _FEW]


@pytest.mark.slow
@pytest.mark.parametrize("path", _RUN, ids=lambda path: path.stem)
def test_a_notebook_runs_in_an_empty_folder(path, tmp_path, gallery):
    """The notebook of a script runs by itself and shows the pictures that it writes; ROCKING_CAMPAIGN=1 runs all."""
    nbformat, nbclient = pytest.importorskip("nbformat"), pytest.importorskip("nbclient")
    from sphinx_gallery.gen_gallery import DEFAULT_GALLERY_CONF
    from sphinx_gallery.py_source_parser import split_code_and_text_blocks

    blocks = split_code_and_text_blocks(str(path))[1]
    conf = DEFAULT_GALLERY_CONF | {"notebook_extensions": {".py"}}
    notebook = nbformat.reads(json.dumps(gallery.notebook(blocks, conf, tmp_path)), as_version=4)
    nbclient.NotebookClient(notebook, timeout=HANG, resources={"metadata": {"path": str(tmp_path)}}).execute()
    cells = [cell for cell in notebook.cells if cell.cell_type == "code"]
    displays = [one.data for cell in cells for one in cell.outputs if one.output_type == "display_data"]
    shown = [data.get("image/png", data.get("image/gif")) for data in displays]
    written = [(tmp_path / name).read_bytes() for name in gallery.NAMED.findall(path.read_text("utf-8"))]
    assert written
    assert [base64.b64decode(one) for one in shown] == written
