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
from rocking.studies.inventory.lights import Light
from rocking.studies.inventory.table import (
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
        sections.shaking(), ReportSection(say("report.limits"), [Paragraph(each) for each in limits(assessment)]),
    ]  # fmt: skip
    return Document(
        say("report.title"),
        say("report.subtitle", source=assessment.source, count=len(assessment.verdicts), level=level),
        [section for section in every if section.blocks],
        look_at=look_at(assessment),
        provenance={
            say("report.made_with"): made_with()["Made with"],
            say("report.restitution"): assessment.restitution,
        },
        language=say.code,
        look_at_title=say("report.look_at"),
        sections_title=say("report.sections"),
    )


def light_mark(light: Light, say: Language) -> str:
    """Return a light for eyes that do not see its colour.

    >>> from rocking.language import language
    >>> light_mark(Light.RED, language("en"))
    'RED'
    """
    return say(f"mark.{light.word}")


def look_at(assessment: Assessment) -> list[tuple[str, str]]:
    """Return what to look at first: a short name and a sentence each."""
    say, rows = words_of(assessment), {light.word: number for light, number in assessment.counts().items()}
    lights, refused = say("report.counts", **rows), len(assessment.not_assessed)
    pieces = {light.word: number for light, number in assessment.pieces().items()}
    if pieces != rows:
        lights = say("report.pieces", counts=lights, pieces=sum(pieces.values()), **pieces)
    if refused:
        lights = say("report.counts_refused", counts=lights, count=refused)
    lines = [(say("report.lights"), lights)]
    red = [verdict.item.label for verdict in assessment.verdicts if verdict.light is Light.RED]
    if red:
        names, more = ", ".join(red[:_MOST_NAMED]), len(red) - _MOST_NAMED
        lines.append((say("report.first"), say("report.names_more", names=names, count=more) if more > 0 else names))
    undecided = sum(verdict.model_decides for verdict in assessment.verdicts)
    if undecided:
        lines.append((say("report.decides"), say("report.undecided", count=undecided)))
    if say.asked != say.code:
        lines.append((say("report.language"), say("no_words", code=say.asked)))
    return [*lines, (say("report.not_covered"), sliding(assessment))]


class _Sections:
    """The sections of the report, in its language."""

    def __init__(self, assessment: Assessment, photos: Mapping[int, str]) -> None:
        self.assessment, self.photos, self.say = assessment, photos, words_of(assessment)

    def _header(self, *names: str) -> list[str]:
        return [self.say(f"report.columns.{name}") for name in names]

    def glance(self, pictures: Sequence[str]) -> ReportSection:
        """Return the pictures of all objects, or of the worst and of how all are distributed."""
        say, count, level = self.say, len(self.assessment.verdicts), 100.0 * self.assessment.thresholds.level
        worst = say("report.glance_all", level=level)
        if count > MOST_DRAWN:
            worst = say("report.glance_worst", shown=MOST_DRAWN, count=count, level=level)
        captions = {GLANCE: worst, SHARES: say("report.glance_shares", count=count)}
        return ReportSection(say("report.glance"), [Picture(stem, captions[stem]) for stem in pictures])

    def ranking(self) -> ReportSection:
        say, rows = self.say, [self._ranked(*each) for each in enumerate(self.assessment.verdicts)]
        header = ["", *self._header("light", "object", "does", "do")]
        nothing = Paragraph(say("report.nothing"), mark="bad")
        ranked = table(say("report.worst"), header, rows, stem="ranking")
        return ReportSection(say("report.objects"), [ranked if rows else nothing])

    def _ranked(self, place: int, verdict: Verdict) -> list[object]:
        say, item = self.say, verdict.item
        words = [sentence(verdict, self.assessment), noted(verdict, self.assessment)]
        if item.photo is not None and not self.photos.get(place):
            words.append(say("report.no_photo", file=item.photo.name))
        what_to_do = f"{advice(verdict, self.assessment)} {model_note(verdict, self.assessment)}"
        shown = Cell(named(verdict, say), picture=self.photos.get(place, ""))
        return [place + 1, self._light(verdict.light), shown, " ".join(filter(None, words)), what_to_do.strip()]

    def _light(self, light: Light, mark: str | None = None) -> Cell:
        return Cell(light_mark(light, self.say), MARKS[light] if mark is None else mark)

    def plan(self) -> ReportSection:
        say, assessment = self.say, self.assessment
        header = [*self._header("object"), *plan_header(say)]
        rows = [[each.item.label, *map(self._figure, plan_row(each, say))] for each in assessment.plan]
        weights = {name: 1.0 / assessment.thresholds.factor(name) for name in ("low", "high")}
        lead = Paragraph(say("plan.lead", **weights))
        plan = table(say("plan.caption"), header, rows, say("plan.note"), "plan")
        return ReportSection(say("plan.title"), [lead, plan])

    def _figure(self, value: str | float) -> str:
        return value if isinstance(value, str) else self.say.number(f"{value:.6g}")

    def refused(self) -> ReportSection:
        say = self.say
        rows = [(each.row or "", each.label, say.translated(each.reason)) for each in self.assessment.not_assessed]
        lead = Paragraph(say("report.refused_lead", count=len(rows)), mark="bad")
        reasons = table(say("report.reasons"), self._header("line", "object", "why"), rows, stem="not_assessed")
        return ReportSection(say("report.refused"), [lead, reasons] if rows else [])

    def others(self) -> ReportSection:
        """Return the lines of the list that are no objects, and why."""
        say, others = self.say, self.assessment.not_objects
        rows = [(each.row, each.name, say.translated(each.reason)) for each in others]
        reasons = table(say("report.others_reasons"), self._header("line", "text", "why"), rows, stem="not_objects")
        return ReportSection(say("report.others"), [Paragraph(say("report.others_lead")), reasons] if rows else [])

    def numbers(self) -> ReportSection:
        say, assessment = self.say, self.assessment
        header = [
            *self._header("object", "along", "light", "still", "lifted", "overturned"),
            say("report.columns.interval", level=100.0 * assessment.thresholds.level),
            *self._header("median", "high"),
            *(say("report.columns.other", name=name) for name in assessment.comparisons),
        ]
        rows = [
            self._numbered(each, one, others)
            for each in assessment.verdicts
            for one, *others in zip(each.results, *each.compared, strict=True)
        ]
        note = say("report.numbers_note", restitution=assessment.restitution)
        numbers = table(say("report.both"), header, rows, note, "numbers")
        return ReportSection(say("report.numbers"), [numbers] if rows else [])

    def _numbered(self, verdict: Verdict, one: DirectionResult, others: Sequence[DirectionResult]) -> list[object]:
        say, level = self.say, self.assessment.thresholds.level
        low, high = share_interval(one.overturned, one.count, level)
        along = say(f"direction.{one.direction}")
        still, lifted = say.number(rounded_down(one.uplift_acceleration / g, 3)), f"{100.0 * one.lifted_share:.0f}"
        shares = (
            say("report.overturned", overturned=one.overturned, count=one.count),
            say("interval", low=100.0 * low, high=100.0 * high),
        )
        rotations = rotation_words(one.median_rotation, say), rotation_words(one.high_rotation, say)
        beside = [self._light(each.light, "plain" if each.light is one.light else None) for each in others]
        along = say("report.worse", way=along) if one is verdict.worse else along
        return [verdict.item.label, along, self._light(one.light), still, lifted, *shares, *rotations, *beside]

    def meaning(self) -> ReportSection:
        say, thresholds = self.say, self.assessment.thresholds
        sentences = thresholds.sentences(say.code).items()
        lights = [Paragraph(words, f"{light_mark(light, say)}.", MARKS[light]) for light, words in sentences]
        return ReportSection(say("report.meaning"), [*lights, *map(Paragraph, thresholds.conventions(say.code))])

    def shaking(self) -> ReportSection:
        say, assessment, hazard = self.say, self.assessment, self.assessment.hazard
        low, high = hazard.velocity()
        source, (first, *rest) = say.translated(hazard.source), assessment.comparisons
        others = say("report.and", one=first, other=rest[0]) if rest else first
        impacts = "report.impacts_drawn" if assessment.drawn else "report.impacts"
        source, level = f"{source[:1].upper()}{source[1:]}", hazard.words(say.code)
        motions = say("report.hazard", source=source, level=level, low=low, high=high)
        blocks: list[Block] = [
            Paragraph(motions),
            Paragraph(say(impacts, restitution=assessment.restitution, others=others)),
        ]
        if hazard.synthetic:
            origin = {name: say.translated(hazard.description[name]) for name in ("generator", "origin")}
            blocks.insert(1, Paragraph(say("report.origin", **origin)))
        if not hazard.synthetic:
            blocks.append(self._sources())
        if assessment.ignored:
            blocks.append(Paragraph(", ".join(assessment.ignored), say("report.ignored")))
        if words := stated(assessment):
            blocks.append(Paragraph(words))
        return ReportSection(say("report.shaking"), blocks)

    def _sources(self) -> ReportTable:
        """Return the source and the processing steps of the records."""
        rows = provenance_rows(summaries_of(self.assessment.hazard.motions))
        return table(self.say("report.sources"), self._header("motion", "source"), rows)
