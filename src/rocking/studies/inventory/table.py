"""The ranked table: as plain values for JSON, as text for CSV and spreadsheets, and its sentences in a language."""

import csv
import io
import math
from typing import Any

from rocking.answers import Answer
from rocking.conventions import g
from rocking.dynamics.settings import NEVER_SLIDES
from rocking.language import Language, language
from rocking.messages import Message
from rocking.studies.inventory.assessment import Assessment, DirectionResult, Verdict
from rocking.studies.inventory.lights import LIGHT_NAMES, Light
from rocking.studies.inventory.objects import NotAssessed
from rocking.studies.inventory.plan import PlanEntry
from rocking.studies.remedies import rounded_up
from rocking.tables import escaped

_TITLES = {
    "rank": Message("rank"),
    "light": Message("light"),
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
    "median": Message("median rotation / angle"),
    "quantile": Message("84 % rotation / angle"),
    "others": Message("light by other models"),
    "words": Message("in words"),
    "advice": Message("what to do"),
    "note": Message("note"),
    "consequence": Message("consequence"),
    "remarks": Message("remarks"),
}
COLUMNS = tuple(_TITLES)
PLAN_TITLES = (
    Message("pieces that fall less"),
    Message("gain"),
    Message("base wider, each side [cm]"),
    Message("centre lower [cm]"),
    Message("by ballast [kg]"),
    Message("anchors of one edge [of its weight]"),
    Message("anchors of one edge [N]"),
    Message("all anchors across [of its weight]"),
    Message("moved: at most [% of the shaking]"),
)
_WORDS = COLUMNS.index("words")

PLAN_NOTE = Message(
    "A wider base reaches out as far on both sides, mass and moment of inertia about the centre as they "
    "are. The centre comes down by ballast at the floor below it, whose mass and inertia count. Anchors, "
    "body and floor are rigid: those of one edge pull straight down, the other edge is the pivot, and "
    "there is no safety factor. Moved: to where the shaking is at most that part of the one here."
)
"""What the measures of the plan mean."""

DIRECTION_NAMES = {"width": Message("width"), "depth": Message("depth")}
_CONSEQUENCES = {
    "low": Message("low", context="consequence"),
    "medium": Message("medium"),
    "high": Message("high", context="consequence"),
}

_NO_ROCKING = Message(
    "at {level} it does not rock in {motions}", many="at {level} it does not rock in any of {motions}"
)
_STILL = Message("at {level} it stood still in {motions}", many="at {level} it stood still in all of {motions}")
_OVERTURNS = Message(
    "at {level} it rocks, and fell over in {motions}",
    many="at {level} it rocks, and fell over in {overturned} of {motions}",
)
_ROCKS_BARELY = Message(
    "at {level} it barely rocks, and did not fall over in {motions}",
    many="at {level} it barely rocks, and fell over in none of {motions}",
)
_ROCKS_LITTLE = Message(
    "at {level} it rocks a little, and did not fall over in {motions}",
    many="at {level} it rocks a little, and fell over in none of {motions}",
)
_ROCKS = Message(
    "at {level} it rocks, and did not fall over in {motions}",
    many="at {level} it rocks, and fell over in none of {motions}",
)
_RECORDS = Message("the one record", many="{count} records")
_SIMULATED = Message("the one simulated earthquake", many="{count} simulated earthquakes")
# by whether the base is the outer size, and whether there is vertical shaking
_BASES = {
    (True, False): Message(
        "Secure it, lower its centre of mass, or widen its base: its {way} is {size:.3g} cm, and {needed} cm "
        "would not be lifted."
    ),
    (False, False): Message(
        "Secure it, lower its centre of mass, or widen its base: its base is {size:.3g} cm along the {way}, "
        "and {needed} cm would not be lifted."
    ),
    (True, True): Message("Secure it, lower its centre of mass, or widen its base: its {way} is {size:.3g} cm."),
    (False, True): Message(
        "Secure it, lower its centre of mass, or widen its base: its base is {size:.3g} cm along the {way}."
    ),
}

# what every report says about the assumptions
_LIMITS = (
    Message(
        "Objects are rigid and stand freely on a rigid, level floor, at the shaking given: what a building, a"
        " pedestal or a shelf adds to the motion of the ground must be in that shaking."
    ),
    Message(
        "Each motion acts once along the width and once along the depth; the worse direction counts. Rocking "
        "in both directions at once, twisting and rolling on the rim of a round base are not computed."
    ),
    Message(
        "Each direction is a body of the outer size, on the base that is given; where no height of the centre"
        " of mass is given it is half the height. With a friction or a body file the object moves in three "
        "dimensions instead, with the default restitution model where no model is stated; no measurement exists there."
    ),
    Message(
        "Where no model of impact was asked for, the coefficient of restitution is not known exactly: each "
        "motion has another one, drawn from what the measurements leave open, with the scatter of single "
        "bodies."
    ),
    Message("Sizes that are approximate are drawn for every motion, evenly within their intervals."),
    Message("Blows from neighbours, shaking loose, and damage without falling are not assessed."),
)


def header(say: Language) -> list[str]:
    """Return the titles of the table in files."""
    return [say(title) for title in _TITLES.values()] + plan_header(say)


def plan_header(say: Language) -> list[str]:
    """Return the titles of the plan, beside the names of the objects."""
    return [say(title) for title in PLAN_TITLES]


def sliding(assessment: Assessment) -> str:
    """Return whether objects slide, as a sentence or two."""
    slides = [each.friction < NEVER_SLIDES for each in assessment.verdicts]
    sentences = []
    if not slides or not all(slides):
        sentences.append(
            Message(
                "Sliding is not assessed without a friction: an object on a smooth floor or shelf may slide before it"
                " rocks, and slide off its support."
            )
        )
    if any(slides):
        sentences.append(
            Message(
                "Where a friction is given, sliding is computed and counted, but not how far: whether an object "
                "slides off its support is to be checked."
            )
        )
    return " ".join(map(words_of(assessment), sentences))


def limits(assessment: Assessment) -> list[str]:
    """Return what every report says about the assumptions."""
    return [sliding(assessment), *map(words_of(assessment), _LIMITS)]


def rows(assessment: Assessment, code: str = "en") -> list[list[str | float | int]]:
    """Return one row an object, by `header`, the worst first, those without a verdict last; formulas are escaped.

    Sentences are in the language of the assessment, names of lights and directions in that of the code.
    """
    say, own, plan = language(code), words_of(assessment), {id(each.item): each for each in assessment.plan}
    lines: list[list[str | float | int]] = []
    for rank, verdict in enumerate(assessment.verdicts, start=1):
        worse, item, (low, high) = verdict.worse, verdict.item, verdict.interval
        lights = zip(assessment.comparisons, verdict.worse_compared, strict=True)
        others = "; ".join(f"{name}: {say(LIGHT_NAMES[other.light])}" for name, other in lights)
        rotations = (
            rotation_words(each, say) if each is None else round(each, 3)
            for each in (worse.median_rotation, worse.high_rotation)
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
        why = own("not assessed: {reason}", reason=own(refused.reason))
        lines.append(_bare(refused, say("not assessed"), why))
    passed = (_bare(each, say("not an object"), own(each.reason)) for each in assessment.not_objects)
    return [*lines, *passed]


def _bare(refused: NotAssessed, light: str, why: str) -> list[str | float | int]:
    """Return the row of what has no verdict."""
    told: dict[str, str | int] = {
        "light": light, "number": refused.number, "name": refused.name, "row": refused.row, "words": why,
        "note": refused.note,
    }  # fmt: skip
    cells = [told.get(name, "") for name in COLUMNS]
    line: list[str | float | int] = [escaped(each) if isinstance(each, str) else each for each in cells]
    return line + [""] * len(PLAN_TITLES)


def plan_row(entry: PlanEntry, say: Language) -> list[str | float]:
    """Return what is in the plan of an object, by `PLAN_TITLES`."""
    ways = (entry.wider, entry.lower, entry.weaker)
    wider, lower, moved = (say("does not serve") if each is None else round(100.0 * each, 3) for each in ways)
    if entry.in_space:
        wider = lower = say("not computed")
    forces = (entry.ballast, entry.pull, entry.force, entry.shear)
    ballast, *anchors = ("" if each is None else rounded_up(each) for each in forces)
    return [round(entry.spared, 3), round(entry.gain, 3), wider, lower, ballast, *anchors, moved]


def plan_words(entry: PlanEntry, say: Language) -> str:
    """Return what would make an object green, any one of it, as a sentence."""
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
        share = _demanded(entry.ballast_share or 0.0, say)
        options.append(
            say(
                "centre of mass {lower} cm lower (by ballast of {share} of its weight at the floor)",
                lower=_demanded(100.0 * entry.lower, say),
                share=share,
            )
        )
    if entry.weaker is not None:
        options.append(say("a place with at most {share:.0f} % of this shaking", share=100.0 * entry.weaker))
    if not options:
        options.append(say("Nothing that was looked at but anchors serves"))
    weight = say("{share} of its weight", share=_demanded(entry.pull, say))
    pull = weight if entry.force is None else say("{force} N", force=_demanded(entry.force, say))
    if entry.pull or not entry.in_space:
        options.append(say("anchors that hold {pull} along one edge", pull=pull))
    else:
        options.append(
            say("a fixing that holds {share} of its weight across", share=_demanded(entry.shear or 0.0, say))
        )
    if entry.in_space:
        options.append(say("a wider base and a lower centre are not computed in three dimensions"))
    return say("{name}: {options}.", name=entry.item.label, options="; ".join(options))


def as_csv(assessment: Assessment) -> str:
    """Return the table as CSV; its last line names the columns of the list that were not read, if any."""
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
    """Return everything that is shown of an assessment; text as it was typed."""
    hazard, thresholds, say = assessment.hazard, assessment.thresholds, words_of(assessment)
    low, high = hazard.velocity()
    return Answer(
        {
            "inventory": assessment.source,
            "hazard": {
                # the description comes first: its pgv is the level asked for, not the range that came out
                **{_STATED.get(key, key): value for key, value in hazard.description.items()},
                **{key: say(hazard.description[key]) for key in ("generator", "origin") if key in hazard.description},
                "level": hazard.words(say.code),
                "motions": say(hazard.source),
                "number_of_motions": len(hazard.motions),
                "pgv_range": [low, high],
            },
            "restitution": assessment.restitution,
            "restitution_drawn": assessment.drawn,
            "comparisons": list(assessment.comparisons),
            "language": assessment.language,
            "thresholds": dict(vars(thresholds))
            | {light.word: words for light, words in thresholds.sentences(assessment.language).items()},
            "counts": {light.word: count for light, count in assessment.counts().items()}
            | {"not_assessed": len(assessment.not_assessed)},
            "pieces": {light.word: count for light, count in assessment.pieces().items()},
            "objects": [_plain(rank, each, assessment) for rank, each in enumerate(assessment.verdicts, start=1)],
            "plan": [_plan(each, words_of(assessment)) for each in assessment.plan],
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
                {"row": each.row, "text": each.name, "reason": say(each.reason)} for each in assessment.not_objects
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
        "moved_to_share_of_shaking": entry.weaker,
        "in_words": plan_words(entry, say),
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
        "light": verdict.light.word,
        "worse_direction": verdict.worse.direction,
        "uplift_acceleration": verdict.uplift_acceleration,
        "overturned_interval": list(verdict.interval),
        "friction": verdict.friction if math.isfinite(verdict.friction) else None,
        "directions": [_direction(each) for each in verdict.results],
        "directions_by_comparison": {
            name: [_direction(each) for each in results]
            for name, results in zip(assessment.comparisons, verdict.compared, strict=True)
        },
        "light_by_comparison": _lights(verdict, assessment),
        "model_decides": verdict.model_decides,
        "in_words": sentence(verdict, assessment),
        "what_to_do": advice(verdict, assessment),
        "model_note": model_note(verdict, assessment),
    }


# quantities by the keys of a stored description
_STATED = {"pga_m_s2": "pga", "pgv_m_s": "pgv", "time_step_s": "time_step"}

# names of a direction's results in JSON where they are not their own
_PLAIN = {
    "count": "motions",
    "median_rotation": "median_rotation_over_angle", "high_rotation": "high_rotation_over_angle",
}  # fmt: skip


def _direction(result: DirectionResult) -> dict[str, Any]:
    names = (
        "direction", "light", "uplift_acceleration", "count", "lifted", "overturned", "slid", "failed", "lost_contact",
        "overturned_share", "median_rotation", "high_rotation",
    )  # fmt: skip
    plain = {_PLAIN.get(name, name): getattr(result, name) for name in names}
    return plain | {"light": result.light.word}


def words_of(assessment: Assessment) -> Language:
    """Return the language in which an assessment is reported."""
    return language(assessment.language)


def untranslated(assessment: Assessment) -> str:
    """Return that there are no translations into the language of a list, as a sentence; nothing where there are."""
    say = words_of(assessment)
    if say.requested == say.code:
        return ""
    return say(
        "The list asks for a report in the language {code}, of which there are no words yet: this one is in English.",
        code=say.requested,
    )


def remarks(verdict: Verdict, assessment: Assessment) -> str:
    """Return what was assumed of an object, or left aside."""
    return "; ".join(words_of(assessment)(each).rstrip(".") for each in verdict.item.remarks)


def noted(verdict: Verdict, assessment: Assessment) -> str:
    """Return the remarks as a sentence; nothing where there are none."""
    said = remarks(verdict, assessment)
    return words_of(assessment)("Noted: {remarks}.", remarks=said).replace("?.", "?") if said else ""


def named(verdict: Verdict, say: Language) -> str:
    """Return number and name of an object, with how many there are, its note, and a consequence that is not medium."""
    item, name = verdict.item, verdict.item.label
    if item.count > 1:
        name = say("{name} (x {count})", name=name, count=item.count)
    if item.note:
        name = say("{name}, {note}", name=name, note=item.note)
    if item.consequence != "medium":
        name = say(
            "{name}, a fall of {consequence} consequence", name=name, consequence=say(_CONSEQUENCES[item.consequence])
        )
    return name


def passed_over(assessment: Assessment) -> list[tuple[str, list[int]]]:
    """Return why rows of the list are no objects, and which rows."""
    rows: dict[str, list[int]] = {}
    for passed in assessment.not_objects:
        rows.setdefault(words_of(assessment)(passed.reason), []).append(passed.row)
    return list(rows.items())


def stated(assessment: Assessment) -> str:
    """Return what the list states beside its table and was used, as a sentence; nothing where it states nothing."""
    say = words_of(assessment)
    said = "; ".join(map(say, assessment.stated))
    return say("The list states beside its table: {stated}.", stated=said) if said else ""


def sentence(verdict: Verdict, assessment: Assessment) -> str:
    """Return what an object does."""
    say, hazard, worse = words_of(assessment), assessment.hazard, verdict.worse
    limit = say.number(_in_g(verdict.uplift_acceleration))
    still = say(
        "Stays still up to {limit} g of level shaking alone" if hazard.vertical else "Stays still up to {limit} g",
        limit=limit,
    )
    failed, slides, pulls = worse.failed, worse.slid, worse.lost_contact
    also = [
        say("{failed} of {whole} motions could not be computed.", failed=failed, whole=worse.count + failed),
        say("It slides in {slides} of them.", slides=slides),
        say("In {pulls} of them the ground would have to pull, and the verdict assumes contact.", pulls=pulls),
    ]
    return " ".join(
        [f"{still}; {_fate(worse, hazard.words(say.code), hazard.synthetic, say)}."]
        + [remark for remark, number in zip(also, (failed, slides, pulls), strict=True) if number]
    )


def advice(verdict: Verdict, assessment: Assessment) -> str:
    """Return what to do about an object."""
    say, light = words_of(assessment), verdict.light
    if light is Light.GREEN:
        return say("Nothing to do for rocking; check that it cannot slide off.")
    how = (
        say("Secure it, lower its centre of mass, or widen its base.")
        if math.isfinite(verdict.friction)
        else _base(verdict, assessment)
    )
    if verdict.worse.overturned == 0 and verdict.worse.slid:
        return say("Keep it from sliding with a mat, a rim or a fixing: how far it slides is not computed.")
    room = "Give it room to rock without touching its neighbours."
    away = "Until then keep people and other objects out of its reach."
    return f"{how} {say(room if light is Light.AMBER else away)}"


def _lights(verdict: Verdict, assessment: Assessment) -> dict[str, str]:
    pairs = zip(assessment.comparisons, verdict.worse_compared, strict=True)
    return {name: each.light.word for name, each in pairs}


def model_note(verdict: Verdict, assessment: Assessment) -> str:
    """Return whether the model of impact decides, as a sentence; empty if all models show the same light."""
    say, pairs = words_of(assessment), zip(assessment.comparisons, verdict.worse_compared, strict=True)
    others = [
        say(
            "{name} shows {light} ({overturned} of {count} overturn)", name=name, light=say(LIGHT_NAMES[each.light]),
            overturned=each.overturned, count=each.count,
        )
        for name, each in pairs if each.light is not verdict.light
    ]  # fmt: skip
    return say("The model of impact decides: {others}.", others=", ".join(others)) if others else ""


def rotation_words(value: float | None, say: Language) -> str:
    """Return a peak rotation over the slenderness angle in words; None overturns."""
    return say("overturns") if value is None else say.number(f"{value:.2f}")


def _demanded(value: float, say: Language) -> str:
    return say.number(f"{rounded_up(value):.10g}")


def rounded_down(value: float, digits: int) -> str:
    """Return a limit with so many decimals that stays true in print: not above it, but for rounding.

    >>> rounded_down(0.1299, 2), rounded_down(0.3, 2)
    ('0.12', '0.30')
    """
    return f"{math.floor(value * 10**digits + 1e-9) / 10**digits:.{digits}f}"


def _in_g(acceleration: float) -> str:
    return rounded_down(acceleration / g, 2 if acceleration >= 0.1 * g else 3)


def _base(verdict: Verdict, assessment: Assessment) -> str:
    """Return the base that no motion would lift, as ``g b / h`` has it, at the same height of the centre."""
    say, way, peak = words_of(assessment), verdict.worse.direction, assessment.hazard.peak()
    now = verdict.item.base(way)
    needed = (
        math.floor(100.0 * now * peak / verdict.worse.uplift_acceleration + 1e-9) + 1
    )  # beyond what just does not lift it
    own = verdict.item.width if way == "width" else verdict.item.depth
    message = _BASES[now == own, assessment.hazard.vertical]
    return say(message.text, way=say(DIRECTION_NAMES[way]), size=100.0 * now, needed=needed)


def _fate(result: DirectionResult, level: str, synthetic: bool, say: Language) -> str:
    high = result.high_rotation or 0.0
    if result.lifted == 0:
        fate = _NO_ROCKING if result.slid else _STILL
    elif result.overturned:
        fate = _OVERTURNS
    else:
        fate = _ROCKS_BARELY if high < 0.05 else _ROCKS_LITTLE if high < 0.2 else _ROCKS
    motions = _SIMULATED if synthetic else _RECORDS
    facts = {"level": level, "overturned": result.overturned, "count": result.count}
    return say(fate.of({**facts, "motions": motions.of(facts)}))
