"""Which model to use, beside the coefficients of a body."""

from typing import Any

from rocking.cli.page import Page


def recommendation_facts(found: Any) -> dict[str, Any]:
    """Return a recommendation as plain values; nothing where none was asked for."""
    return {} if found is None else {"recommendation": found.as_dict()}


def show_recommendation(page: Page, found: Any) -> None:
    """Write a recommendation on a page, if there is one."""
    if found is None:
        return
    from rocking.evidence.recommendation_words import LEGEND

    page.line("\nWhich model to use", "bold")
    head, rows = found.table
    if found.judgement is not None:
        # coefficients and intervals stand above
        shown = [k for k, name in enumerate(head) if name.split()[0] != "r"]
        chosen = {k for k, row in enumerate(rows) if row[0] == found.prediction}
        words = [[row[k] for k in shown] for row in rows]
        page.table([head[k] for k in shown], words, ("model", "standing"), bold=chosen)
        page.line(LEGEND, "dim")
    for sentence in found.evidence:
        page.line(sentence)
    for sentence in found.advice:
        page.line(sentence, "bold")
