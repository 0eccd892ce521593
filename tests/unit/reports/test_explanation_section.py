"""The section "what explains the measurements": its numbers are the functions', its pictures show something."""

import numpy as np
import pytest

from rocking.evidence.explanation import explanation
from rocking.plots.evidence import bed_dependence_figure, explanations_figure, residuals_figure
from rocking.reports.document import Paragraph, Picture, ReportTable
from rocking.reports.explanation_blocks import explanation_blocks


def test_numbers_of_the_table():
    """Every row has the name, BIC and error of its explanation, best first; the verdict comes before."""
    found = explanation()
    blocks = explanation_blocks(found)
    (table,) = [block for block in blocks if isinstance(block, ReportTable)]
    assert [row[0].text for row in table.rows] == [each.name for each in found.ranked]
    assert [float(row[4].text) for row in table.rows] == pytest.approx([e.fit.rmse for e in found.ranked], abs=5e-5)
    assert [float(row[5].text) for row in table.rows] == pytest.approx([e.fit.bic for e in found.ranked], abs=0.05)
    words = [block.text for block in blocks if isinstance(block, Paragraph)]
    assert tuple(words[: len(found.verdict)]) == found.verdict


def test_pictures_of_the_section_are_drawn():
    """Each picture of the section is among the figures of the report."""
    from rocking.plots.paper_figures import paper_figures

    pictures = [block.stem for block in explanation_blocks(explanation()) if isinstance(block, Picture)]
    assert len(pictures) == 3
    assert set(pictures) <= set(paper_figures())


@pytest.mark.parametrize(
    "draw",
    [
        bed_dependence_figure,
        lambda: explanations_figure(explanation()),
        lambda: residuals_figure(explanation()),
    ],
)
def test_pictures_are_not_blank(draw):
    """More than one in a hundred pixels is inked, and not all of them."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    canvas = FigureCanvasAgg(draw())
    canvas.draw()
    inked = (np.asarray(canvas.buffer_rgba())[..., :3].min(axis=2) < 200).mean()
    assert 0.01 < inked < 0.9
