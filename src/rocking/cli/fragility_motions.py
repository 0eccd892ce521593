"""The motions of `rocking fragility`: record files, pulses, or a family of synthetic motions."""

from pathlib import Path
from typing import Any

from rocking.cli import study_output as shared
from rocking.cli.motion_options import motion_from
from rocking.cli.simulate_question import refuse_reversed
from rocking.cli.solid_options import is_body
from rocking.errors import InvalidValueError
from rocking.studies.motion_set import MotionList

COUNT, SEED = 100, 1
"""What serves where nobody says otherwise."""

MOST_MOTIONS = 5000
"""All of them are held in memory."""

_SOURCES = ("record", "synthetic", "count", "seed")


def body_and_records(body: str | None, motions: list[str], *, sized: bool) -> tuple[Path | None, list[str]]:
    """Return which word names the body and which ones the motions."""
    if sized and body is not None and not is_body(body):
        return None, [body, *motions]
    for motion in motions:
        refuse_reversed(body, motion)
    return None if body is None else Path(body), motions


def motions_from(
    sources: dict[str, Any], told: dict[str, Any], *, quiet: bool = False
) -> tuple[MotionList, dict[str, Any]]:
    """Return the motions that a command was given.

    Returns facts: kind, count, and family and seed, or names.
    """
    from rocking.motions.pulse import Pulse
    from rocking.studies.record_set import SyntheticSet

    records, synthetic, count, seed = (sources[name] for name in _SOURCES)
    if records:
        _refuse(
            {f"--{name}": sources[name] for name in _SOURCES[1:]}, "synthetic motions: leave it out beside --record"
        )
        found = MotionList([motion_from(word, **told) for word in records])
        kind = "pulses" if isinstance(found[0], Pulse) else "records"
        return found, {"kind": kind, "count": len(found), "names": [found[k].name for k in range(len(found))]}
    given = {"--" + name.replace("_", "-"): value for name, value in told.items()}
    _refuse(given, "record files: leave it out, or give --record")
    if synthetic is None:
        raise InvalidValueError("what shakes it? Give --record FILE, or --synthetic firm-ground")
    number = COUNT if count is None else count
    if not 1 <= number <= MOST_MOTIONS:
        raise InvalidValueError(f"--count must be in [1, {MOST_MOTIONS}], got {number}; rocking campaign takes more")
    family = SyntheticSet(synthetic, number, SEED if seed is None else seed)
    made = []
    with shared.bar("motions", number, quiet=quiet) as tell:
        for k in range(number):
            made.append(family[k])
            tell(1)
    return MotionList(made), {"kind": "synthetic", "count": number, "family": family.family.name, "seed": family.seed}


def _refuse(given: dict[str, Any], whose: str) -> None:
    odd = [name for name, value in given.items() if value is not None]
    if odd:
        raise InvalidValueError(f"{', '.join(odd)} is for {whose}")
