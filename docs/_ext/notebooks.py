"""Write pages with code as notebooks for download, without outputs and without links into the manual."""

import re
from pathlib import Path

import nbformat
from sphinx.application import Sphinx

DOWNLOAD = re.compile(r"[ \n]*<a [^>]*\.ipynb[^>]*>[^<]*</a>\.?")
INWARD = re.compile(r"\[([^\]]+)\]\((?!https?:)[^)]*\)|\{\w+\}`([^`<]+?)(?: <[^`]*)?`")
"""Links to other pages, in Markdown or by a role, which are invalid in a downloaded file."""


def cleaned(notebook: nbformat.NotebookNode) -> nbformat.NotebookNode:
    """Return a notebook for download."""
    cells = []
    for cell in notebook.cells:
        if cell.cell_type == "code":
            new_cell = nbformat.v4.new_code_cell(cell.source, metadata={"tags": cell.metadata.get("tags", [])})
        else:
            text = INWARD.sub(lambda link: link[1] or link[2], DOWNLOAD.sub("", cell.source))
            new_cell = nbformat.v4.new_markdown_cell(text)
        new_cell.id = f"cell-{len(cells)}"  # the same at every build
        cells.append(new_cell)
    kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
    return nbformat.v4.new_notebook(cells=cells, metadata={"kernelspec": kernel, "language_info": {"name": "python"}})


def finished(app: Sphinx, error: Exception | None) -> None:
    """Write the notebooks."""
    executed = Path(app.outdir).parent / "jupyter_execute"
    if error is None and app.builder.format == "html":
        for name in app.env.found_docs:
            if (path := executed / f"{name}.ipynb").exists():
                notebook = cleaned(nbformat.read(path, as_version=4))
                nbformat.validate(notebook)
                nbformat.write(notebook, Path(app.outdir) / f"{name}.ipynb")


def setup(app: Sphinx) -> dict[str, bool]:
    """Register with Sphinx."""
    app.connect("build-finished", finished)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
