"""Reports: text is text, nothing is fetched, both renderers take any content."""

import sys
from types import SimpleNamespace

import pytest

from rocking.plots import paper_figure
from rocking.reports import folder
from rocking.reports.document import Document, Paragraph, Picture, ReportSection, ReportTable, cell
from rocking.reports.html import render_html
from rocking.reports.pdf import render_pdf

SVG = (
    '<?xml version="1.0"?><svg xmlns="http://www.w3.org/2000/svg" width="10" height="10">'
    '<g id="a"><use href="#a"/></g></svg>'
)
WORDS = "<script>alert(1)</script> #strong[x] $x$ \\ & *b* @cite"


def document():
    """A report with every kind of block and hostile words."""
    blocks = [
        Paragraph(WORDS, WORDS, "bad"),
        ReportTable(WORDS, [WORDS, "b"], [[cell(WORDS, "good"), cell(1)]], WORDS, "t"),
        Picture("one", WORDS),
        Picture("two", WORDS, wide=False),
    ]
    return Document(WORDS, WORDS, [(WORDS, WORDS)], [ReportSection(WORDS, blocks)], {"made with": WORDS})


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


@pytest.mark.parametrize(
    ("missing", "kept", "said"),
    [
        ("typst", ["report.html", "results.json"], "no report.pdf: the PDF report needs typst"),
        ("jinja2", ["report.pdf", "results.json"], "no report.html: the HTML report needs jinja2"),
        ("matplotlib", ["results.json"], "no figures, and no report.html and report.pdf"),
    ],
)
def test_a_missing_package_costs_its_part_alone(missing, kept, said, tmp_path, monkeypatch):
    """Without an optional package the folder of `rocking paper` has everything else, and says what it has not."""
    for stem in ("one", "two"):
        (tmp_path / f"{stem}.svg").write_text(SVG, encoding="utf-8")
    monkeypatch.setattr(folder, "paper_document", lambda _: document())
    monkeypatch.setattr(folder, "as_plain", lambda *_: {})
    monkeypatch.setattr(folder, "render_html", lambda content, _: render_html(content, tmp_path))
    monkeypatch.setattr(folder, "render_pdf", lambda content, _, path: render_pdf(content, tmp_path, path))
    figures = SimpleNamespace(paper_figures=dict)
    monkeypatch.setitem(sys.modules, "rocking.plots.paper_figures", figures)
    monkeypatch.setitem(sys.modules, missing, None)
    if missing == "matplotlib":
        figures.paper_figures = lambda: {"three": lambda: paper_figure("figure_3")}
    result = SimpleNamespace(league=None, calibration=None)
    written, left_out = folder.write_folder(result, tmp_path / "out", lambda _: None)
    assert [path.name for path in written] == kept
    assert all(path.is_file() for path in written)
    assert len(left_out) == 1
    assert said in left_out[0]
    assert "pip install '.[" in left_out[0]


def test_claims_need_no_labelled_arrays(monkeypatch):
    """Without xarray every claim is judged: `rocking paper` loses nothing, not even the claim on large bodies."""
    from rocking.evidence.claims_of_conclusions import JUDGES

    with monkeypatch.context() as without:
        without.setitem(sys.modules, "xarray", None)
        judged = [judge() for judge in JUDGES]
    assert any("adapts better to large components" in claim.quote for claim in judged)
