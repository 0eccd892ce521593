"""What the commands of many histories have in common: their document, its problem, and the head of their pages."""

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking import checks
from rocking.bodies import Body
from rocking.cli.numbers import in_unit, values_table
from rocking.cli.question import NO_MOTION, Words, hinted, parsed_sets, typed
from rocking.conventions import FEET, Foot
from rocking.errors import InvalidValueError
from rocking.motions.pulse import Motion
from rocking.spec.document import NEEDS, CampaignDocument
from rocking.spec.reading import CommandFiles, checked, located, tables_in
from rocking.spec.study import StudyProblem

if TYPE_CHECKING:
    import typer

_SETTABLE = ("body", "motion", "settings")


def words_of(parameters: Mapping[str, Any], own: str) -> Words:
    """Return the words and options of a study that has a table of its own."""
    return Words(parameters, (*_SETTABLE, own))


def document_file(context: "typer.Context", own: str, word: str | None = None) -> Path | None:
    """Return the file that says everything, if the first word is one: TOML with [campaign] or the study's own table."""
    word = context.params.get("body") if word is None else word
    if word is None or not {"campaign", own} & set(tables_in(Path(word)) or ()):
        return None
    beside = {"body", "objects", "motions", "out", "as_json", "threads", "sets"}
    if stated := typed(context, [name for name in context.params if name not in beside]):
        raise InvalidValueError(
            f"{word} says everything itself, so it takes no {', '.join(stated)}; --set changes a key"
        )
    return Path(word)


def problem_in(file: Path, own: str, sets: Sequence[str] | None = None) -> StudyProblem:
    """Return what a file describes, with the keys that were set beside it."""
    kinds = {"map": "overturning-map", "minimum": "minimum-acceleration", "spectrum": "rocking-spectrum"}
    with located(str(file)):
        tables = dict(tables_in(file) or {})
        if own in kinds:
            tables.setdefault("campaign", {"name": own, "kind": kinds[own]})
        for table, keys in parsed_sets(sets, (*_SETTABLE, own)).items():
            name = "motions" if table == "motion" else table
            stated = tables.get(name, {})
            if isinstance(stated, list) and len(stated) == 1:
                (stated,) = stated
            if not isinstance(stated, dict):
                raise InvalidValueError(f"--set {table}.{next(iter(keys))}: it has several [[{name}]]; change the file")
            tables[name] = {**stated, **keys}
        document = checked(CampaignDocument, tables)
        if NEEDS[document.campaign.kind] != own:
            raise InvalidValueError(f'it is of kind "{document.campaign.kind}": rocking campaign run computes it')
        return StudyProblem.of(document, file.parent)


def motions_tables(words: Words, motions: Sequence[str]) -> list[dict[str, Any]]:
    """Return the tables [[motions]] of records and pulses."""
    tables = []
    for word in motions:
        table = words.motion_table(word)
        names = {"record": "records", "pulse": "pulse"}
        tables.append({names.get(key, key): [value] if key in names else value for key, value in table.items()})
    return tables


def problem_of(
    kind: str,
    words: Words,
    restitution: Sequence[str] | None,
    own: dict[str, Any],
    motions: list[dict[str, Any]] | None = None,
) -> StudyProblem:
    """Return the problem of a study of one body, made of the document that its options say.

    own: the study's own table; motions: tables of its motions, if they are not the one that the words name.
    """
    body, named = words.body_and_motions()
    if motions is None:
        if not named:
            raise InvalidValueError(NO_MOTION)
        table = words.one_motion(named)
        names = {"record": "records"}
        motions = [{names.get(key, key): [v] if key in {"record", "pulse"} else v for key, v in table.items()}]
    name = {"overturning-map": "map", "minimum-acceleration": "minimum"}.get(kind, "fragility")
    with hinted(body, named[0].partition("=")[2] or named[0] if named else None):
        tables = {
            "campaign": {"name": name, "kind": kind},
            "body": words.body_table(body),
            "motions": motions,
            "restitution": {"models": different(restitution)},
            name: {**own, **words.sets.get(name, {})},
            "settings": words.sets.get("settings", {}),
        }
        return StudyProblem.of(checked(CampaignDocument, tables), CommandFiles(Path()))


def different(restitution: Sequence[str] | None) -> list[str]:
    """Return the restitutions that were typed, ked if none was."""
    texts = list(restitution or ["ked"])
    if twice := next((text for text in texts if texts.count(text) > 1), None):
        raise InvalidValueError(f"--restitution {twice[:60]} is given twice")
    return texts


def map_tables(
    x: str, y: str, refine: int | None, *, typed: Sequence[str] | None
) -> tuple[dict[str, Any], dict[str, str]]:
    """Return the table [map], and the units that axes were written in, by their name."""
    axes, written = {}, {}
    for option, text in (("x", x), ("y", y)):
        axes[option], unit = _axis(f"--{option}", text)
        if unit:
            written[axes[option]["axis"]] = unit
    if typed and "restitution" in {axes["x"]["axis"], axes["y"]["axis"]}:
        raise InvalidValueError("--restitution is an axis of this map: leave the option out")
    if refine is not None and not 1 <= refine <= 12:
        raise InvalidValueError(f"--refine must be in [1, 12], got {refine}")
    if refine is not None and len(typed or ()) > 1:
        raise InvalidValueError("--refine is for one --restitution: several are compared cell by cell")
    return {**axes, **({} if refine is None else {"refine": refine})}, written


def _axis(option: str, text: str) -> tuple[dict[str, Any], str]:
    """Return an axis as its table, and the unit that its values were written in.

    >>> _axis("--x", "semi_diagonal=40cm,80cm")
    ({'axis': 'semi_diagonal', 'values': [0.4, 0.8]}, 'cm')
    """
    from rocking.studies.axis import axes

    name, equals, values = text.partition("=")
    known = axes()
    name = checks.spelling(name.strip(), known)
    if name not in known:
        near = checks.nearest(name, known)
        raise InvalidValueError(f"{option}: no axis named {name!r:.60}; there are {', '.join(sorted(known))}{near}")
    if not equals or not values.strip():
        raise InvalidValueError(f"{option} must be {name}=FIRST:LAST:COUNT or {name}=A,B,C, got no values")
    table, written = values_table(name, values, known[name].unit)
    return {"axis": name, **table}, written


def body_line(body: Body, gravity: float, length: str = "m") -> str:
    """Return kind and mass of a plane body, and what decides how it rocks, of both feet where they differ.

    gravity: acceleration of gravity [m/s2].
    """
    feet: tuple[Foot, ...] = ("right",) if body.is_symmetric else FEET
    sides = {foot: body.side(foot, gravity) for foot in feet}
    shape = "; ".join(
        f"{'' if body.is_symmetric else f'{foot} '}alpha = {side.slenderness_angle:.4g} rad "
        f"({math.degrees(side.slenderness_angle):.3g} deg), R = {in_unit(side.semi_diagonal, length)}, "
        f"p = {side.frequency_parameter:.4g} rad/s"
        for foot, side in sides.items()
    )
    return f"{type(body).__name__}, {body.mass:.4g} kg, {shape}"


def body_lines(body: Body, gravity: float, length: str = "m") -> list[tuple[str, str]]:
    """Return what is printed of the body of a study; gravity: acceleration of gravity [m/s2]."""
    assumed = [("density", each.removeprefix("density ")) for each in body.assumed]
    return [("body", body_line(body, gravity, length)), *assumed]


def motion_facts(motion: Motion) -> dict[str, Any]:
    """Return a motion as plain values for JSON."""
    from rocking.motions.pulse import Pulse

    kind = "pulse" if isinstance(motion, Pulse) else "record"
    facts = {"duration_s": motion.duration, "peak_acceleration_m_s2": motion.peak}
    return {"kind": kind, "name": motion.name, **facts, "warnings": list(motion.doubts)}
