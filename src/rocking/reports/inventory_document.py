"""The report of an inventory: the ranked table with its lights, and what they do and do not say."""

from collections.abc import Sequence

from rocking.conventions import g
from rocking.reports.document import Cell, Document, Paragraph, ReportSection, made_with, table
from rocking.statistics.counts import share_interval
from rocking.studies.inventory.assessment import Assessment, DirectionResult, Verdict
from rocking.studies.inventory.lights import Light, percent
from rocking.studies.inventory.table import LIMITS, SLIDING, advice, model_note, rotation_words, rounded_down, sentence

MARKS = {Light.GREEN: "good", Light.AMBER: "fair", Light.RED: "bad"}
"""Colour of a light; its letter and its word stand beside."""

_MOST_NAMED = 5


def inventory_document(assessment: Assessment) -> Document:
    """Return the report of an inventory."""
    refused = [_not_assessed(assessment)] if assessment.not_assessed else []
    limits = ReportSection("What is not covered", [Paragraph(each) for each in LIMITS])
    numbers, meaning, shaking = _numbers(assessment), _meaning(assessment), _shaking(assessment)
    sections = [_ranking(assessment), *refused, numbers, meaning, shaking, limits]
    rows = len(assessment.verdicts)
    return Document(
        "Which objects stay standing",
        f"{assessment.source}: {rows} object{'' if rows == 1 else 's'} assessed at {assessment.hazard.words()}",
        [section for section in sections if section.blocks],
        look_at=_look_at(assessment),
        provenance={"Made with": made_with()["Made with"], "Restitution": assessment.restitution},
    )


def light_words(light: Light) -> str:
    r"""Return a light for eyes that do not see its colour.

    >>> light_words(Light.RED)
    'R\xa0RED'
    """
    # one word for the line breaker
    return f"{light.value}\N{NO-BREAK SPACE}{light.name}"


def _look_at(assessment: Assessment) -> list[tuple[str, str]]:
    counts = assessment.counts()
    lights = ", ".join(f"{number} {light.word}" for light, number in counts.items())
    refused = len(assessment.not_assessed)
    lines = [("The lights", lights + f", {refused} not assessed" * bool(refused))]
    red = [verdict.item.name for verdict in assessment.verdicts if verdict.light is Light.RED]
    if red:
        more = f" and {len(red) - _MOST_NAMED} more" if len(red) > _MOST_NAMED else ""
        lines.append(("First of all", ", ".join(red[:_MOST_NAMED]) + more))
    undecided = sum(verdict.model_decides for verdict in assessment.verdicts)
    if undecided:
        text = f"for {undecided} object{'' if undecided == 1 else 's'} the other model of impact shows another light"
        lines.append(("The model decides", text))
    return [*lines, ("Not covered", SLIDING)]


def _ranking(assessment: Assessment) -> ReportSection:
    rows = [_ranked(rank, verdict, assessment) for rank, verdict in enumerate(assessment.verdicts, start=1)]
    header = ["", "light", "object", "what it does", "what to do"]
    nothing = Paragraph("No row could be assessed.", mark="bad")
    return ReportSection("The objects", [table("The worst first", header, rows, stem="ranking") if rows else nothing])


def _ranked(rank: int, verdict: Verdict, assessment: Assessment) -> list[object]:
    item = verdict.item
    name = item.name + (f" (x {item.count})" if item.count > 1 else "") + (f", {item.note}" if item.note else "")
    what_to_do = f"{advice(verdict, assessment)} {model_note(verdict, assessment)}".strip()
    return [rank, _light(verdict.light), name, sentence(verdict, assessment), what_to_do]


def _light(light: Light, mark: str | None = None) -> Cell:
    return Cell(light_words(light), MARKS[light] if mark is None else mark)


def _not_assessed(assessment: Assessment) -> ReportSection:
    rows = [(each.row or "", each.name, each.reason) for each in assessment.not_assessed]
    count = len(rows)
    lead = Paragraph(
        f"{count} row{'' if count == 1 else 's'} of the list could not be assessed; the others are not affected.",
        mark="bad",
    )
    reasons = table("Rows and reasons", ["line", "object", "why"], rows, stem="not_assessed")
    return ReportSection("Not assessed", [lead, reasons])


def _numbers(assessment: Assessment) -> ReportSection:
    header = [
        "object", "along", "light", "stays still up to [g]", "lifted [%]", "overturned",
        f"{percent(assessment.thresholds.level)} interval [%]", "median", "84 %",
        *(f"light by {name}" for name in assessment.comparisons),
    ]  # fmt: skip
    rows = [
        _numbered(each, one, others, assessment)
        for each in assessment.verdicts
        for one, *others in zip(each.results, *each.compared, strict=True)
    ]
    note = (
        "Stays still: horizontal acceleration g b/h below which nothing moves. Median, 84 %: quantiles of the peak "
        "rotation over the slenderness angle; beyond 1 the centre of mass has passed the foot. Interval: Clopper and "
        f"Pearson's, of the share that overturns. Impacts by {assessment.restitution}; both directions are given."
    )
    numbers = table("Every object in both directions", header, rows, note, "numbers")
    return ReportSection("The numbers", [numbers] if rows else [])


def _numbered(
    verdict: Verdict, one: DirectionResult, others: Sequence[DirectionResult], assessment: Assessment
) -> list[object]:
    low, high = share_interval(one.overturned, one.count, assessment.thresholds.level)
    worse = " (worse)" if one is verdict.worse else ""
    still, lifted = rounded_down(one.uplift_acceleration / g, 3), f"{100.0 * one.lifted_share:.0f}"
    shares = f"{one.overturned} of {one.count}", f"{100.0 * low:.1f} to {100.0 * high:.1f}"
    rotations = rotation_words(one.median_rotation), rotation_words(one.high_rotation)
    beside = [_light(each.light, "plain" if each.light is one.light else None) for each in others]
    name, along = verdict.item.name, f"{one.direction}{worse}"
    return [name, along, _light(one.light), still, lifted, *shares, *rotations, *beside]


def _meaning(assessment: Assessment) -> ReportSection:
    sentences = assessment.thresholds.sentences().items()
    lights = [Paragraph(words, f"{light_words(light)}.", MARKS[light]) for light, words in sentences]
    end = Paragraph("These thresholds are a convention of this report, not of a code of practice.")
    return ReportSection("What the lights mean", [*lights, end])


def _shaking(assessment: Assessment) -> ReportSection:
    hazard = assessment.hazard
    low, high = hazard.velocity()
    blocks = [
        Paragraph(
            f"{hazard.source[:1].upper()}{hazard.source[1:]}; {hazard.words()}, PGV {low:.3g} to {high:.3g} m/s."
        ),
        Paragraph(
            f"Impacts by {assessment.restitution}; beside it {' and '.join(assessment.comparisons)}. Where they show "
            "different lights, the loss of energy at an impact decides, and the most careful is the prudent choice."
        ),
    ]
    if hazard.synthetic:
        plain = hazard.description
        origin = f"Generator: {plain['generator']}. Parameters: {plain['origin']}."
        blocks.insert(1, Paragraph(f"{origin} The same family, count and seed give the same motions."))
    if assessment.ignored:
        blocks.append(Paragraph(", ".join(assessment.ignored), "Columns of the list that were not read:"))
    return ReportSection("The shaking", blocks)
