"""Files that compute each equation of the theory, from the comments of the code that cite its number.

The files are below each equation; the directive `equations` lists all equations by number.
"""

from benchmarks import house_citations
from docutils import nodes
from mathml import number_of
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective


def shown(path: str) -> str:
    """Return the path of a file as on the pages."""
    return path.removeprefix("src/rocking/")


class Equations(SphinxDirective):
    """All equations by number: name, page, and the files that compute them."""

    def run(self) -> list[nodes.Node]:
        """Return a table."""
        computed, rows = house_citations.computed(), {}
        for name, text in house_citations.pages().items():
            self.env.note_dependency(self.env.doc2path(f"theory/{name}"))
            title = text.removeprefix("# ").split("\n", 1)[0]
            for equation in house_citations.numbered(text):
                files = ", ".join(f"`{shown(path)}`" for path in computed.get(equation.number, []))
                named = equation.name[:1].upper() + equation.name[1:]
                cells = (f"{{eq}}`eq-{equation.number}`", named, f"[{title}]({name}.md)", files)
                rows[equation.number] = f"| {' | '.join(cells)} |"
        head = "| Number | Equation | Page | Computed in |\n|---|---|---|---|\n"
        return self.parse_text_to_nodes(head + "\n".join(rows[number] for number in sorted(rows)))


def note_files(app: Sphinx, document: nodes.document, page: str) -> None:
    """Add the files that compute an equation below each equation of a page."""
    if not page.startswith("theory/"):
        return
    computed = house_citations.computed()
    for equation in list(document.findall(nodes.math_block)):
        paths = computed.get(number_of(equation.get("label") or "") or 0, [])
        if paths:
            line = nodes.paragraph("", "computed in ", classes=["computed"])
            for path in paths:
                line += [nodes.literal(text=shown(path)), nodes.Text(", ")]
            line.pop()
            equation.parent.insert(equation.parent.index(equation) + 1, line)


def setup(app: Sphinx) -> dict[str, bool]:
    """Register with Sphinx."""
    app.add_directive("equations", Equations)
    app.connect("doctree-resolved", note_files)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
