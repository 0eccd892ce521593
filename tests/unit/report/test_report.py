"""Reports: text is text, nothing is fetched, both renderers take any content."""

from rocking.report.document import Document, Paragraph, Picture, Section, Table, cell
from rocking.report.html import render_html
from rocking.report.pdf import render_pdf

SVG = (
    '<?xml version="1.0"?><svg xmlns="http://www.w3.org/2000/svg" width="10" height="10">'
    '<g id="a"><use href="#a"/></g></svg>'
)
WORDS = "<script>alert(1)</script> #strong[x] $x$ \\ & *b* @cite"


def document():
    """A report with every kind of block and hostile words."""
    blocks = [
        Paragraph(WORDS, WORDS, "bad"),
        Table(WORDS, [WORDS, "b"], [[cell(WORDS, "good"), cell(1)]], WORDS, "t"),
        Picture("one", WORDS),
        Picture("two", WORDS, wide=False),
    ]
    return Document(WORDS, WORDS, [(WORDS, WORDS)], [Section(WORDS, blocks)], {"made with": WORDS})


def test_html_escapes_and_keeps_ids_apart(tmp_path):
    """Words with markup stay words; ids of two pictures do not meet; nothing is linked from elsewhere."""
    for stem in ("one", "two"):
        (tmp_path / f"{stem}.svg").write_text(SVG, encoding="utf-8")
    html = render_html(document(), tmp_path)
    assert "<script>" not in html
    assert "&lt;script&gt;" in html
    assert 'id="one-a"' in html
    assert 'href="#two-a"' in html
    assert "@import" not in html
    assert "src=" not in html


def test_pdf_takes_any_words(tmp_path):
    """Typst markup in the content is not read as markup: the report still compiles."""
    for stem in ("one", "two"):
        (tmp_path / f"{stem}.svg").write_text(SVG, encoding="utf-8")
    render_pdf(document(), tmp_path, tmp_path / "report.pdf")
    assert (tmp_path / "report.pdf").read_bytes().startswith(b"%PDF")
    assert sorted(path.suffix for path in tmp_path.iterdir()) == [".pdf", ".svg", ".svg"]


def test_tables_of_a_document():
    """Tables with a file name are those that are written."""
    assert [table.stem for table in document().tables] == ["t"]
