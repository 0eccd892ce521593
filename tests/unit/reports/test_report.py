"""Reports: text is text, nothing is fetched, both renderers take any content; the section on explanations."""

import sys

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

from rocking import Block
from rocking.answers import Answer
from rocking.evidence.bed_fit import explanation
from rocking.plots import body_picture, paper_figure
from rocking.reports import Document, paper_folder
from rocking.reports.document import (
    Cell,
    Paragraph,
    Picture,
    ReportSection,
    ReportTable,
    render_html,
    render_pdf,
    write_html,
)
from rocking.reports.paper_document import explanation_blocks

SVG = (
    '<?xml version="1.0"?><svg xmlns="http://www.w3.org/2000/svg" width="10" height="10">'
    '<g id="a"><use href="#a"/></g></svg>'
)
WORDS = "<script>alert(1)</script> #strong[x] $x$ \\ & *b* @cite"


def document():
    """A report with every kind of block and hostile words."""
    blocks = [
        Paragraph(WORDS, WORDS, "bad"),
        ReportTable(WORDS, [WORDS, "b"], [[Cell(WORDS, "good"), Cell("1")]], WORDS, "t"),
        Picture("one", WORDS),
        Picture("two", WORDS, width=62),
    ]
    sections = [ReportSection(WORDS, blocks)]
    return Document(WORDS, WORDS, sections, look_at=[(WORDS, WORDS)], provenance={"made with": WORDS})


@pytest.fixture
def folder(tmp_path):
    """A folder with the pictures of that report."""
    for stem in ("one", "two"):
        (tmp_path / f"{stem}.svg").write_text(SVG, encoding="utf-8")
    return tmp_path


def test_html_escapes_and_keeps_ids_apart(folder):
    """Words with markup stay words; ids of two pictures do not meet; nothing is linked from elsewhere."""
    html = render_html(document(), folder)
    assert all(words in html for words in ("&lt;script&gt;", 'id="one-a"', 'href="#two-a"'))
    assert not any(words in html for words in ("<script>", "@import", "src="))
    assert [table.stem for table in document().tables] == ["t"]


def test_pdf_takes_any_words(folder):
    """Typst markup in the content is not read as markup: the report still compiles."""
    render_pdf(document(), folder, folder / "report.pdf")
    assert (folder / "report.pdf").read_bytes().startswith(b"%PDF")
    assert sorted(path.suffix for path in folder.iterdir()) == [".pdf", ".svg", ".svg"]


@pytest.mark.parametrize(
    ("missing", "kept", "said"),
    [
        ("typst", ["report.html", "results.json"], "no report.pdf: the PDF report needs typst"),
        ("jinja2", ["report.pdf", "results.json"], "no report.html: the HTML report needs jinja2"),
        ("matplotlib", ["results.json"], "no figures, no report.html and no report.pdf"),
    ],
)
def test_a_missing_package_costs_its_part_alone(missing, kept, said, folder, monkeypatch):
    """Without an optional package the folder of `rocking reproduce` has everything else, and says what it has not."""
    monkeypatch.setattr(paper_folder, "write_html", lambda content, _, path: write_html(content, folder, path))
    monkeypatch.setattr(paper_folder, "render_pdf", lambda content, _, path: render_pdf(content, folder, path))
    monkeypatch.setitem(sys.modules, missing, None)
    figures = {"body": lambda: body_picture(Block(width=1.0, height=2.0))} if missing == "matplotlib" else {}
    written, left_out = paper_folder.write_folder(document(), figures, Answer({}), folder / "out", lambda _: None)
    assert [path.name for path in written] == kept
    assert all(path.is_file() for path in written)
    assert len(left_out) == 1
    assert said in left_out[0]
    assert "pip install " in left_out[0]


def test_claims_need_no_labelled_arrays(monkeypatch):
    """Without xarray every claim is judged: `rocking reproduce` loses nothing, not even the claim on large bodies."""
    from rocking.evidence import claims

    with monkeypatch.context() as without:
        without.setitem(sys.modules, "xarray", None)
        judged = claims()
    assert any("adapts better to large components" in claim.quote for claim in judged)


@pytest.mark.slow
def test_the_section_on_explanations():
    """Every row has the name, BIC and error of its explanation, best first; the verdict comes before."""
    found = explanation()
    blocks = explanation_blocks(found)
    (table,) = [block for block in blocks if isinstance(block, ReportTable)]
    assert [row[0].text for row in table.rows] == [each.name for each in found.ranked]
    assert [float(row[4].text) for row in table.rows] == pytest.approx([e.fit.rmse for e in found.ranked], abs=5e-5)
    assert [float(row[5].text) for row in table.rows] == pytest.approx([e.fit.bic for e in found.ranked], abs=0.05)
    words = [block.text for block in blocks if isinstance(block, Paragraph)]
    assert tuple(words[: len(found.verdict)]) == found.verdict
    # each picture of the section is among the figures of the report, and is not blank: more than 1 % is inked
    pictures = [block.stem for block in blocks if isinstance(block, Picture)]
    assert len(pictures) == 3
    for stem in pictures:
        canvas = FigureCanvasAgg(paper_figure(stem))
        canvas.draw()
        inked = (np.asarray(canvas.buffer_rgba())[..., :3].min(axis=2) < 200).mean()
        assert 0.01 < inked < 0.9


def test_words_tables_and_pictures_have_one_typeface():
    """Both layouts of documents and the style of pictures name DejaVu Sans first; pages and their pictures alike."""
    from importlib.resources import files

    from rocking.plots.style import journal_style

    folder = files("rocking.reports")
    for name in ("report.typ", "response.typ"):
        assert '#set text(font: ("DejaVu Sans"' in folder.joinpath(name).read_text("utf-8")
    page = folder.joinpath("report.html.jinja").read_text("utf-8")
    assert 'body, svg text, svg tspan { font-family: "DejaVu Sans"' in page
    with journal_style():
        import matplotlib as mpl

        assert mpl.rcParams["font.sans-serif"] == ["DejaVu Sans"]
