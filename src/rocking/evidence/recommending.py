"""The rule: which restitution model to use for one body, by the measurements of bodies like it (`judgement`)."""

import math
import warnings
from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from rocking import checks
from rocking.bodies import Body, Solid
from rocking.conventions import FEET, FloatArray, Foot
from rocking.errors import GeometryError, InvalidValueError, PlausibilityWarning, RockingError
from rocking.evidence._coefficient_table import CALIBRATED, default_models, interval_for
from rocking.evidence.calibration import Calibration, PredictedCoefficient
from rocking.evidence.hierarchy import calibrate_hierarchy
from rocking.evidence.judgement import Judgement, Standing, TrackRecord, judge
from rocking.evidence.measurements import DataSet, all_measurements
from rocking.evidence.recommendation import ModelForBody, Overturned, Recommendation, product
from rocking.outcome import Outcome
from rocking.restitution import (
    Calibrated,
    Fixed,
    ImpactGeometry,
    Interface,
    RestitutionModel,
    identity_report,
    implied,
    model,
)
from rocking.restitution._implied import energy_bound
from rocking.restitution.calibrated import scatter
from rocking.restitution.impact import contact_of, is_whole_base
from rocking.restitution.shifted_impulse import shifted

_DRAWS = 400
_SEED = 0


def recommend(
    body: Body | Solid,
    motion: Any = None,
    *,
    models: Sequence[str | RestitutionModel] | None = None,
    measurements: DataSet | None = None,
) -> Recommendation:
    """Return which restitution model to use for a body, and how sure that is.

    The rule is one of the measurements, and nobody's opinion. Models stand against the measurements of similar
    slenderness; one whose error is above that of the closest by a 95 % paired bootstrap interval, and by more than the
    measurements were rounded, is set aside, unless the body is outside of what was measured. For a number the
    calibrated default is taken, which is judged by groups that it has not seen; where it is set aside, the closest
    model that remains. For a decision its scatter is drawn, and the models of the lowest and of the highest coefficient
    that remain are run beside it.

    Parameters
    ----------
    body : Body or Solid
        The body. No body in space was measured: of a Solid it is said what is known.
    motion : GroundMotion or Pulse, optional
        A motion, for the verdict under every model and under coefficients that scatter; of bodies in the plane.
    models : sequence of str or RestitutionModel, optional
        Models to judge, which may be your own; every registered one if not given.
    measurements : DataSet, optional
        What was measured, if not the 39 published coefficients; the calibrated default is then fitted to it, which
        takes a second.

    Returns
    -------
    Recommendation
        Models side by side, the model for a number and those for a decision, in words by `print`.

    Raises
    ------
    InvalidValueError
        If the body is none, a model is a value given by hand, or a motion is given for a body in space.
    UnknownModelError
        If there is no model of a name.

    Examples
    --------
    >>> import rocking as rk
    >>> found = rk.evidence.recommend(rk.Block(width=0.02, height=0.16, depth=0.02))
    >>> found.prediction, found["calibrated"].standing.value
    ('calibrated', 'closest')
    >>> [each.name for each in found.models if each.name in found.remaining]
    ['calibrated', 'housner']
    """
    checks.of_kind("body", body, (Body, Solid), "a Block, Section, MassPoints or Solid")
    given: Any = body
    if not isinstance(given, Body):
        return _in_space(given, motion, models)
    data = all_measurements() if measurements is None else measurements
    known: object = data
    if not isinstance(known, DataSet) or not len(known):
        raise InvalidValueError(parameter="measurements", allowed="a DataSet of at least one row", value=measurements)
    candidates = [
        each for each in (default_models() if models is None else _chosen(models)) if not isinstance(each, Calibrated)
    ]
    refused = [(each, _refusals(each, given)) for each in candidates]
    admitted = [each for each, reasons in refused if not reasons]
    ratios = tuple(sorted({given.side(foot).slenderness_ratio for foot in FEET}))
    judged = judge(admitted, ratios, data)
    posterior = calibrate_hierarchy(data)
    title = f"default, fitted to the measurements: {posterior.model().label}"
    predicted: list[tuple[str, str, dict[Foot, PredictedCoefficient], TrackRecord, tuple[str, ...]]] = [
        (CALIBRATED, title, _both(given, posterior.predict), judged.calibrated, ())
    ]
    for each, record in zip(admitted, judged.models, strict=True):
        interval = _both(given, lambda body, foot, each=each: interval_for(each, body, foot=foot, measurements=data))
        predicted.append((each.label, each.title, interval, record, _concerns(each, given)))
    rows = [_row(*each) for each in sorted(predicted, key=lambda each: each[3].rmse)]
    rows += [
        ModelForBody(each.label, each.title, Standing.EXCLUDED, {}, reasons=reasons)
        for each, reasons in refused
        if reasons
    ]
    outside, notes = _outside(given, data)
    made = _picked(given, rows, judged, outside, notes)
    return made if motion is None else _moved(made, motion, posterior)


def _chosen(models: Sequence[Any]) -> list[RestitutionModel]:
    found = {each.label: each for each in map(model, _several(models))}
    if not isinstance(found.get(CALIBRATED, Calibrated()), Calibrated):
        raise InvalidValueError(
            "{name!r} is the default, which is judged anyhow", name=CALIBRATED, hint="give your model another name"
        )
    for each in found.values():
        if isinstance(each.model if isinstance(each, Interface) else each, Fixed):
            raise InvalidValueError(
                "{label} is a value given by hand: nothing that was measured on other bodies can judge it",
                label=each.label, hint="if it was measured on this body it is better than every model",
            )  # fmt: skip
    return list(found.values())


def _several(models: Any) -> list[Any]:
    several = list(models) if isinstance(models, Iterable) and not isinstance(models, str) else [models]
    if not several:
        raise InvalidValueError("models must be at least one, got none")
    return several


def _refusals(which: RestitutionModel, body: Body) -> tuple[str, ...]:
    """Return why a model does not hold for a body: it does not know it, the body stops, or mechanics forbids it."""
    found: list[str] = []
    for foot in FEET:
        try:
            given = which.evaluate(body, foot)
        except RockingError as error:
            return (str(error),)
        found += [flag.value for flag in given.flags]
        means = implied(body, given.coefficient, foot=foot)
        # of rectangles a loss was measured that no impulse on the base explains: what an interface factor takes
        beyond = means.within_energy and (_is_rectangle(body) or isinstance(which, Interface))
        found += [] if beyond else [f"onto the {foot} foot it {each}" for each in means.objections]
    return tuple(dict.fromkeys(found))


def _concerns(which: RestitutionModel, body: Body) -> tuple[str, ...]:
    """Return how far a model depends on how mass is spread, of a body that is not like those measured."""
    if which.inertia_only or _is_rectangle(body):
        return ()
    found = []
    feet: tuple[Foot, ...] = ("right",) if body.is_symmetric else FEET
    for foot in feet:
        check = next(each for each in identity_report(body, which, foot=foot) if each.name == "inertia alone")
        if not check.holds:
            where = "" if body.is_symmetric else f" onto the {foot} foot"
            found.append(f"{check.found:.3f} instead of {check.expected:.3f}{where}")
    words = "two masses of the same mass, centre, inertia and base would have r ="
    return (f"{words} {', '.join(found)}; rigid bodies that move alike should not differ",) if found else ()


def _both(body: Body, predict: Any) -> dict[Foot, PredictedCoefficient]:
    right = predict(body, foot="right")
    return {"left": right if body.is_symmetric and _is_rectangle(body) else predict(body, foot="left"), "right": right}


def _row(
    name: str, title: str, intervals: dict[Foot, PredictedCoefficient], record: TrackRecord, concerns: tuple[str, ...]
) -> ModelForBody:
    values, low, high = (
        {str(foot): float(getattr(each, key)) for foot, each in intervals.items()}
        for key in ("coefficient", "low", "high")
    )
    return ModelForBody(name, title, record.standing, values, low, high, record, concerns=concerns)


def _is_rectangle(body: Body) -> bool:
    """Whether a body is what was measured: a homogeneous rectangle on its whole base, by its moments."""
    geometry = ImpactGeometry.of_body(body, "right")
    b, h = float(geometry.new_lever), float(geometry.height)
    like = math.isclose(geometry.spread_x, b * b / 3.0, rel_tol=1e-6) and math.isclose(
        geometry.spread_y, h * h / 3.0, rel_tol=1e-6
    )
    return body.is_symmetric and like and is_whole_base(contact_of(body, "right"), geometry)


def _outside(body: Body, data: DataSet) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return why a body is outside of what was measured, and what else is not known of it."""
    low, high = float(data.slenderness.min()), float(data.slenderness.max())
    found, notes = [], []
    ratios = sorted({body.side(foot).slenderness_ratio for foot in FEET})
    if not all(low <= ratio <= high for ratio in ratios):
        words = " and ".join(f"{ratio:.3g}" for ratio in ratios)
        found.append(f"h/b = {words} is outside the measured range {low:.3g} to {high:.3g}")
    if not body.is_symmetric:
        found.append("its feet are not equally far from its centre, and no such body was measured")
    elif not _is_rectangle(body):
        found.append("it is no homogeneous rectangle on its whole base, and nothing else was measured")
    weighed = data.mass[np.isfinite(data.mass)]
    if weighed.size and not weighed.min() <= body.mass <= weighed.max():
        notes.append(
            f"It has a mass of {body.mass:.4g} kg; the specimens whose mass is known have {weighed.min():.3g} to "
            f"{weighed.max():.3g} kg. No model here depends on size: that none does is not measured."
        )
    notes.append(
        "What is between base and ground (dust, mortar, rubber) is not known here; it can cost more than shape."
    )
    return tuple(found), tuple(notes)


def _picked(
    body: Any, rows: list[ModelForBody], judged: Judgement | None, outside: tuple[str, ...], notes: tuple[str, ...]
) -> Recommendation:
    """Apply the rule: the calibrated default for a number unless it is set aside, then the closest that remains."""
    open_ = Recommendation(body, tuple(rows), judged, outside, notes, "", ())
    remains = [each for each in rows if each.name in open_.remaining]
    holds = [each for each in rows if each.standing is not Standing.EXCLUDED]
    number = CALIBRATED if CALIBRATED in open_.remaining else (remains or holds)[0].name if judged and holds else ""
    by_value = sorted(remains or holds, key=lambda each: product(each.coefficients))
    envelope = tuple(dict.fromkeys(each.name for each in (by_value[:1] + by_value[-1:])))
    return replace(open_, prediction=number, envelope=envelope)


def _moved(made: Recommendation, motion: Any, posterior: Calibration) -> Recommendation:
    """Return it with the verdict of every model under a motion, and of coefficients that scatter."""
    from rocking.dynamics import simulate_many
    from rocking.statistics.counts import share_interval

    body, holds = made.body, [each for each in made.models if each.coefficients]
    drawn = _draws(made, posterior)
    pairs = [dict(each.coefficients) for each in holds]
    pairs += [dict(zip(FEET, each, strict=True)) for each in drawn.T.tolist()]
    with warnings.catch_warnings():
        # what scatters below what was ever measured was not given by anybody
        warnings.simplefilter("ignore", PlausibilityWarning)
        found = simulate_many(body, motion, pairs).squeeze(["body", "motion", "scale"])
    outcomes = [list(Outcome)[code] for code in found["outcome"].values.tolist()]
    moved: dict[str, Any] = {}
    for each, outcome, peak in zip(holds, outcomes, found["peak_rotation"].values.tolist(), strict=False):
        alpha = body.side("right" if peak > 0.0 else "left").slenderness_angle
        moved[each.name] = {"outcome": outcome, "peak_ratio": abs(peak) / alpha}
    models = tuple(replace(each, **moved.get(each.name, {})) for each in made.models)
    known = [each for each in outcomes[len(holds) :] if each is not Outcome.FAILED]
    count = sum(each is Outcome.OVERTURNED for each in known)
    share = Overturned(count, len(known), *share_interval(count, len(known)))
    return replace(made, models=models, overturned=share)


def _draws(made: Recommendation, posterior: Calibration) -> FloatArray:
    """Return coefficients of bodies about the model for a number, onto the left and the right foot: shape (2, n)."""
    random = np.random.default_rng(_SEED)
    z, parameters = random.standard_normal(_DRAWS), posterior.draw(_DRAWS, _SEED).T
    found = []
    for foot in FEET:
        bound = energy_bound(made.body, foot)
        if made.prediction == CALIBRATED:
            eta, k, s, gamma = parameters
            mean = np.clip(eta * shifted(ImpactGeometry.of_body(made.body, foot), k), 0.0, bound)
            values = mean + scatter(mean, s, gamma) * z  # Eq. 137
        else:
            row = made[made.prediction]
            values = row.coefficients[foot] + row.scatter(foot) * z
        found.append(np.clip(values, 0.0, bound))
    return np.array(found)


def _in_space(solid: Solid, motion: Any, models: Sequence[Any] | None) -> Recommendation:
    from rocking.bodies.solid import SupportPolygon
    from rocking.restitution.space import impact_in_space, spatial_model, spatial_models
    from rocking.restitution.space.impact import NO_MATTER

    if motion is not None:
        raise InvalidValueError(
            "a motion is for bodies in the plane; rk.simulate follows a Solid in space, under one model each time"
        )
    outside = ("it rocks in space, and every measurement is of a block that rocks in one plane",)
    base, notes = solid.base, []
    if not isinstance(base, SupportPolygon):
        notes.append(
            "A round base rolls round its rim and has no impact in one plane: the ideal model keeps its energy, and "
            "what a real rim costs is not measured. rk.simulate follows it as it rolls."
        )
        return Recommendation(solid, (), None, outside, tuple(notes), "", ())
    start = min(range(len(base.edges)), key=lambda i: _reach(solid, base.edges[i]))
    edge = base.edges[start]
    try:
        onto: Any = base.opposite(start)
        place = "the opposite edge"
    except GeometryError:
        depth = [float(np.cross(edge.direction, corner.point - edge.point)[2]) for corner in base.corners]
        onto, place = base.corners[depth.index(max(depth))], "the far corner"
    rows = []
    for each in [spatial_model(name) for name in _several(spatial_models() if models is None else models)]:
        if each.needs_solid and solid.known is not None:
            rows.append(ModelForBody(each.name, each.title, Standing.EXCLUDED, {}, reasons=(NO_MATTER,)))
            continue
        found = impact_in_space(solid, -edge.direction, pivot=edge, onto=onto, model=each)
        reasons = tuple(flag.value for flag in found.flags)
        standing = Standing.EXCLUDED if reasons else Standing.UNJUDGED
        rows.append(ModelForBody(each.name, each.title, standing, {place: found.coefficient}, reasons=reasons))
    rows.sort(key=lambda each: each.standing is Standing.EXCLUDED)
    notes.append(
        f"The coefficients are those of a fall back onto {place} from edge {start}, over which it overturns most "
        "easily; rocking restitution lists every edge."
    )
    return _picked(solid, rows, None, outside, tuple(notes))


def _reach(solid: Solid, edge: Any) -> float:
    """Distance of the plumb line of the centre from an edge [m], without the last digits, which tell sides apart."""
    return round(abs(float(np.cross(edge.direction, solid.centre - edge.point)[2])), 9)
