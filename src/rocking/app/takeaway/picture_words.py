"""Pictures of the library as people read them: restitutions by the names that the pages use."""

from collections.abc import Iterable
from typing import TYPE_CHECKING

from rocking.reports.response_facts import restitution_words

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def in_words(figure: "Figure", labels: Iterable[str]) -> "Figure":
    """Write the names of restitutions into a picture, wherever it has their labels."""
    from matplotlib.text import Text

    known = {label: restitution_words(label) for label in labels}
    rows = {label.replace(":", "\n"): words.replace(", ", ",\n", 1) for label, words in known.items()}
    for axes in figure.axes:
        _name_rows(axes, rows)
    for text in figure.findobj(Text):
        for label, words in known.items():
            text.set_text(text.get_text().replace(f"restitution: {label};", f"restitution: {words};"))
    return figure


def _name_rows(axes: "Axes", rows: dict[str, str]) -> None:
    found = [text.get_text() for text in axes.get_yticklabels()]
    if any(text in rows for text in found):
        axes.set_yticks(axes.get_yticks(), [rows.get(text, text) for text in found], fontsize=6)
