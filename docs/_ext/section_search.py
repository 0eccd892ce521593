"""The search of the manual: sections and names of the reference, ranked by the rarest words of a query.

The search of Sphinx finds pages that contain all words. MiniSearch ranks (BM25), also offline and from files. The terms
of an `index` directive are other words for its section, such as the title that it had before.
"""

import json
import re
from collections.abc import Iterator
from pathlib import Path

from docutils import nodes
from sphinx import addnodes
from sphinx.application import Sphinx

_VENDOR = Path(__file__).parents[2] / "workbench" / "src" / "rocking_workbench" / "static" / "vendor" / "minisearch"
_INNER = (nodes.section, addnodes.desc)
_UNREAD = (*_INNER, nodes.comment, nodes.raw, nodes.math_block)
_FRACTION = re.compile(r"\\[dt]?frac\s*\{([^{}]*)\}\s*\{([^{}]*)\}")
_ROOT = re.compile(r"\\sqrt\s*\{([^{}]*)\}")
_LAYOUT = re.compile(
    r"\\(?:left|right|big|Big|mathrm|mathbf|mathit|mathcal|text|operatorname|boldsymbol|displaystyle)(?![a-zA-Z])|[{}$]"
)
_SPACE = re.compile(r"\\(?:[,;:! ]|q?quad(?![a-zA-Z]))|[\\&]")


def plain(latex: str) -> str:
    r"""Return a formula as words, so that \theta is found as theta.

    >>> plain(r"a_{\mathrm{p}}/(g\,\tan\alpha)"), plain(r"\frac{3 g}{4 R}")
    ('a_p/(g tan alpha)', '(3 g)/(4 R)')
    """
    latex = _ROOT.sub(r"\\sqrt(\1)", latex)
    while (ratios := _FRACTION.sub(r"(\1)/(\2)", latex)) != latex:
        latex = ratios
    return " ".join(_SPACE.sub(" ", _LAYOUT.sub("", latex)).split())


def texts(node: nodes.Element) -> Iterator[str]:
    """Yield the text of a section or name, without the text of inner sections and names."""
    for child in node.children:
        if isinstance(child, nodes.Text):
            yield str(child)
        elif isinstance(child, nodes.math):
            yield plain(child.astext())
        elif isinstance(child, nodes.Element) and not isinstance(child, _UNREAD):
            yield from texts(child)
            yield " "


def _title(heading: nodes.Element) -> str:
    """Return a title with its formulas as words."""
    return " ".join("".join(texts(heading)).split())


def entries(tree: nodes.document, address: str) -> Iterator[dict[str, str]]:
    """Yield each section and documented name of a page: title, page title, index terms, address and text."""
    page = next((_title(title) for title in tree.findall(nodes.title)), address)
    for node in tree.findall(lambda child: isinstance(child, _INNER)):
        heading = next(
            (child for child in node.children if isinstance(child, (nodes.title, addnodes.desc_signature))), None
        )
        if heading is None:
            continue
        named = isinstance(heading, addnodes.desc_signature)
        title = heading.get("fullname", heading.astext()) if named else _title(heading)
        ids = heading.get("ids") or node.get("ids") or [""]
        text = " ".join("".join(texts(node)).split())
        terms = [entry[1] for index in node.children if isinstance(index, addnodes.index) for entry in index["entries"]]
        yield {
            "title": title,
            "page": page,
            "terms": ", ".join(terms),
            "address": f"{address}#{ids[0]}",
            "text": text.removeprefix(title).strip(),
        }


def finished(app: Sphinx, error: Exception | None) -> None:
    """Write the data of the search page."""
    if error is None and app.builder.format == "html":
        every = [
            entry
            for name in sorted(app.env.found_docs)
            for entry in entries(app.env.get_doctree(name), app.builder.get_target_uri(name))
        ]
        text = json.dumps([{"id": number, **entry} for number, entry in enumerate(every)], ensure_ascii=False)
        (Path(app.outdir) / "_static" / "sections.js").write_text(f"const sections = {text};\n", "utf-8")


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the events."""
    app.config.html_static_path.append(str(_VENDOR))
    app.connect("build-finished", finished)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
