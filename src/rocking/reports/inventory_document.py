"""The report of an inventory: the ranked table with its lights, the plan, and what they do and do not say."""

from collections.abc import Mapping, Sequence

from rocking.conventions import g
from rocking.language import Language
from rocking.motions.summary import provenance_rows, summaries_of
from rocking.reports.document import (
    Block,
    Cell,
    Document,
    Paragraph,
    Picture,
    ReportSection,
    ReportTable,
    made_with,
    table,
)
from rocking.statistics.counts import share_interval
from rocking.studies.inventory.assessment import Assessment, DirectionResult, Verdict
from rocking.studies.inventory.lights import LIGHT_MARKS, Light
from rocking.studies.inventory.table import (
    DIRECTION_NAMES,
    PLAN_NOTE,
    advice,
    limits,
    model_note,
    named,
    noted,
    plan_header,
    plan_row,
    rotation_words,
    rounded_down,
    sentence,
    sliding,
    stated,
    untranslated,
    words_of,
)

MARKS = {Light.GREEN: "good", Light.AMBER: "fair", Light.RED: "bad"}
"""Colour of a light; its letter and its word stand beside."""

_MOST_NAMED = 5
MOST_DRAWN = 25
"""Objects in the picture at the head; beyond it a second one shows how all are distributed."""

GLANCE, SHARES = "glance", "shares"
"""Stems of the pictures at the head."""


def inventory_document(
    assessment: Assessment, photos: Mapping[int, str] | None = None, pictures: Sequence[str] = ()
) -> Document:
    """Return the report of an inventory; photos: names of small pictures by the place of the object.

    Pictures are the stems of those that are drawn, of `GLANCE` and `SHARES`.
    """
    say, sections = words_of(assessment), _Sections(assessment, photos or {})
    level = assessment.hazard.words(say.code)
    every = [
        sections.glance(pictures), sections.ranking(), sections.plan(), sections.refused(), sections.others(),
        sections.numbers(), sections.meaning(),
        sections.shaking(), ReportSection(say("What is not covered"), [Paragraph(each) for each in limits(assessment)]),
    ]  # fmt: skip
    return Document(
        say("Which objects stay standing"),
        say(
            "{source}: {count} object assessed at {level}",
            "{source}: {count} objects assessed at {level}",
            source=assessment.source,
            count=len(assessment.verdicts),
            level=level,
        ),
        [section for section in every if section.blocks],
        look_at=look_at(assessment),
        provenance={
            say("Made with"): made_with()["Made with"],
            say("Restitution"): assessment.restitution,
        },
        language=say.code,
        look_at_title=say("What to look at"),
        sections_title=say("Sections"),
    )


def light_mark(light: Light, say: Language) -> str:
    """Return a light for eyes that do not see its colour.

    >>> from rocking.language import language
    >>> light_mark(Light.RED, language("en"))
    'RED'
    """
    return say(LIGHT_MARKS[light])


def look_at(assessment: Assessment) -> list[tuple[str, str]]:
    """Return what to look at first: a short name and a sentence each."""
    say, rows = words_of(assessment), {light.word: number for light, number in assessment.counts().items()}
    lights, refused = say("{red} red, {amber} amber, {green} green", **rows), len(assessment.not_assessed)
    pieces = {light.word: number for light, number in assessment.pieces().items()}
    if pieces != rows:
        lights = say(
            "{counts} ({pieces} pieces: {red} red, {amber} amber, {green} green)",
            counts=lights,
            pieces=sum(pieces.values()),
            **pieces,
        )
    if refused:
        lights = say("{counts}, {count} not assessed", counts=lights, count=refused)
    lines = [(say("The lights"), lights)]
    red = [verdict.item.label for verdict in assessment.verdicts if verdict.light is Light.RED]
    if red:
        names, more = ", ".join(red[:_MOST_NAMED]), len(red) - _MOST_NAMED
        names = say("{names} and {count} more", names=names, count=more) if more > 0 else names
        lines.append((say("First of all"), names))
    undecided = sum(verdict.model_decides for verdict in assessment.verdicts)
    if undecided:
        sentence_on_models = say(
            "for {count} object the other model of impact shows another light",
            "for {count} objects the other model of impact shows another light",
            count=undecided,
        )
        lines.append((say("The model decides"), sentence_on_models))
    if words := untranslated(assessment):
        lines.append((say("Language"), words))
    return [*lines, (say("Not covered"), sliding(assessment))]


class _Sections:
    """The sections of the report, in its language."""

    def __init__(self, assessment: Assessment, photos: Mapping[int, str]) -> None:
        self.assessment, self.photos, self.say = assessment, photos, words_of(assessment)

    def glance(self, pictures: Sequence[str]) -> ReportSection:
        """Return the pictures of all objects, or of the worst and of how all are distributed."""
        say, count, level = self.say, len(self.assessment.verdicts), 100.0 * self.assessment.thresholds.level
        worst = say(
            "Each object, the worst on top: the fraction of motions that overturn it with its "
            "{level:.10g}% interval (left), and the acceleration up to which it stays still "
            "(right).",
            level=level,
        )
        if count > MOST_DRAWN:
            worst = say(
                "The worst {shown} of {count} objects: the fraction of motions that overturn each with "
                "its {level:.10g}% interval (left), and the acceleration up to which it stays still "
                "(right).",
                shown=MOST_DRAWN,
                count=count,
                level=level,
            )
        captions = {
            GLANCE: worst,
            SHARES: say(
                "All {count} objects: how many of them are overturned by which fraction of the motions "
                "(left), and how many stay still up to which acceleration (right), by light.",
                count=count,
            ),
        }
        return ReportSection(say("At a glance"), [Picture(stem, captions[stem]) for stem in pictures])

    def ranking(self) -> ReportSection:
        say, rows = self.say, [self._ranked(*each) for each in enumerate(self.assessment.verdicts)]
        header = ["", say("light"), say("object"), say("what it does"), say("what to do")]
        nothing = Paragraph(say("No row could be assessed."), mark="bad")
        ranked = table(say("The worst first"), header, rows, stem="ranking")
        return ReportSection(say("The objects"), [ranked if rows else nothing])

    def _ranked(self, place: int, verdict: Verdict) -> list[object]:
        say, item = self.say, verdict.item
        words = [sentence(verdict, self.assessment), noted(verdict, self.assessment)]
        if item.photo is not None and not self.photos.get(place):
            words.append(say("Its photo {file} cannot be shown.", file=item.photo.name))
        what_to_do = f"{advice(verdict, self.assessment)} {model_note(verdict, self.assessment)}"
        shown = Cell(named(verdict, say), picture=self.photos.get(place, ""))
        return [place + 1, self._light(verdict.light), shown, " ".join(filter(None, words)), what_to_do.strip()]

    def _light(self, light: Light, mark: str | None = None) -> Cell:
        return Cell(light_mark(light, self.say), MARKS[light] if mark is None else mark)

    def plan(self) -> ReportSection:
        say, assessment = self.say, self.assessment
        header = [say("object"), *plan_header(say)]
        rows = [[each.item.label, *map(self._figure, plan_row(each, say))] for each in assessment.plan]
        weights = {name: 1.0 / assessment.thresholds.factor(name) for name in ("low", "high")}
        lead = Paragraph(
            say(
                "Sorted by gain: the number of pieces that fall less, as expected, times the weight of "
                "a fall (of low consequence {low:g}, of medium 1, of high {high:g}: a convention of "
                "this report). Any one of the measures makes the object green: changed so, it was "
                "computed again under the same motions.",
                **weights,
            )
        )
        plan = table(
            say("Measures by gain"),
            header,
            rows,
            say(PLAN_NOTE),
            "plan",
        )
        return ReportSection(say("What to do first"), [lead, plan])

    def _figure(self, value: str | float) -> str:
        return value if isinstance(value, str) else self.say.number(f"{value:.6g}")

    def refused(self) -> ReportSection:
        say = self.say
        rows = [(each.row or "", each.label, say(each.reason)) for each in self.assessment.not_assessed]
        lead = Paragraph(
            say(
                "{count} row of the list could not be assessed; the others are not affected.",
                "{count} rows of the list could not be assessed; the others are not affected.",
                count=len(rows),
            ),
            mark="bad",
        )
        reasons = table(say("Rows and reasons"), [say("line"), say("object"), say("why")], rows, stem="not_assessed")
        return ReportSection(say("Not assessed"), [lead, reasons] if rows else [])

    def others(self) -> ReportSection:
        """Return the lines of the list that are no objects, and why."""
        say, others = self.say, self.assessment.not_objects
        rows = [(each.row, each.name, say(each.reason)) for each in others]
        reasons = table(
            say("Lines and reasons"), [say("line"), say("what it says"), say("why")], rows, stem="not_objects"
        )
        return ReportSection(
            say("Lines that are not objects"),
            [Paragraph(say("These lines of the list are not objects. Check that none of them should be.")), reasons]
            if rows
            else [],
        )

    def numbers(self) -> ReportSection:
        say, assessment = self.say, self.assessment
        header = [
            say("object"),
            say("along"),
            say("light"),
            say("stays still up to [g]"),
            say("lifted [%]"),
            say("overturned"),
            say("{level:.10g}% interval [%]", level=100.0 * assessment.thresholds.level),
            say("median"),
            say("84 %"),
            *(say("light by {name}", name=name) for name in assessment.comparisons),
        ]
        rows = [
            self._numbered(each, one, others)
            for each in assessment.verdicts
            for one, *others in zip(each.results, *each.compared, strict=True)
        ]
        note = say(
            "Stays still: horizontal acceleration g b/h below which nothing moves. Median, 84 %: "
            "quantiles of the peak rotation over the slenderness angle; beyond 1 the centre of mass"
            " has passed the foot. Interval: Clopper and Pearson's, of the probability that it "
            "overturns. Impacts by {restitution}; both directions are given.",
            restitution=assessment.restitution,
        )
        numbers = table(say("Every object in both directions"), header, rows, note, "numbers")
        return ReportSection(say("The numbers"), [numbers] if rows else [])

    def _numbered(self, verdict: Verdict, one: DirectionResult, others: Sequence[DirectionResult]) -> list[object]:
        say, level = self.say, self.assessment.thresholds.level
        low, high = share_interval(one.overturned, one.count, level)
        along = say(DIRECTION_NAMES[one.direction])
        still, lifted = say.number(rounded_down(one.uplift_acceleration / g, 3)), f"{100.0 * one.lifted_share:.0f}"
        shares = (
            say("{overturned} of {count}", overturned=one.overturned, count=one.count),
            say("{low:.1f} to {high:.1f}", low=100.0 * low, high=100.0 * high),
        )
        rotations = rotation_words(one.median_rotation, say), rotation_words(one.high_rotation, say)
        beside = [self._light(each.light, "plain" if each.light is one.light else None) for each in others]
        along = say("{way} (worse)", way=along) if one is verdict.worse else along
        return [verdict.item.label, along, self._light(one.light), still, lifted, *shares, *rotations, *beside]

    def meaning(self) -> ReportSection:
        say, thresholds = self.say, self.assessment.thresholds
        sentences = thresholds.sentences(say.code).items()
        lights = [Paragraph(words, f"{light_mark(light, say)}.", MARKS[light]) for light, words in sentences]
        return ReportSection(say("What the lights mean"), [*lights, *map(Paragraph, thresholds.conventions(say.code))])

    def shaking(self) -> ReportSection:
        say, assessment, hazard = self.say, self.assessment, self.assessment.hazard
        low, high = hazard.velocity()
        source, (first, *rest) = say(hazard.source), assessment.comparisons
        others = say("{one} and {other}", one=first, other=rest[0]) if rest else first
        facts = {"restitution": assessment.restitution, "others": others}
        impacts = say(
            "Impacts by {restitution}; beside it {others}. Where they show different lights, the loss of energy at an "
            "impact decides, and the most careful is the prudent choice.",
            **facts,
        )
        if assessment.drawn:
            impacts = say(
                "Impacts by {restitution}, drawn for every motion; beside it {others}. Where they show different "
                "lights, the loss of energy at an impact decides, and the most careful is the prudent choice.",
                **facts,
            )
        source, level = f"{source[:1].upper()}{source[1:]}", hazard.words(say.code)
        motions = say(
            "{source}; {level}, PGV {low:.3g} to {high:.3g} m/s.", source=source, level=level, low=low, high=high
        )
        blocks: list[Block] = [
            Paragraph(motions),
            Paragraph(impacts),
        ]
        if hazard.synthetic:
            origin = {name: say(hazard.description[name]) for name in ("generator", "origin")}
            words = (
                "Generator: {generator}. Parameters: {origin}. The same family, count and seed give the same motions."
            )
            blocks.insert(1, Paragraph(say(words, **origin)))
        if not hazard.synthetic:
            blocks.append(self._sources())
        if assessment.ignored:
            blocks.append(Paragraph(", ".join(assessment.ignored), say("Columns of the list that were not read:")))
        if words := stated(assessment):
            blocks.append(Paragraph(words))
        return ReportSection(say("The shaking"), blocks)

    def _sources(self) -> ReportTable:
        """Return the source and the processing steps of the records."""
        say, rows = self.say, provenance_rows(summaries_of(self.assessment.hazard.motions))
        header = [say("motion"), say("source and processing steps, in order")]
        return table(say("Source and processing of the records"), header, rows)
