"""The section of the report that says what explains the measurements."""

from rocking.evidence.explanation import Explanation, Ranked
from rocking.reports.document import Cell, Paragraph, Picture, ReportTable, cell


def explanation_blocks(found: Explanation) -> list[Paragraph | ReportTable | Picture]:
    """Return the section."""
    return [
        *(Paragraph(sentence) for sentence in found.verdict),
        Paragraph(
            "The contact bed resolves an impact in time on springs and dashpots along the base. Each explanation is "
            "fitted to the 39 measurements by maximum likelihood of the printed digits, with a scatter "
            "s (1 - r)^gamma; BIC counts its parameters, the number of contact points and the two of the scatter. The "
            "left-out score is the sum over the measurements of the logarithm of the probability of each by a fit that "
            "has not seen it."
        ),
        ReportTable(
            "Explanations of the measurements by the contact bed",
            [
                "explanation",
                "what it says",
                "points",
                "fitted",
                "RMSE",
                "BIC",
                "behind",
                "left-out score",
                "over one bed",
            ],
            [_row(each, found.unresolved) for each in found.ranked],
            "Over one bed: with its standard error over the measurements.",
            "explanations",
        ),
        Picture("bed_dependence", "Coefficient of restitution of the contact bed: slenderness, hardness, damping."),
        Picture(
            "explanations",
            "BIC above the best, and left-out score above that of one bed for all, with two standard errors.",
        ),
        Picture("explanation_residuals", "What one bed and the best explanation leave over."),
    ]


def _row(each: Ranked, best: tuple[str, ...]) -> list[Cell]:
    fit = each.fit
    fitted = ", ".join(f"{name} = {value:.4g}" for name, value in fit.values.items())
    return [
        cell(each.name, "good" if each.name in best else "plain"),
        cell(fit.physics.sentence),
        cell(str(fit.points)),
        cell(fitted),
        cell(f"{fit.rmse:.4f}"),
        cell(f"{fit.bic:.1f}"),
        cell(f"{each.behind:.1f}"),
        cell(f"{each.score:.1f}"),
        cell(f"{each.gain:+.1f} +- {each.gain_error:.1f}"),
    ]
