"""The shaking of `rocking inventory`: records or a family of synthetic motions, and a level."""

from collections.abc import Callable, Sequence
from typing import Any

from rocking.errors import InvalidValueError
from rocking.studies.inventory.hazard import COUNT, FAMILY, SEED, Hazard, Level


def hazard_from(
    records: Sequence[str] | None,
    synthetic: str | None,
    pga: str | None,
    pgv: str | None,
    *,
    count: int | None,
    seed: int | None,
    told: dict[str, Any],
    progress: Callable[[int], None] | None = None,
) -> Hazard:
    """Return the hazard that a command was given.

    count, seed: of the synthetic motions [-].
    """
    if pga is not None and pgv is not None:
        raise InvalidValueError("give --pga or --pgv, not both: motions are scaled to one of them")
    level = None
    if pga is not None or pgv is not None:
        level = Level.of("PGA", pga) if pga is not None else Level.of("PGV", str(pgv))
    if records:
        alone = {"--synthetic": synthetic, "--count": count, "--seed": seed}
        odd = [name for name, value in alone.items() if value is not None]
        if odd:
            raise InvalidValueError(f"{', '.join(odd)} is for synthetic motions: leave it out beside --record")
        return Hazard.of_records([_record(word, told) for word in records], level)
    odd = ["--" + name.replace("_", "-") for name, value in told.items() if value is not None]
    if odd:
        raise InvalidValueError(f"{', '.join(odd)} is for record files: leave it out, or give --record")
    if level is None:
        raise InvalidValueError("how strong is the shaking? Give --pga 0.3g or --pgv 25cm/s, or --record FILE")
    number, start = COUNT if count is None else count, SEED if seed is None else seed
    return Hazard.of_family(synthetic or FAMILY, level, count=number, seed=start, progress=progress)


def _record(word: str, told: dict[str, Any]) -> Any:
    from rocking.cli.motion_options import motion_from
    from rocking.motions.pulse import Pulse

    motion = motion_from(word, **told)
    if isinstance(motion, Pulse):
        raise InvalidValueError(f"--record takes record files, got the pulse {word[:80]!r}")
    return motion
