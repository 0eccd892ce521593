"""Report of an inventory: ranked table with ratings, plan of measures, and limitations."""

from collections.abc import Mapping, Sequence

from rocking.conventions import g
from rocking.decision.inventory.assessment import Assessment, DirectionResult, Verdict
from rocking.decision.inventory.lights import LIGHT_MARKS, Light
from rocking.decision.inventory.ranking import (
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
    software_and_data,
    table,
)
from rocking.statistics.counts import share_interval

MARKS = {Light.GREEN: "good", Light.AMBER: "fair", Light.RED: "bad"}
"""Colour of a rating. Letter and word of the rating are next to the colour."""

_MOST_NAMED = 5
MOST_DRAWN = 25
"""Maximum number of objects in the first picture. For more objects, a second picture shows the distribution."""

GLANCE, SHARES = "glance", "shares"
"""Stems of the pictures at the top."""


def inventory_document(
    assessment: Assessment, photos: Mapping[int, str] | None = None, pictures: Sequence[str] = ()
) -> Document:
    """Return the report of an inventory.

    `photos` contains file names of thumbnails by index of the object. `pictures` contains the available stems of
    `GLANCE` and `SHARES`.
    """
    say, sections = words_of(assessment), _Sections(assessment, photos or {})
    level = assessment.hazard.words(say.code)
    candidates = [
        sections.glance(pictures), sections.ranking(), sections.plan(), sections.refused(), sections.others(),
        sections.numbers(), sections.meaning(),
        sections.shaking(), ReportSection(say("Limitations"), [Paragraph(text) for text in limits(assessment)]),
    ]  # fmt: skip
    return Document(
        say("Overturning of objects in earthquakes"),
        say(
            "{source}: {count} object assessed at {level}",
            "{source}: {count} objects assessed at {level}",
            source=assessment.source,
            count=len(assessment.verdicts),
            level=level,
        ),
        [section for section in candidates if section.blocks],
        look_at=look_at(assessment),
        provenance={
            say("Software"): software_and_data()["Software"],
            say("Restitution"): assessment.restitution,
        },
        language=say.code,
        look_at_title=say("Main points"),
        sections_title=say("Sections"),
    )


def light_mark(light: Light, say: Language) -> str:
    """Return a rating as text, for readers who do not see its colour.

    >>> from rocking.language import language
    >>> light_mark(Light.RED, language("en"))
    'RED'
    """
    return say(LIGHT_MARKS[light])


def look_at(assessment: Assessment) -> list[tuple[str, str]]:
    """Return the main points: a short name and a sentence per point."""
    say, objects = words_of(assessment), {light.word: number for light, number in assessment.counts().items()}
    lights, refused = say("{red} red, {amber} amber, {green} green", **objects), len(assessment.not_assessed)
    pieces = {light.word: number for light, number in assessment.pieces().items()}
    if pieces != objects:
        lights = say(
            "{counts} ({pieces} pieces: {red} red, {amber} amber, {green} green)",
            counts=lights,
            pieces=sum(pieces.values()),
            **pieces,
        )
    if refused:
        lights = say("{counts}, {count} not assessed", counts=lights, count=refused)
    lines = [(say("Ratings"), lights)]
    red = [verdict.item.label for verdict in assessment.verdicts if verdict.light is Light.RED]
    if red:
        names, more = ", ".join(red[:_MOST_NAMED]), len(red) - _MOST_NAMED
        names = say("{names} and {count} more", names=names, count=more) if more > 0 else names
        lines.append((say("Highest priority"), names))
    undecided = sum(verdict.depends_on_model for verdict in assessment.verdicts)
    if undecided:
        sentence_on_models = say(
            "the rating of {count} object changes with the restitution model",
            "the rating of {count} objects changes with the restitution model",
            count=undecided,
        )
        lines.append((say("The result depends on the restitution model"), sentence_on_models))
    if language_note := untranslated(assessment):
        lines.append((say("Language"), language_note))
    return [*lines, (say("Not covered"), sliding(assessment))]


class _Sections:
    """The sections of the report, in its language."""

    def __init__(self, assessment: Assessment, photos: Mapping[int, str]) -> None:
        self.assessment, self.photos, self.say = assessment, photos, words_of(assessment)

    def glance(self, pictures: Sequence[str]) -> ReportSection:
        """Return the picture of all objects, or pictures of the worst objects and the distribution of all objects."""
        say, count, level = self.say, len(self.assessment.verdicts), 100.0 * self.assessment.thresholds.level
        worst = say(
            "All objects, the worst at the top: fraction of motions with overturning and its {level:.10g}% interval "
            "(left), and acceleration without uplift (right).",
            level=level,
        )
        if count > MOST_DRAWN:
            worst = say(
                "The worst {shown} of {count} objects: fraction of motions with overturning and its {level:.10g}% "
                "interval (left), and acceleration without uplift (right).",
                shown=MOST_DRAWN,
                count=count,
                level=level,
            )
        captions = {
            GLANCE: worst,
            SHARES: say(
                "Distribution of all {count} objects by rating: fraction of motions with overturning (left), and "
                "acceleration without uplift (right).",
                count=count,
            ),
        }
        return ReportSection(say("Overview"), [Picture(stem, captions[stem]) for stem in pictures])

    def ranking(self) -> ReportSection:
        say, rows = self.say, [self._ranked(*numbered) for numbered in enumerate(self.assessment.verdicts)]
        header = ["", say("rating"), say("object"), say("response"), say("measure")]
        nothing = Paragraph(say("No row could be assessed."), mark="bad")
        ranked = table(say("Ranking, worst object first"), header, rows, stem="ranking")
        return ReportSection(say("Objects"), [ranked if rows else nothing])

    def _ranked(self, index: int, verdict: Verdict) -> list[object]:
        say, item = self.say, verdict.item
        sentences = [sentence(verdict, self.assessment), noted(verdict, self.assessment)]
        if item.photo is not None and not self.photos.get(index):
            sentences.append(say("The photo {file} cannot be shown.", file=item.photo.name))
        measures = f"{advice(verdict, self.assessment)} {model_note(verdict, self.assessment)}"
        object_cell = Cell(named(verdict, say), picture=self.photos.get(index, ""))
        return [
            index + 1,
            self._light(verdict.light),
            object_cell,
            " ".join(filter(None, sentences)),
            measures.strip(),
        ]

    def _light(self, light: Light, mark: str | None = None) -> Cell:
        return Cell(light_mark(light, self.say), MARKS[light] if mark is None else mark)

    def plan(self) -> ReportSection:
        say, assessment = self.say, self.assessment
        header = [say("object"), *plan_header(say)]
        rows = [[measure.item.label, *map(self._figure, plan_row(measure, say))] for measure in assessment.plan]
        weights = {name: 1.0 / assessment.thresholds.factor(name) for name in ("low", "high")}
        lead = Paragraph(
            say(
                "Sorted by gain: the expected number of prevented falls times the weight of a fall. The weight of a "
                "low consequence is {low:g}, of a medium one 1, of a high one {high:g}; these weights are a convention "
                "of this report. Any one of the measures makes the object green. The changed object was computed under "
                "the same motions.",
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
        return ReportSection(say("Plan of measures"), [lead, plan])

    def _figure(self, value: str | float) -> str:
        return value if isinstance(value, str) else self.say.number(f"{value:.6g}")

    def refused(self) -> ReportSection:
        say = self.say
        rows = [(row.row or "", row.label, say(row.reason)) for row in self.assessment.not_assessed]
        lead = Paragraph(
            say(
                "{count} row of the list could not be assessed; the others are not affected.",
                "{count} rows of the list could not be assessed; the others are not affected.",
                count=len(rows),
            ),
            mark="bad",
        )
        reasons = table(say("Rows and reasons"), [say("line"), say("object"), say("reason")], rows, stem="not_assessed")
        return ReportSection(say("Not assessed"), [lead, reasons] if rows else [])

    def others(self) -> ReportSection:
        """Return the lines of the list that are not objects, with the reasons."""
        say, others = self.say, self.assessment.not_objects
        rows = [(line.row, line.name, say(line.reason)) for line in others]
        reasons = table(
            say("Lines and reasons"), [say("line"), say("content"), say("reason")], rows, stem="not_objects"
        )
        return ReportSection(
            say("Lines that are not objects"),
            [Paragraph(say("These lines of the list are not objects. Check them.")), reasons] if rows else [],
        )

    def numbers(self) -> ReportSection:
        say, assessment = self.say, self.assessment
        header = [
            say("object"),
            say("direction"),
            say("rating"),
            say("largest PGA without uplift [g]"),
            say("uplift [%]"),
            say("overturned"),
            say("{level:.10g}% interval [%]", level=100.0 * assessment.thresholds.level),
            say("median"),
            say("84 %"),
            *(say("rating with {name}", name=name) for name in assessment.comparisons),
        ]
        rows = [
            self._numbered(verdict, result, others)
            for verdict in assessment.verdicts
            for result, *others in zip(verdict.results, *verdict.compared, strict=True)
        ]
        note = say(
            "No uplift below: horizontal acceleration g b/h. Median, 84 %: quantiles of the peak rotation over the "
            "slenderness angle; above 1 the centre of mass has passed the foot. Interval: Clopper and Pearson's "
            "interval of the probability of overturning. Restitution model: {restitution}. The table contains both "
            "directions.",
            restitution=assessment.restitution,
        )
        numbers = table(say("Every object in both directions"), header, rows, note, "numbers")
        return ReportSection(say("Numbers"), [numbers] if rows else [])

    def _numbered(self, verdict: Verdict, result: DirectionResult, others: Sequence[DirectionResult]) -> list[object]:
        say, level = self.say, self.assessment.thresholds.level
        low, high = share_interval(result.overturned, result.count, level)
        along = say(DIRECTION_NAMES[result.direction])
        still, lifted = (
            say.number(rounded_down(result.uplift_acceleration / g, 3)),
            f"{100.0 * result.lifted_fraction:.0f}",
        )
        shares = (
            say("{overturned} of {count}", overturned=result.overturned, count=result.count),
            say("{low:.1f} to {high:.1f}", low=100.0 * low, high=100.0 * high),
        )
        rotations = rotation_words(result.median_rotation, say), rotation_words(result.high_rotation, say)
        other_lights = [self._light(other.light, "plain" if other.light is result.light else None) for other in others]
        along = say("{way} (worse)", way=along) if result is verdict.worse else along
        return [verdict.item.label, along, self._light(result.light), still, lifted, *shares, *rotations, *other_lights]

    def meaning(self) -> ReportSection:
        say, thresholds = self.say, self.assessment.thresholds
        sentences = thresholds.sentences(say.code).items()
        lights = [Paragraph(text, f"{light_mark(light, say)}.", MARKS[light]) for light, text in sentences]
        return ReportSection(
            say("Meaning of the ratings"), [*lights, *map(Paragraph, thresholds.conventions(say.code))]
        )

    def shaking(self) -> ReportSection:
        say, assessment, hazard = self.say, self.assessment, self.assessment.hazard
        low, high = hazard.velocity()
        source, (first, *others_named) = say(hazard.source), assessment.comparisons
        others = say("{one} and {other}", one=first, other=others_named[0]) if others_named else first
        facts = {"restitution": assessment.restitution, "others": others}
        impacts = say(
            "Restitution model: {restitution}, compared with {others}. If the ratings differ, the result depends on "
            "the energy loss at an impact; use the most unfavourable rating.",
            **facts,
        )
        if assessment.drawn:
            impacts = say(
                "Restitution model: {restitution}, sampled for each motion, compared with {others}. If the ratings "
                "differ, the result depends on the energy loss at an impact; use the most unfavourable rating.",
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
            text = (
                "Generator: {generator}. Parameters: {origin}. The same family, count and seed give the same motions."
            )
            blocks.insert(1, Paragraph(say(text, **origin)))
        if not hazard.synthetic:
            blocks.append(self._sources())
        if assessment.ignored:
            blocks.append(Paragraph(", ".join(assessment.ignored), say("Ignored columns of the list:")))
        if text := stated(assessment):
            blocks.append(Paragraph(text))
        return ReportSection(say("Ground motions"), blocks)

    def _sources(self) -> ReportTable:
        """Return the source and the processing steps of the records."""
        say, rows = self.say, provenance_rows(summaries_of(self.assessment.hazard.motions))
        header = [say("motion"), say("source and processing steps, in order")]
        return table(say("Source and processing of the records"), header, rows)
