"""The ranked table: as plain values for JSON, as text for CSV and spreadsheets, and its sentences in a language."""

import csv
import io
import math
from typing import Any

from rocking.answers import Answer
from rocking.conventions import g
from rocking.dynamics.settings import NEVER_SLIDES
from rocking.language import Language, language
from rocking.studies.inventory.assessment import Assessment, DirectionResult, Verdict
from rocking.studies.inventory.lights import Light
from rocking.studies.inventory.objects import NotAssessed
from rocking.studies.inventory.plan import PlanEntry
from rocking.studies.remedies import rounded_up
from rocking.tables import escaped

COLUMNS = (
    "rank", "light", "number", "name", "count", "row", "direction", "uplift", "motions", "lifted", "overturned", "low",
    "high", "median", "quantile", "others", "words", "advice", "note", "consequence", "remarks",
)  # fmt: skip
PLAN_COLUMNS = ("pieces", "gain", "wider", "lower", "ballast", "anchors", "force", "across", "moved")
_WORDS = COLUMNS.index("words")

# what every report says about the assumptions
_LIMITS = ("rigid", "directions", "shape", "drawn", "sizes", "damage")


def header(say: Language) -> list[str]:
    """Return the titles of the table in files."""
    return [say(f"column.{name}") for name in COLUMNS] + plan_header(say)


def plan_header(say: Language) -> list[str]:
    """Return the titles of the plan, beside the names of the objects."""
    return [say(f"plan.columns.{name}") for name in PLAN_COLUMNS]


def sliding(assessment: Assessment) -> str:
    """Return whether objects slide, as a sentence or two."""
    slides = [each.friction < NEVER_SLIDES for each in assessment.verdicts]
    names = ([] if slides and all(slides) else ["sliding"]) + (["slides"] if any(slides) else [])
    return " ".join(words_of(assessment)(f"limits.{name}") for name in names)


def limits(assessment: Assessment) -> list[str]:
    """Return what every report says about the assumptions."""
    return [sliding(assessment), *(words_of(assessment)(f"limits.{name}") for name in _LIMITS)]


def rows(assessment: Assessment, code: str = "en") -> list[list[str | float | int]]:
    """Return one row an object, by `header`, the worst first, those without a verdict last; formulas are escaped.

    Sentences are in the language of the assessment, names of lights and directions in that of the code.
    """
    say, plan = language(code), {id(each.item): each for each in assessment.plan}
    lines: list[list[str | float | int]] = []
    for rank, verdict in enumerate(assessment.verdicts, start=1):
        worse, item, (low, high) = verdict.worse, verdict.item, verdict.interval
        lights = _lights(verdict, assessment).items()
        others = "; ".join(f"{name}: {say(f'light.{word}')}" for name, word in lights)
        rotations = (
            rotation_words(each, say) if each is None else round(each, 3)
            for each in (worse.median_rotation, worse.high_rotation)
        )
        measures = plan_row(plan[id(item)], say) if id(item) in plan else [""] * len(PLAN_COLUMNS)
        lines.append([
            rank, say(f"light.{verdict.light.word}"), escaped(item.number), escaped(item.name), item.count, item.row,
            say(f"direction.{worse.direction}"), round(verdict.uplift_acceleration / g, 4), worse.count, worse.lifted,
            worse.overturned, round(100.0 * low, 2), round(100.0 * high, 2), *rotations, others,
            sentence(verdict, assessment),
            f"{advice(verdict, assessment)} {model_note(verdict, assessment)}".strip(), escaped(item.note),
            say(f"consequence.{item.consequence}"), escaped(remarks(verdict, assessment)), *measures,
        ])  # fmt: skip
    for refused in assessment.not_assessed:
        why = say("sheet.not_assessed_why", reason=words_of(assessment).translated(refused.reason))
        lines.append(_bare(refused, say("sheet.not_assessed"), why))
    own = words_of(assessment)
    passed = (_bare(each, say("sheet.not_object"), own.translated(each.reason)) for each in assessment.not_objects)
    return [*lines, *passed]


def _bare(refused: NotAssessed, light: str, why: str) -> list[str | float | int]:
    """Return the row of what has no verdict."""
    told: dict[str, str | int] = {
        "light": light, "number": refused.number, "name": refused.name, "row": refused.row, "words": why,
        "note": refused.note,
    }  # fmt: skip
    cells = [told.get(name, "") for name in COLUMNS]
    line: list[str | float | int] = [escaped(each) if isinstance(each, str) else each for each in cells]
    return line + [""] * len(PLAN_COLUMNS)


def plan_row(entry: PlanEntry, say: Language) -> list[str | float]:
    """Return what is in the plan of an object, by `PLAN_COLUMNS`."""
    ways = (entry.wider, entry.lower, entry.weaker)
    wider, lower, moved = (say("plan.serves_not") if each is None else round(100.0 * each, 3) for each in ways)
    if entry.in_space:
        wider = lower = say("plan.not_computed")
    forces = (entry.ballast, entry.pull, entry.force, entry.shear)
    ballast, *anchors = ("" if each is None else rounded_up(each) for each in forces)
    return [round(entry.spared, 3), round(entry.gain, 3), wider, lower, ballast, *anchors, moved]


def plan_words(entry: PlanEntry, say: Language) -> str:
    """Return what would make an object green, any one of it, as a sentence."""
    assert entry.pull is not None
    options = []
    if entry.wider is not None:
        options.append(say("plan.wider", wider=_demanded(100.0 * entry.wider, say)))
    if entry.lower is not None and entry.ballast is not None:
        options.append(
            say("plan.ballasted", lower=_demanded(100.0 * entry.lower, say), ballast=_demanded(entry.ballast, say))
        )
    elif entry.lower is not None:
        share = _demanded(entry.ballast_share or 0.0, say)
        options.append(say("plan.lower", lower=_demanded(100.0 * entry.lower, say), share=share))
    if entry.weaker is not None:
        options.append(say("plan.moved", share=100.0 * entry.weaker))
    if not options:
        options.append(say("plan.nothing"))
    weight = say("plan.weight", share=_demanded(entry.pull, say))
    pull = weight if entry.force is None else say("plan.newton", force=_demanded(entry.force, say))
    if entry.pull or not entry.in_space:
        options.append(say("plan.anchors", pull=pull))
    else:
        options.append(say("plan.across", share=_demanded(entry.shear or 0.0, say)))
    if entry.in_space:
        options.append(say("plan.in_space"))
    return say("plan.sentence", name=entry.item.label, options="; ".join(options))


def as_csv(assessment: Assessment) -> str:
    """Return the table as CSV; its last line names the columns of the list that were not read, if any."""
    text = io.StringIO(newline="")
    writer = csv.writer(text)
    titles = header(language("en"))
    writer.writerow(titles)
    writer.writerows(rows(assessment))
    if assessment.ignored:
        note = f"columns of the list that were not read: {', '.join(assessment.ignored)}"
        writer.writerow([note if k == _WORDS else "" for k in range(len(titles))])
    return text.getvalue()


def answer_of(assessment: Assessment) -> Answer:
    """Return everything that is shown of an assessment; text as it was typed."""
    hazard, thresholds = assessment.hazard, assessment.thresholds
    low, high = hazard.velocity()
    return Answer(
        {
            "inventory": assessment.source,
            "hazard": {
                # the description comes first: its pgv is the level asked for, not the range that came out
                **{_STATED.get(key, key): value for key, value in hazard.description.items()},
                "level": hazard.words(),
                "motions": hazard.source,
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
                {"row": each.row, "number": each.number, "name": each.name, "note": each.note, "reason": each.reason}
                for each in assessment.not_assessed
            ],
            "not_objects": [
                {"row": each.row, "text": each.name, "reason": each.reason} for each in assessment.not_objects
            ],
            "columns_not_read": list(assessment.ignored),
            "stated": list(assessment.stated),
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
        "remarks": list(item.remarks),
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


def remarks(verdict: Verdict, assessment: Assessment) -> str:
    """Return what was assumed of an object, or left aside."""
    return "; ".join(words_of(assessment).translated(each.rstrip(".")) for each in verdict.item.remarks)


def noted(verdict: Verdict, assessment: Assessment) -> str:
    """Return the remarks as a sentence; nothing where there are none."""
    said = remarks(verdict, assessment)
    return words_of(assessment)("report.remarks", remarks=said).replace("?.", "?") if said else ""


def named(verdict: Verdict, say: Language) -> str:
    """Return number and name of an object, with how many there are, its note, and a consequence that is not medium."""
    item, name = verdict.item, verdict.item.label
    if item.count > 1:
        name = say("report.named", name=name, count=item.count)
    if item.note:
        name = say("report.noted", name=name, note=item.note)
    if item.consequence != "medium":
        name = say("report.consequence", name=name, consequence=say(f"consequence.{item.consequence}"))
    return name


def passed_over(assessment: Assessment) -> list[tuple[str, list[int]]]:
    """Return why rows of the list are no objects, and which rows."""
    say, reasons = words_of(assessment), dict.fromkeys(each.reason for each in assessment.not_objects)
    return [
        (say.translated(reason), [each.row for each in assessment.not_objects if each.reason == reason])
        for reason in reasons
    ]


def stated(assessment: Assessment) -> str:
    """Return what the list states beside its table and was used, as a sentence; nothing where it states nothing."""
    say = words_of(assessment)
    said = "; ".join(say.translated(each) for each in assessment.stated)
    return say("report.stated", stated=said) if said else ""


def sentence(verdict: Verdict, assessment: Assessment) -> str:
    """Return what an object does."""
    say, hazard, worse = words_of(assessment), assessment.hazard, verdict.worse
    limit = say.number(_in_g(verdict.uplift_acceleration))
    still = say("still.level" if hazard.vertical else "still.whole", limit=limit)
    also = {"failed": worse.failed, "slides": worse.slid, "pulls": worse.lost_contact}
    numbers = {**also, "whole": worse.count + worse.failed}
    return " ".join(
        [f"{still}; {_fate(worse, hazard.words(say.code), hazard.synthetic, say)}."]
        + [say(f"also.{name}", **numbers) for name, happens in also.items() if happens]
    )


def advice(verdict: Verdict, assessment: Assessment) -> str:
    """Return what to do about an object."""
    say, light = words_of(assessment), verdict.light
    if light is Light.GREEN:
        return say("advice.green")
    how = say("advice.secure") if math.isfinite(verdict.friction) else _base(verdict, assessment)
    if verdict.worse.overturned == 0 and verdict.worse.slid:
        return say("advice.slides")
    return f"{how} {say(f'advice.{light.word}')}"


def _lights(verdict: Verdict, assessment: Assessment) -> dict[str, str]:
    pairs = zip(assessment.comparisons, verdict.worse_compared, strict=True)
    return {name: each.light.word for name, each in pairs}


def model_note(verdict: Verdict, assessment: Assessment) -> str:
    """Return whether the model of impact decides, as a sentence; empty if all models show the same light."""
    say, pairs = words_of(assessment), zip(assessment.comparisons, verdict.worse_compared, strict=True)
    others = [
        say(
            "model.other", name=name, light=say(f"light.{each.light.word}"), overturned=each.overturned,
            count=each.count,
        )
        for name, each in pairs if each.light is not verdict.light
    ]  # fmt: skip
    return say("model.decides", others=", ".join(others)) if others else ""


def rotation_words(value: float | None, say: Language) -> str:
    """Return a peak rotation over the slenderness angle in words; None overturns."""
    return say("report.overturns") if value is None else say.number(f"{value:.2f}")


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
    key = ("size" if now == own else "base") + ("_alone" if assessment.hazard.vertical else "")
    return say(f"advice.{key}", way=say(f"direction.{way}"), size=100.0 * now, needed=needed)


def _fate(result: DirectionResult, level: str, synthetic: bool, say: Language) -> str:
    high = result.high_rotation or 0.0
    if result.lifted == 0:
        fate = "no_rocking" if result.slid else "still"
    elif result.overturned:
        fate = "fell"
    else:
        fate = "barely" if high < 0.05 else "little" if high < 0.2 else "rocks"
    motions = say("motions.simulated" if synthetic else "motions.records", count=result.count)
    return say(f"fate.{fate}", level=level, motions=motions, overturned=result.overturned, count=result.count)
