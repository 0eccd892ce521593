"""The report of an inventory: the ranked table with its lights, and what they do and do not say."""

from rocking.conventions import g
from rocking.reports.document import Cell, Document, Paragraph, ReportSection, ReportTable, cell, made_with
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
    table = ReportTable("The worst first", header, rows, stem="ranking")
    return ReportSection("The objects", [table] if rows else [Paragraph("No row could be assessed.", mark="bad")])


def _ranked(rank: int, verdict: Verdict, assessment: Assessment) -> list[Cell]:
    item = verdict.item
    name = item.name + (f" (x {item.count})" if item.count > 1 else "") + (f", {item.note}" if item.note else "")
    what_to_do = f"{advice(verdict, assessment)} {model_note(verdict, assessment)}".strip()
    light = cell(light_words(verdict.light), MARKS[verdict.light])
    return [cell(rank), light, cell(name), cell(sentence(verdict, assessment)), cell(what_to_do)]


def _not_assessed(assessment: Assessment) -> ReportSection:
    rows = [[cell(each.row or ""), cell(each.name), cell(each.reason)] for each in assessment.not_assessed]
    count = len(rows)
    lead = Paragraph(
        f"{count} row{'' if count == 1 else 's'} of the list could not be assessed; the others are not affected.",
        mark="bad",
    )
    return ReportSection(
        "Not assessed", [lead, ReportTable("Rows and reasons", ["line", "object", "why"], rows, stem="not_assessed")]
    )


def _numbers(assessment: Assessment) -> ReportSection:
    header = [
        "object", "along", "light", "stays still up to [g]", "lifted [%]", "overturned",
        f"{percent(assessment.thresholds.level)} interval [%]", "median", "84 %", f"light by {assessment.comparison}",
    ]  # fmt: skip
    pairs = [
        (each, one, two) for each in assessment.verdicts for one, two in zip(each.results, each.compared, strict=True)
    ]
    rows = [_numbered(*pair, assessment) for pair in pairs]
    note = (
        "Stays still: horizontal acceleration g b/h below which nothing moves. Median, 84 %: quantiles of the peak "
        "rotation over the slenderness angle; beyond 1 the centre of mass has passed the foot. Interval: Clopper and "
        f"Pearson's, of the share that overturns. Impacts by {assessment.restitution}; both directions are given."
    )
    return ReportSection(
        "The numbers", [ReportTable("Every object in both directions", header, rows, note, "numbers")] if rows else []
    )


def _numbered(verdict: Verdict, one: DirectionResult, two: DirectionResult, assessment: Assessment) -> list[Cell]:
    low, high = share_interval(one.overturned, one.count, assessment.thresholds.level)
    worse = " (worse)" if one is verdict.worse else ""
    return [
        cell(verdict.item.name),
        cell(f"{one.direction}{worse}"),
        cell(light_words(one.light), MARKS[one.light]),
        cell(rounded_down(one.uplift_acceleration / g, 3)),
        cell(f"{100.0 * one.lifted_share:.0f}"),
        cell(f"{one.overturned} of {one.count}"),
        cell(f"{100.0 * low:.1f} to {100.0 * high:.1f}"),
        cell(rotation_words(one.median_rotation)),
        cell(rotation_words(one.high_rotation)),
        cell(light_words(two.light), MARKS[two.light] if two.light is not one.light else "plain"),
    ]


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
            f"Impacts by {assessment.restitution}; beside it {assessment.comparison}. Where the two show different "
            "lights, the loss of energy at an impact decides, and the more careful of the two is the prudent choice."
        ),
    ]
    if hazard.synthetic:
        plain = hazard.description
        origin = f"Generator: {plain['generator']}. Parameters: {plain['origin']}."
        blocks.insert(1, Paragraph(f"{origin} The same family, count and seed give the same motions."))
    if assessment.ignored:
        blocks.append(Paragraph(", ".join(assessment.ignored), "Columns of the list that were not read:"))
    return ReportSection("The shaking", blocks)
