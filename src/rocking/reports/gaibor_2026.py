"""The report of `rocking reproduce gaibor-2026`."""

from collections.abc import Sequence

from rocking.answers import Display
from rocking.evidence.claims_of_errors import FAILS, HOLDS, IN_PART
from rocking.evidence.gaibor_2026 import HIGHEST, LOWEST, MODELS, QUANTITIES_OF_CASES, SLENDERNESS, GaiborReproduction
from rocking.plots.gaibor_2026 import CAPTIONS, gaibor_figures
from rocking.reports.document import (
    Block,
    Cell,
    Document,
    Paragraph,
    Picture,
    ReportSection,
    answer_table,
    software_and_data,
    table,
)

CASE = ("slenderness_ratio", "model", "frequency_ratio")
MARK = {HOLDS: "good", IN_PART: "fair", FAILS: "bad"}


def parameters(result: GaiborReproduction) -> str:
    """Return the parameters of the comparison as text."""
    effort = result.effort
    return (
        "The parameters of the paper are not known. These are our own: homogeneous rectangles of slenderness "
        f"{', '.join(map(str, SLENDERNESS))}; models {', '.join(MODELS)}; frequency ratios "
        f"{', '.join(f'{value:g}' for value in effort.frequencies)} (over p); amplitude ratios {LOWEST:g} to "
        f"{HIGHEST:g} (over g tan alpha), in steps of {effort.step_at_rest:g} from rest and {effort.step:g} from "
        f"{effort.starts**2} states after an impact; basins of {effort.cells**2:,} cells."
    )


def gaibor_document(result: GaiborReproduction) -> Document:
    """Return the report."""
    answer, claims = result.answer(), result.claims()
    rows = [(c.section, c.quote, c.test, Cell(c.verdict, MARK.get(c.verdict, "plain")), c.evidence) for c in claims]
    header = ["", "statement", "sense", "verdict", "numbers"]
    display, numbers = Display(own=QUANTITIES_OF_CASES), list(result.cases[0].numbers)
    first = numbers.index("first_overturning")
    exact, counted = [*numbers[:first], *numbers[-4:]], numbers[first:-4]
    pictures = [
        Picture(name, CAPTIONS[name.partition("_")[0]].format(value=name.partition("_")[2]))
        for name in gaibor_figures(result)
    ]
    sections: dict[str, Sequence[Block]] = {
        "Parameters": [Paragraph(parameters(result))],
        "Statements of the abstract": [table("Statements and their senses", header, rows, "", "claims")],
        "Numbers": [
            answer_table("Bifurcations", answer["cases"], (*CASE, *exact), "", "bifurcations", display=display),
            answer_table("Attractors", answer["cases"], (*CASE, *counted), "", "attractors", display=display),
            answer_table("Basins", answer["basins"], (), "", "basins", display=display),
        ],
        "Figures": pictures,
    }  # fmt: skip
    return Document(
        "Gaibor and Lopez (2026), recomputed",
        "Harmonic rocking with Housner's model, KED and the calibrated model; arXiv:2606.14288",
        [ReportSection(title, blocks) for title, blocks in sections.items()],
        provenance={"Software": software_and_data()["Software"]},
    )
