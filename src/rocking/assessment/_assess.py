"""`assess`: histories with every model, margins, code methods, a probability, and remedies."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from rocking import checks, conventions
from rocking.assessment.answer import BodyAssessment, ModelMargin
from rocking.assessment.in_space import SolidHistories, numbered
from rocking.bodies import Body, Solid
from rocking.conventions import FEET, FloatArray, IntArray
from rocking.dynamics.parameters import RockingParameters
from rocking.errors import InvalidValueError, RockingError
from rocking.evidence import restitution_distribution
from rocking.motions.components import rotated, with_vertical
from rocking.motions.intensity import sampled
from rocking.motions.motion import GroundMotion
from rocking.prediction import predict
from rocking.prediction.mechanics import FRICTION, Uncertain, parts, several
from rocking.restitution import RestitutionModel, model, models
from rocking.studies.code_methods import CODE_METHODS
from rocking.studies.code_methods.methods import BodySides, Shaking
from rocking.studies.motion_sets import MotionList
from rocking.studies.remedies import CALIBRATED, Margins, lifting_factor, remedies

ENDS = {"low": 0.025, "high": 0.975}
"""Of the 95 % interval of what is measured of single bodies, which are asked beside the calibrated model: quantiles."""

MOST_ASKED = 50.0
"""Largest factor on the motions that remedies may be asked to hold, that up to which margins are looked for [-]."""

DIRECTIONS = 12
"""Over half a turn, into which two components are turned; both ways round make it a whole one."""

IN_SPACE = CALIBRATED, "ked", "housner"
"""Models that say something of solids, where nobody names others."""


def assess(
    body: Body | Solid,
    motions: Any,
    restitution: Any = None,
    *,
    friction: Any = None,
    margin: float = 1.0,
    gravity: float = conventions.g,
    threads: int | None = None,
    progress: Callable[[int], None] | None = None,
    **known: Any,
) -> BodyAssessment:
    """Say whether a body stands under motions, how far it is from overturning, what decides it and what to do.

    Histories are computed under every motion, both ways round, with every model of restitution, rocking alone, and with
    the one of the least margin also where it may slide. Each is repeated at factors on the motion, to find the least
    one that overturns. Beside them stand a probability, in which what is not known is drawn, and the code methods.

    Parameters
    ----------
    body : Block, Section, MassPoints or Solid
        A body in its plane; or a solid, which stands in space on the vertices of its hull, in the pose into which it
        settles. Code methods and remedies of a solid are those of ``solid.in_plane`` over its nearest edge.
    motions : GroundMotion, Pulse, or mapping with x, y and z, or a sequence of them
        With y, the body is turned to both components in 12 directions; a solid in 6, with one component too.
    restitution : str, float, RestitutionModel or a sequence of them, optional
        Names, models and coefficients; if not given all registered models, and of the calibrated one its mean and
        both ends of its 95 % interval; of a solid "calibrated", "ked", "housner" and coefficients [-].
    friction : as for `predict`
        Coefficient of friction; histories that slide, and all of a solid, take its median [-].
    margin : float
        Factor on the motions that remedies must hold, up to 50 [-].
    gravity : float
        Acceleration of gravity [m/s2].
    threads : int, optional
        Threads of the engine.
    progress : callable, optional
        Called with the number of histories done since the last call.
    **known
        What else is known of the body, as for `predict`: ``base``, ``centre``, ``polarity``, ``azimuth``, ``count``,
        ``seed`` and more; also its ``restitution`` as ``predicted``. With a number as azimuth it is not turned.

    Returns
    -------
    BodyAssessment
        Verdict, margins, probability, code methods, remedies.

    Raises
    ------
    InvalidValueError
        If it is no body, a motion is zero throughout, or a value is outside its range.

    Examples
    --------
    >>> import rocking as rk
    >>> found = assess(rk.Block(width=0.5, height=2.0, mass=300.0), rk.pulses.sine(2.0, 0.8), ["ked", 0.95], count=16)
    >>> found.verdict
    'It does not lift: it overturns under none of 1 motion, with none of 2 restitutions, either way round.'
    """
    checks.of_kind("body", body, (Body, Solid), "a Block, Section, MassPoints or Solid")
    checks.within("margin", margin, 0.0, MOST_ASKED, open_low=True)
    margin, gravity = float(margin), checks.positive("gravity", gravity, "m/s2")
    if isinstance(restitution, (str, int, float, RestitutionModel)):
        restitution = [restitution]
    whole = several(motions)
    given = FRICTION[0] if friction is None else friction
    coefficient = float(Uncertain.of("friction", given, *FRICTION[1:]).quantile(np.array([0.5]))[0])
    options = {"gravity": gravity, "threads": threads, "progress": progress}
    space: SolidHistories | None = None
    moving: Sequence[Any]
    if isinstance(body, Solid):
        space = SolidHistories(body, whole, known.get("azimuth"), coefficient, options)
        flat, moving, records, body, whole = space.body, space.motions, space.records, space.standing.solid, space.given
        plane = [each.in_plane for each in space.motions]
        asked = IN_SPACE if restitution is None else restitution
        restitution = [each.removesuffix("-3d") if isinstance(each, str) else each for each in asked]
    else:
        plane, records = in_the_plane(whole, known.get("azimuth"))
        flat, moving = body, plane
    if still := next((each for each in plane if not each.peak > 0.0), None):
        raise InvalidValueError(f"motion {still.name!r} is zero throughout: nothing would move")
    different = list({id(each): each for each in plane}.values())
    place = [next(k for k, other in enumerate(different) if other is each) for each in plane]
    kept = MotionList(different)
    lifts = np.array([lifting_factor(flat, each, gravity) for each in plane]) if space is None else space.lifts()

    chosen = choices(flat, restitution)
    found, beside, refused = _margins(flat, kept, chosen, options, space, lifts)
    worst = sorted(found, key=lambda name: np.nan_to_num(found[name].lowest, nan=np.inf))
    lowest = float(np.nanmin([*(each.lowest for each in beside.values()), np.inf]))
    standing = None
    if space is None:
        sliding = _margin(flat, kept, chosen[worst[0]], {**options, "friction": coefficient})
    else:
        sliding = found[worst[0]]
        standing = space.fallen(sliding, *_told(worst[0], chosen[worst[0]]), lowest)
    falls = max(lowest, sliding.lowest) if space else lowest
    sides, shaking = BodySides.of([flat], gravity), Shaking.of(kept)
    prediction = predict(
        body, whole, restitution=known.pop("predicted", None), friction=friction, gravity=gravity, threads=threads,
        progress=progress, **known,
    )  # fmt: skip
    return BodyAssessment(
        body=flat, motions=tuple(moving), records=records, models=found, refused=refused,
        friction=coefficient, sliding=sliding, lifts=lifts,
        capacities={name: each.capacity(sides, shaking)[place, 0] for name, each in CODE_METHODS.items()},
        prediction=prediction,
        remedies=remedies(
            flat, different, margin, gravity, {name: chosen[name] for name in worst}, falls=falls <= margin
        ),
        gravity=gravity, standing=standing,
    )  # fmt: skip


def in_the_plane(motions: Any, azimuth: Any = None) -> tuple[list[GroundMotion], IntArray]:
    """Return what moves a body in its plane, one component as it is, two turned into every direction, and of which."""
    found: list[GroundMotion] = []
    records: list[int] = []
    for k in range(len(motions)):
        along, across, upright = parts(motions[k])
        turned = {"": sampled(along)}
        if across is not None:
            fixed = isinstance(azimuth, (int, float))
            angles = [float(azimuth)] if fixed else np.pi * np.arange(DIRECTIONS) / DIRECTIONS
            turned = {f", {np.degrees(a):.0f} deg": rotated(along, across, float(a))[0] for a in angles}
        for words, each in turned.items():
            name = f"{along.name}{words}"
            vertical = each.vertical if upright is None else with_vertical(each, sampled(upright)).vertical
            samples = each.acceleration if vertical is None else each.acceleration[: len(vertical)]
            called = numbered(name, found)
            found.append(GroundMotion(samples, each.time_step, vertical, called, each.metadata, each.provenance))
            records.append(k)
    return found, np.array(records)


def choices(body: Body, given: Sequence[Any] | None) -> Mapping[str, Any]:
    """Return the restitutions of histories by their names."""
    named: dict[str, Any] = {}
    usual = [CALIBRATED, *(name for name in models() if name not in {CALIBRATED, "fixed"})]
    for each in usual if given is None else given:
        if each == CALIBRATED:
            named[CALIBRATED], drawn = model(each), restitution_distribution(body)
            for end, level in ENDS.items():
                named[f"{CALIBRATED}, {end}"] = {foot: float(drawn.quantile(level, foot)) for foot in FEET}
        elif isinstance(each, (int, float)):
            named[f"r = {each:g}"] = float(each)
        else:
            one = model(each)
            named[one.label] = one
    return named


def _told(name: str, choice: Any) -> tuple[Any, float]:
    """Return a restitution by its name as `predict` takes it of a solid, and the probability of its distribution."""
    what, _, end = name.partition(", ")
    if what == CALIBRATED:
        return None, ENDS.get(end, 0.5)
    return (choice if isinstance(choice, float) else what), 0.5


def _margins(
    body: Body, motions: MotionList, chosen: Mapping[str, Any], options: dict[str, Any],
    space: SolidHistories | None, lifts: FloatArray,
) -> tuple[dict[str, ModelMargin], dict[str, ModelMargin], dict[str, str]]:  # fmt: skip
    """Return the margins, those of the plane body beside a solid, and what says nothing of it, by restitution."""
    found, beside, refused = dict[str, ModelMargin](), dict[str, ModelMargin](), dict[str, str]()
    for name, choice in chosen.items():
        try:
            flat = _margin(body, motions, choice, options)
            found[name] = flat if space is None else space.margin(flat, *_told(name, choice), lifts)
            beside[name] = flat
        except RockingError as error:
            refused[name] = str(error)
    if not found:
        raise InvalidValueError(f"no restitution says anything of this body: {'; '.join(refused.values())}")
    return found, beside, refused


def _margin(body: Body, motions: MotionList, restitution: Any, options: dict[str, Any]) -> ModelMargin:
    found = Margins.of(body, motions, restitution, "pga", None, options)
    # a factor of 1 may lie in a stretch that the levels have missed
    least = np.where(found.fell_each[:, :, 0] == 1.0, np.minimum(found.least_each, 1.0), found.least_each)
    parameters = RockingParameters.of_body(body, restitution, options["gravity"])
    return ModelMargin({foot: getattr(parameters, foot).coefficient for foot in FEET}, found.overturned[:, 0], least)
