"""The ranked table as values for JSON and as text for CSV and spreadsheets, with translated sentences."""

import csv
import io
import math
from typing import Any

from rocking.answers import Answer
from rocking.conventions import g
from rocking.decision.inventory.assessment import Assessment, DirectionResult, Verdict
from rocking.decision.inventory.lights import LIGHT_NAMES, Light
from rocking.decision.inventory.objects import NotAssessed
from rocking.decision.inventory.retrofits import PlanEntry
from rocking.decision.remedies import rounded_up
from rocking.dynamics.settings import NEVER_SLIDES
from rocking.language import Language, language
from rocking.messages import Message
from rocking.tables import escaped

_TITLES = {
    "rank": Message("rank"),
    "rating": Message("rating"),
    "number": Message("inventory number"),
    "name": Message("name"),
    "count": Message("count"),
    "row": Message("row"),
    "direction": Message("worse direction"),
    "uplift": Message("uplift acceleration [g]"),
    "motions": Message("motions"),
    "lifted": Message("lifted"),
    "overturned": Message("overturned"),
    "low": Message("overturned, low [%]"),
    "high": Message("overturned, high [%]"),
    "median": Message("median of peak rotation / slenderness angle"),
    "quantile": Message("84 % quantile of peak rotation / slenderness angle"),
    "others": Message("rating with other models"),
    "words": Message("description"),
    "advice": Message("recommendation"),
    "note": Message("note"),
    "consequence": Message("consequence"),
    "remarks": Message("remarks"),
}
COLUMNS = tuple(_TITLES)
PLAN_TITLES = (
    Message("falls prevented"),
    Message("gain"),
    Message("base wider, each side [cm]"),
    Message("centre lower [cm]"),
    Message("by ballast [kg]"),
    Message("tension of the anchors of one edge / weight [-]"),
    Message("tension of the anchors of one edge [N]"),
    Message("horizontal force of all anchors / weight [-]"),
    Message("largest allowed shaking [%]"),
)
_WORDS = COLUMNS.index("words")

PLAN_NOTE = Message(
    "A wider base extends equally on both sides. Mass and moment of inertia about the centre of mass do not change. "
    "Ballast at the floor lowers the centre of mass. The mass and inertia of the ballast are included. Anchors, body "
    "and floor are rigid. The anchors of one edge pull vertically, and the other edge is the pivot. No safety factor "
    "is included. If the object is moved, the largest allowed PGA is a percentage of the PGA at the present location."
)
"""Definition of the measures of the plan."""

DIRECTION_NAMES = {"width": Message("width"), "depth": Message("depth")}
_CONSEQUENCES = {
    "low": Message("low", context="consequence"),
    "medium": Message("medium"),
    "high": Message("high", context="consequence"),
}

_NO_ROCKING = Message(
    "at {level} it does not rock in {motions}", many="at {level} it does not rock in any of {motions}"
)
_STILL = Message("at {level} no uplift in {motions}", many="at {level} no uplift in {motions}")
_OVERTURNS = Message(
    "at {level} it rocks, and overturns in {motions}",
    many="at {level} it rocks, and overturns in {overturned} of {motions}",
)
_ROCKS_BARELY = Message(
    "at {level} it rocks slightly, and does not overturn in {motions}",
    many="at {level} it rocks slightly, and overturns in 0 of {motions}",
)
_ROCKS_LITTLE = Message(
    "at {level} it rocks moderately, and does not overturn in {motions}",
    many="at {level} it rocks moderately, and overturns in 0 of {motions}",
)
_ROCKS = Message(
    "at {level} it rocks, and does not overturn in {motions}",
    many="at {level} it rocks, and overturns in 0 of {motions}",
)
_RECORDS = Message("the one record", many="{count} records")
_SIMULATED = Message("the one simulated earthquake", many="{count} simulated earthquakes")
# keys: (True if the base has the outer size, True with vertical motion)
_BASES = {
    (True, False): Message(
        "Secure it, lower its centre of mass, or widen its base: its {way} is {size:.3g} cm; {needed} cm "
        "prevent uplift."
    ),
    (False, False): Message(
        "Secure it, lower its centre of mass, or widen its base: its base is {size:.3g} cm along the {way}; "
        "{needed} cm prevent uplift."
    ),
    (True, True): Message("Secure it, lower its centre of mass, or widen its base: its {way} is {size:.3g} cm."),
    (False, True): Message(
        "Secure it, lower its centre of mass, or widen its base: its base is {size:.3g} cm along the {way}."
    ),
}

# assumptions in every report
_LIMITS = (
    Message(
        "Objects are rigid and free-standing on a rigid, level floor. The input motion must include the amplification"
        " of a building, a pedestal or a shelf."
    ),
    Message(
        "Each motion acts once along the width and once along the depth; the worse direction decides. Simultaneous "
        "rocking in both directions, twisting and rolling on the rim of a round base are not computed."
    ),
    Message(
        "Each direction is computed as a plane body with the outer dimensions and the base in the list. The default "
        "height of the centre of mass is half the height. An object with a friction coefficient or a body file is "
        "computed in 3D, by default with the default restitution model. No measurement exists for this case."
    ),
    Message(
        "By default the coefficient of restitution is uncertain: it is sampled for each motion from the calibrated "
        "model, including the scatter between bodies."
    ),
    Message("Approximate sizes are sampled for every motion, uniform within their intervals."),
    Message(
        "The slope of the floor, the horizontal position of the centre of mass and the model error are not sampled. "
        "`rocking predict` samples them, for one object; its probability of uplift can be much larger."
    ),
    Message("Impacts of neighbouring objects, loosening, and damage without overturning are not assessed."),
)


def header(say: Language) -> list[str]:
    """Return the titles of the table in files."""
    return [say(title) for title in _TITLES.values()] + plan_header(say)


def plan_header(say: Language) -> list[str]:
    """Return the titles of the columns of the plan."""
    return [say(title) for title in PLAN_TITLES]


def sliding(assessment: Assessment) -> str:
    """Return one or two sentences on the sliding of the objects."""
    slides = [verdict.friction < NEVER_SLIDES for verdict in assessment.verdicts]
    sentences = []
    if not slides or not all(slides):
        sentences.append(
            Message(
                "Sliding is not assessed without a coefficient of friction. An object on a smooth floor or shelf may "
                "slide before it rocks, and slide off its support."
            )
        )
    if any(slides):
        sentences.append(
            Message(
                "With a coefficient of friction, motions with sliding are counted, but the sliding distance is not "
                "computed. Check that objects cannot slide off their support."
            )
        )
    return " ".join(map(words_of(assessment), sentences))


def limits(assessment: Assessment) -> list[str]:
    """Return the assumptions of every report."""
    return [sliding(assessment), *map(words_of(assessment), _LIMITS)]


def rows(assessment: Assessment, code: str = "en") -> list[list[str | float | int]]:
    """Return one row per object with the titles of `header`: the worst object first, rows without a verdict last.

    Formulas are escaped. Sentences are in the language of the assessment, names of lights and directions in the
    language of the code.
    """
    say, own, plan = language(code), words_of(assessment), {id(entry.item): entry for entry in assessment.plan}
    lines: list[list[str | float | int]] = []
    for rank, verdict in enumerate(assessment.verdicts, start=1):
        worse, item, (low, high) = verdict.worse, verdict.item, verdict.interval
        lights = lights_by_model(verdict, assessment)[1:]
        others = "; ".join(f"{name}: {say(LIGHT_NAMES[light])}" for name, light in lights)
        rotations = (
            rotation_words(rotation, say) if rotation is None else round(rotation, 3)
            for rotation in (worse.median_rotation, worse.high_rotation)
        )
        measures = plan_row(plan[id(item)], say) if id(item) in plan else [""] * len(PLAN_TITLES)
        lines.append([
            rank, say(LIGHT_NAMES[verdict.light]), escaped(item.number), escaped(item.name), item.count, item.row,
            say(DIRECTION_NAMES[worse.direction]), round(verdict.uplift_acceleration / g, 4), worse.count, worse.lifted,
            worse.overturned, round(100.0 * low, 2), round(100.0 * high, 2), *rotations, others,
            sentence(verdict, assessment),
            f"{advice(verdict, assessment)} {model_note(verdict, assessment)}".strip(), escaped(item.note),
            say(_CONSEQUENCES[item.consequence]), escaped(remarks(verdict, assessment)), *measures,
        ])  # fmt: skip
    for refused in assessment.not_assessed:
        reason = own("not assessed: {reason}", reason=own(refused.reason))
        lines.append(_bare(refused, say("not assessed"), reason))
    skipped = (_bare(row, say("not an object"), own(row.reason)) for row in assessment.not_objects)
    return [*lines, *skipped]


def _bare(refused: NotAssessed, light: str, reason: str) -> list[str | float | int]:
    """Return a row without a verdict."""
    values: dict[str, str | int] = {
        "rating": light, "number": refused.number, "name": refused.name, "row": refused.row, "words": reason,
        "note": refused.note,
    }  # fmt: skip
    cells = [values.get(name, "") for name in COLUMNS]
    line: list[str | float | int] = [escaped(cell) if isinstance(cell, str) else cell for cell in cells]
    return line + [""] * len(PLAN_TITLES)


def plan_row(entry: PlanEntry, say: Language) -> list[str | float]:
    """Return the plan of an object, by `PLAN_TITLES`."""
    changes = (entry.wider, entry.lower, entry.weaker)
    wider, lower, moved = (say("not effective") if change is None else round(100.0 * change, 3) for change in changes)
    if entry.in_space:
        wider = lower = say("not computed")
    forces = (entry.ballast, entry.pull, entry.force, entry.shear)
    ballast, *anchors = ("" if force is None else rounded_up(force) for force in forces)
    return [round(entry.spared, 3), round(entry.gain, 3), wider, lower, ballast, *anchors, moved]


def plan_words(entry: PlanEntry, say: Language) -> str:
    """Return the alternative measures that make an object green, as a sentence."""
    assert entry.pull is not None
    options = []
    if entry.wider is not None:
        options.append(say("base {wider} cm wider on each side", wider=_demanded(100.0 * entry.wider, say)))
    if entry.lower is not None and entry.ballast is not None:
        options.append(
            say(
                "centre of mass {lower} cm lower (about {ballast} kg at the floor)",
                lower=_demanded(100.0 * entry.lower, say),
                ballast=_demanded(entry.ballast, say),
            )
        )
    elif entry.lower is not None:
        ballast = _demanded(entry.ballast_share or 0.0, say)
        options.append(
            say(
                "centre of mass {lower} cm lower (with ballast of {share} of its weight at the floor)",
                lower=_demanded(100.0 * entry.lower, say),
                share=ballast,
            )
        )
    if entry.weaker is not None:
        options.append(say("a location with at most {share:.0f} % of this shaking", share=100.0 * entry.weaker))
    if not options:
        options.append(say("Only anchors are effective"))
    weight = say("{share} times its weight", share=_demanded(entry.pull, say))
    pull = weight if entry.force is None else say("{force} N", force=_demanded(entry.force, say))
    if entry.pull or not entry.in_space:
        options.append(say("anchors for {pull} along one edge", pull=pull))
    else:
        options.append(
            say("a fixing for a horizontal force of {share} times its weight", share=_demanded(entry.shear or 0.0, say))
        )
    if entry.in_space:
        options.append(say("a wider base and a lower centre of mass are not computed in three dimensions"))
    return say("{name}: {options}.", name=entry.item.label, options="; ".join(options))


def as_csv(assessment: Assessment) -> str:
    """Return the table as CSV; the last line lists the columns that were not read, if any."""
    text = io.StringIO(newline="")
    writer = csv.writer(text)
    titles = header(language("en"))
    writer.writerow(titles)
    writer.writerows(rows(assessment))
    if assessment.ignored:
        columns = ", ".join(assessment.ignored)
        note = words_of(assessment)("columns of the list that were not read: {columns}", columns=columns)
        writer.writerow([note if k == _WORDS else "" for k in range(len(titles))])
    return text.getvalue()


def answer_of(assessment: Assessment) -> Answer:
    """Return the complete result of an assessment, with texts that are not escaped."""
    hazard, thresholds, say = assessment.hazard, assessment.thresholds, words_of(assessment)
    low, high = hazard.velocity()
    return Answer(
        {
            "inventory": assessment.source,
            "hazard": {
                # the description comes first, because its pgv is the requested level, not the range of the motions
                **{_STATED.get(key, key): value for key, value in hazard.description.items()},
                **{key: say(hazard.description[key]) for key in ("generator", "origin") if key in hazard.description},
                "level": hazard.words(say.code),
                "motions": say(hazard.source),
                "number_of_motions": len(hazard.motions),
                "pgv_range": [low, high],
            },
            "restitution": assessment.restitution,
            "restitution_sampled": assessment.drawn,
            "comparisons": list(assessment.comparisons),
            "language": assessment.language,
            "thresholds": dict(vars(thresholds))
            | {light.word: sentence for light, sentence in thresholds.sentences(assessment.language).items()},
            "counts": {light.word: count for light, count in assessment.counts().items()}
            | {"not_assessed": len(assessment.not_assessed)},
            "pieces": {light.word: count for light, count in assessment.pieces().items()},
            "objects": [_plain(rank, verdict, assessment) for rank, verdict in enumerate(assessment.verdicts, start=1)],
            "plan": [_plan(entry, words_of(assessment)) for entry in assessment.plan],
            "not_assessed": [
                {
                    "row": refused.row,
                    "number": refused.number,
                    "name": refused.name,
                    "note": refused.note,
                    "reason": say(refused.reason),
                }
                for refused in assessment.not_assessed
            ],
            "not_objects": [
                {"row": row.row, "text": row.name, "reason": say(row.reason)} for row in assessment.not_objects
            ],
            "columns_not_read": list(assessment.ignored),
            "stated": list(map(say, assessment.stated)),
            "header_lines": list(assessment.header_lines),
            "assumptions": limits(assessment),
        }
    )


def _plan(entry: PlanEntry, say: Language) -> dict[str, Any]:
    return {
        "number": entry.item.number,
        "name": entry.item.name,
        "row": entry.item.row,
        "pieces_spared": entry.spared,
        "gain": entry.gain,
        "directions": list(entry.directions),
        "base_wider_each_side": entry.wider,
        "centre_lower": entry.lower,
        "ballast": entry.ballast,
        "anchors_of_one_edge_over_weight": entry.pull,
        "anchors_of_one_edge": entry.force,
        "anchors_across_over_weight": entry.shear,
        "moved_to_fraction_of_shaking": entry.weaker,
        "text": plan_words(entry, say),
    }


def _plain(rank: int, verdict: Verdict, assessment: Assessment) -> dict[str, Any]:
    item = verdict.item
    return {
        "rank": rank,
        "number": item.number,
        "name": item.name,
        "row": item.row,
        "count": item.count,
        "note": item.note,
        "consequence": item.consequence,
        "shape": item.shape,
        "approximate": dict(item.approximate),
        "remarks": list(map(words_of(assessment), item.remarks)),
        "noted": noted(verdict, assessment),
        "rating": verdict.light.word,
        "worse_direction": verdict.worse.direction,
        "uplift_acceleration": verdict.uplift_acceleration,
        "overturned_interval": list(verdict.interval),
        "friction": verdict.friction if math.isfinite(verdict.friction) else None,
        "directions": [_direction(result) for result in verdict.results],
        "directions_by_comparison": {
            name: [_direction(result) for result in results]
            for name, results in zip(assessment.comparisons, verdict.compared, strict=True)
        },
        "rating_by_comparison": {name: light.word for name, light in lights_by_model(verdict, assessment)[1:]},
        "depends_on_model": verdict.depends_on_model,
        "text": sentence(verdict, assessment),
        "measures": advice(verdict, assessment),
        "model_note": model_note(verdict, assessment),
    }


# quantities by the keys of a stored description
_STATED = {"pga_m_s2": "pga", "pgv_m_s": "pgv", "time_step_s": "time_step"}

# JSON keys of directional results, if different from the attribute name
_PLAIN = {
    "count": "motions",
    "median_rotation": "median_rotation_over_angle", "high_rotation": "high_rotation_over_angle",
}  # fmt: skip


def _direction(result: DirectionResult) -> dict[str, Any]:
    names = (
        "direction", "uplift_acceleration", "count", "lifted", "overturned", "slid", "failed", "lost_contact",
        "overturned_fraction", "median_rotation", "high_rotation",
    )  # fmt: skip
    plain = {_PLAIN.get(name, name): getattr(result, name) for name in names}
    return plain | {"rating": result.light.word}


def words_of(assessment: Assessment) -> Language:
    """Return the language in which an assessment is reported."""
    return language(assessment.language)


def untranslated(assessment: Assessment) -> str:
    """Return a sentence if the language of a list has no translation, otherwise an empty text."""
    say = words_of(assessment)
    if say.requested == say.code:
        return ""
    return say(
        "The list requests a report in the language {code}. No translation exists; this report is in English.",
        code=say.requested,
    )


def remarks(verdict: Verdict, assessment: Assessment) -> str:
    """Return the remarks on an object: assumptions and ignored values."""
    return "; ".join(words_of(assessment)(remark).rstrip(".") for remark in verdict.item.remarks)


def noted(verdict: Verdict, assessment: Assessment) -> str:
    """Return the remarks as a sentence; empty without remarks."""
    text = remarks(verdict, assessment)
    return words_of(assessment)("Remarks: {remarks}.", remarks=text).replace("?.", "?") if text else ""


def named(verdict: Verdict, say: Language) -> str:
    """Return number and name of an object, with count, note, and a consequence other than medium."""
    item, name = verdict.item, verdict.item.label
    if item.count > 1:
        name = say("{name} (x {count})", name=name, count=item.count)
    if item.note:
        name = say("{name}, {note}", name=name, note=item.note)
    if item.consequence != "medium":
        name = say(
            "{name}, {consequence} consequence of a fall", name=name, consequence=say(_CONSEQUENCES[item.consequence])
        )
    return name


def passed_over(assessment: Assessment) -> list[tuple[str, list[int]]]:
    """Return the reasons for skipped rows of the list, with their row numbers."""
    rows: dict[str, list[int]] = {}
    for passed in assessment.not_objects:
        rows.setdefault(words_of(assessment)(passed.reason), []).append(passed.row)
    return list(rows.items())


def stated(assessment: Assessment) -> str:
    """Return the used statements outside the table of the list, as a sentence; empty if there are none."""
    say = words_of(assessment)
    text = "; ".join(map(say, assessment.stated))
    return say("Information outside the table: {stated}.", stated=text) if text else ""


def sentence(verdict: Verdict, assessment: Assessment) -> str:
    """Return a sentence with the response of an object."""
    say, hazard, worse = words_of(assessment), assessment.hazard, verdict.worse
    limit = say.number(_in_g(verdict.uplift_acceleration))
    still = say(
        "No uplift below {limit} g of horizontal shaking alone" if hazard.vertical else "No uplift below {limit} g",
        limit=limit,
    )
    failed, sliding_count, pull_count = worse.failed, worse.slid, worse.lost_contact
    also = [
        say("{failed} of {whole} motions could not be computed.", failed=failed, whole=worse.count + failed),
        say("The object slides in {slides} of these motions.", slides=sliding_count),
        say(
            "The contact force becomes tensile in {pulls} of these motions. The verdict assumes contact.",
            pulls=pull_count,
        ),
    ]
    return " ".join(
        [f"{still}; {_outcome(worse, hazard.words(say.code), hazard.synthetic, say)}."]
        + [remark for remark, number in zip(also, (failed, sliding_count, pull_count), strict=True) if number]
    )


def advice(verdict: Verdict, assessment: Assessment) -> str:
    """Return the recommended measure for an object."""
    say, light = words_of(assessment), verdict.light
    if light is Light.GREEN:
        return say("No measure against rocking is needed. Check that the object cannot slide off.")
    measure = (
        say("Secure it, lower its centre of mass, or widen its base.")
        if math.isfinite(verdict.friction)
        else _base(verdict, assessment)
    )
    if verdict.worse.overturned == 0 and verdict.worse.slid:
        return say("Prevent sliding with a mat, a rim or a fixing; the sliding distance is not computed.")
    room = "Leave a clearance for rocking without contact with neighbouring objects."
    away = "Until then keep people and other objects out of its fall range."
    return f"{measure} {say(room if light is Light.AMBER else away)}"


def lights_by_model(verdict: Verdict, assessment: Assessment) -> list[tuple[str, Light]]:
    """Return the light of an object with each restitution model, the model of the result first."""
    names, results = (assessment.restitution, *assessment.comparisons), (verdict.worse, *verdict.worse_compared)
    return [(name, result.light) for name, result in zip(names, results, strict=True)]


def model_note(verdict: Verdict, assessment: Assessment) -> str:
    """Return a sentence if the light depends on the restitution model, otherwise an empty text."""
    say, pairs = words_of(assessment), zip(assessment.comparisons, verdict.worse_compared, strict=True)
    others = [
        say(
            "{name} gives {light} ({overturned} of {count} overturn)", name=name, light=say(LIGHT_NAMES[result.light]),
            overturned=result.overturned, count=result.count,
        )
        for name, result in pairs if result.light is not verdict.light
    ]  # fmt: skip
    return say("The rating depends on the restitution model: {others}.", others=", ".join(others)) if others else ""


def rotation_words(value: float | None, say: Language) -> str:
    """Return a ratio of peak rotation to slenderness angle as text; None means overturning."""
    return say("overturns") if value is None else say.number(f"{value:.2f}")


def _demanded(value: float, say: Language) -> str:
    return say.number(f"{rounded_up(value):.10g}")


def rounded_down(value: float, digits: int) -> str:
    """Return a limit with a number of decimals, rounded down so that the limit remains valid.

    >>> rounded_down(0.1299, 2), rounded_down(0.3, 2)
    ('0.12', '0.30')
    """
    return f"{math.floor(value * 10**digits + 1e-9) / 10**digits:.{digits}f}"


def _in_g(acceleration: float) -> str:
    return rounded_down(acceleration / g, 2 if acceleration >= 0.1 * g else 3)


def _base(verdict: Verdict, assessment: Assessment) -> str:
    """Return the advice with the smallest base without uplift, from ``g b / h`` without a change of the height h."""
    say, way, peak = words_of(assessment), verdict.worse.direction, assessment.hazard.peak()
    now = verdict.item.base(way)
    # the smallest size above the limit of uplift
    needed = math.floor(100.0 * now * peak / verdict.worse.uplift_acceleration + 1e-9) + 1
    own = verdict.item.width if way == "width" else verdict.item.depth
    message = _BASES[now == own, assessment.hazard.vertical]
    return say(message.text, way=say(DIRECTION_NAMES[way]), size=100.0 * now, needed=needed)


def _outcome(result: DirectionResult, level: str, synthetic: bool, say: Language) -> str:
    high = result.high_rotation or 0.0
    if result.lifted == 0:
        message = _NO_ROCKING if result.slid else _STILL
    elif result.overturned:
        message = _OVERTURNS
    else:
        message = _ROCKS_BARELY if high < 0.05 else _ROCKS_LITTLE if high < 0.2 else _ROCKS
    motions = _SIMULATED if synthetic else _RECORDS
    facts = {"level": level, "overturned": result.overturned, "count": result.count}
    return say(message.of({**facts, "motions": motions.of(facts)}))
