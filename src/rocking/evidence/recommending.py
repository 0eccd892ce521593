"""The recommendation rule: restitution model of one body from the measurements of similar bodies (`judgement`)."""

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
    """Recommend a restitution model for a body, with its evidence.

    The rule uses only measurements. Models are compared with the measurements of similar slenderness. A model is
    excluded if its error exceeds that of the closest by a 95 % paired bootstrap interval and by more than the rounding
    of the measurements, unless the body is outside the measured range. The model for a single value is the calibrated
    default, compared with groups not used in its fit; if excluded, the closest remaining model. For a decision, the
    coefficient is sampled about this model, and compared with the lowest and highest remaining models.

    Parameters
    ----------
    body : Body or Solid
        The body. There are no measurements of 3D bodies: for a Solid, the models are not ranked.
    motion : GroundMotion or Pulse, optional
        Motion for the outcome with all models and with sampled coefficients; plane bodies only.
    models : sequence of str or RestitutionModel, optional
        Models to compare, also user models; default: all registered models.
    measurements : DataSet, optional
        Measurements; default: the 39 published coefficients. The calibrated default is fitted to other measurements in
        about 1 s.

    Returns
    -------
    Recommendation
        Comparison of models, model for a single value, and models for a decision; `print` gives sentences.

    Raises
    ------
    InvalidValueError
        If the body has another type, a model is a fixed value, or a motion is given for a 3D body.
    UnknownModelError
        If a model name is unknown.

    Examples
    --------
    >>> import rocking as rk
    >>> recommendation = rk.evidence.recommend(rk.Block(width=0.02, height=0.16, depth=0.02))
    >>> recommendation.prediction, recommendation["calibrated"].standing.value
    ('calibrated', 'closest')
    >>> [model.name for model in recommendation.models if model.name in recommendation.remaining]
    ['calibrated', 'housner']
    """
    checks.of_kind("body", body, (Body, Solid), "a Block, Section, MassPoints or Solid")
    subject: Any = body
    if not isinstance(subject, Body):
        return _in_space(subject, motion, models)
    data = all_measurements() if measurements is None else measurements
    argument: object = data
    if not isinstance(argument, DataSet) or not len(argument):
        raise InvalidValueError(parameter="measurements", allowed="a DataSet of at least one row", value=measurements)
    candidates = [
        candidate
        for candidate in (default_models() if models is None else _chosen(models))
        if not isinstance(candidate, Calibrated)
    ]
    refused = [(candidate, _refusals(candidate, subject)) for candidate in candidates]
    admitted = [candidate for candidate, reasons in refused if not reasons]
    ratios = tuple(sorted({subject.side(foot).slenderness_ratio for foot in FEET}))
    judgement = judge(admitted, ratios, data)
    posterior = calibrate_hierarchy(data)
    title = f"default, fitted to the measurements: {posterior.model().label}"
    predicted: list[tuple[str, str, dict[Foot, PredictedCoefficient], TrackRecord, tuple[str, ...]]] = [
        (CALIBRATED, title, _both(subject, posterior.predict), judgement.calibrated, ())
    ]
    for candidate, record in zip(admitted, judgement.models, strict=True):
        interval = _both(
            subject, lambda body, foot, candidate=candidate: interval_for(candidate, body, foot=foot, measurements=data)
        )
        predicted.append((candidate.label, candidate.title, interval, record, _concerns(candidate, subject)))
    rows = [_row(*candidate) for candidate in sorted(predicted, key=lambda candidate: candidate[3].rmse)]
    rows += [
        ModelForBody(candidate.label, candidate.title, Standing.EXCLUDED, {}, reasons=reasons)
        for candidate, reasons in refused
        if reasons
    ]
    outside, notes = _outside(subject, data)
    recommendation = _picked(subject, rows, judgement, outside, notes)
    return recommendation if motion is None else _moved(recommendation, motion, posterior)


def _chosen(models: Sequence[Any]) -> list[RestitutionModel]:
    by_label = {candidate.label: candidate for candidate in map(model, _several(models))}
    if not isinstance(by_label.get(CALIBRATED, Calibrated()), Calibrated):
        raise InvalidValueError(
            "the name {name!r} is reserved for the default model", name=CALIBRATED, hint="rename your model"
        )
    for candidate in by_label.values():
        if isinstance(candidate.model if isinstance(candidate, Interface) else candidate, Fixed):
            raise InvalidValueError(
                "{label} is a fixed value and cannot be compared with measurements of other bodies",
                label=candidate.label, hint="use the value directly, without a comparison",
            )  # fmt: skip
    return list(by_label.values())


def _several(models: Any) -> list[Any]:
    several = list(models) if isinstance(models, Iterable) and not isinstance(models, str) else [models]
    if not several:
        raise InvalidValueError("models must contain one or more models, got 0")
    return several


def _refusals(candidate: RestitutionModel, body: Body) -> tuple[str, ...]:
    """Return the reasons why a model does not hold for a body: domain, stop at impact, or laws of mechanics."""
    objections: list[str] = []
    for foot in FEET:
        try:
            evaluated = candidate.evaluate(body, foot)
        except RockingError as error:
            return (str(error),)
        objections += [flag.value for flag in evaluated.flags]
        means = implied(body, evaluated.coefficient, foot=foot)
        # the interface factor, because measured rectangles lose more energy than an impulse on the base explains
        beyond = means.within_energy and (_is_rectangle(body) or isinstance(candidate, Interface))
        objections += [] if beyond else [f"on the {foot} foot it {objection}" for objection in means.objections]
    return tuple(dict.fromkeys(objections))


def _concerns(restitution: RestitutionModel, body: Body) -> tuple[str, ...]:
    """Return the dependence of a model on the mass distribution, for a body that differs from the measured bodies."""
    if restitution.inertia_only or _is_rectangle(body):
        return ()
    differences = []
    feet: tuple[Foot, ...] = ("right",) if body.is_symmetric else FEET
    for foot in feet:
        check = next(
            candidate
            for candidate in identity_report(body, restitution, foot=foot)
            if candidate.name == "inertia alone"
        )
        if not check.holds:
            where = "" if body.is_symmetric else f" on the {foot} foot"
            differences.append(f"{check.computed:.3f} instead of {check.expected:.3f}{where}")
    text = "two point masses with equal total mass, centre, inertia and base would have r ="
    return (
        (f"{text} {', '.join(differences)}; rigid bodies with equal motion should have equal r",) if differences else ()
    )


def _both(body: Body, predict: Any) -> dict[Foot, PredictedCoefficient]:
    right = predict(body, foot="right")
    return {"left": right if body.is_symmetric and _is_rectangle(body) else predict(body, foot="left"), "right": right}


def _row(
    name: str, title: str, intervals: dict[Foot, PredictedCoefficient], record: TrackRecord, concerns: tuple[str, ...]
) -> ModelForBody:
    values, low, high = (
        {str(foot): float(getattr(prediction, key)) for foot, prediction in intervals.items()}
        for key in ("coefficient", "low", "high")
    )
    return ModelForBody(name, title, record.standing, values, low, high, record, concerns=concerns)


def _is_rectangle(body: Body) -> bool:
    """Return True for a body of the measured type: by its moments, a homogeneous rectangle on its full base."""
    geometry = ImpactGeometry.of_body(body, "right")
    b, h = float(geometry.new_lever), float(geometry.height)
    like = math.isclose(geometry.spread_x, b * b / 3.0, rel_tol=1e-6) and math.isclose(
        geometry.spread_y, h * h / 3.0, rel_tol=1e-6
    )
    return body.is_symmetric and like and is_whole_base(contact_of(body, "right"), geometry)


def _outside(body: Body, data: DataSet) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the reasons why a body is outside the measured range, and further limitations."""
    low, high = float(data.slenderness.min()), float(data.slenderness.max())
    reasons, notes = [], []
    ratios = sorted({body.side(foot).slenderness_ratio for foot in FEET})
    if not all(low <= ratio <= high for ratio in ratios):
        ratios_text = " and ".join(f"{ratio:.3g}" for ratio in ratios)
        reasons.append(f"h/b = {ratios_text} is outside the measured range {low:.3g} to {high:.3g}")
    if not body.is_symmetric:
        reasons.append("its feet have different distances from the centre of mass, and no such body was measured")
    elif not _is_rectangle(body):
        reasons.append("it is not a homogeneous rectangle on its full base, and no other bodies were measured")
    weighed = data.mass[np.isfinite(data.mass)]
    if weighed.size and not weighed.min() <= body.mass <= weighed.max():
        notes.append(
            f"The body has a mass of {body.mass:.4g} kg; specimens with known mass have {weighed.min():.3g} to "
            f"{weighed.max():.3g} kg. No model depends on size; measurements do not confirm this independence."
        )
    notes.append(
        "The layer between base and ground (dust, mortar, rubber) is unknown; it can cause more energy loss than shape."
    )
    return tuple(reasons), tuple(notes)


def _picked(
    body: Any, rows: list[ModelForBody], judgement: Judgement | None, outside: tuple[str, ...], notes: tuple[str, ...]
) -> Recommendation:
    """Return the model for a single value: the calibrated default, or if excluded, the closest remaining model."""
    undecided = Recommendation(body, tuple(rows), judgement, outside, notes, "", ())
    remains = [row for row in rows if row.name in undecided.remaining]
    holds = [row for row in rows if row.standing is not Standing.EXCLUDED]
    number = (
        CALIBRATED if CALIBRATED in undecided.remaining else (remains or holds)[0].name if judgement and holds else ""
    )
    by_value = sorted(remains or holds, key=lambda row: product(row.coefficients))
    envelope = tuple(dict.fromkeys(row.name for row in (by_value[:1] + by_value[-1:])))
    return replace(undecided, prediction=number, envelope=envelope)


def _moved(recommendation: Recommendation, motion: Any, posterior: Calibration) -> Recommendation:
    """Return the recommendation with the outcomes under a motion, for all models and sampled coefficients."""
    from rocking.dynamics import simulate_many
    from rocking.statistics.counts import share_interval

    body, holds = recommendation.body, [item for item in recommendation.models if item.coefficients]
    drawn = _draws(recommendation, posterior)
    pairs = [dict(item.coefficients) for item in holds]
    pairs += [dict(zip(FEET, item, strict=True)) for item in drawn.T.tolist()]
    with warnings.catch_warnings():
        # no warning for sampled coefficients below all measurements, because they are not input of the user
        warnings.simplefilter("ignore", PlausibilityWarning)
        results = simulate_many(body, motion, pairs).squeeze(["body", "motion", "scale"])
    outcomes = [list(Outcome)[code] for code in results["outcome"].values.tolist()]
    by_name: dict[str, Any] = {}
    for item, outcome, peak in zip(holds, outcomes, results["peak_rotation"].values.tolist(), strict=False):
        alpha = body.side("right" if peak > 0.0 else "left").slenderness_angle
        by_name[item.name] = {"outcome": outcome, "peak_ratio": abs(peak) / alpha}
    models = tuple(replace(item, **by_name.get(item.name, {})) for item in recommendation.models)
    valid = [item for item in outcomes[len(holds) :] if item is not Outcome.FAILED]
    count = sum(item is Outcome.OVERTURNED for item in valid)
    share = Overturned(count, len(valid), *share_interval(count, len(valid)))
    return replace(recommendation, models=models, overturned=share)


def _draws(recommendation: Recommendation, posterior: Calibration) -> FloatArray:
    """Return sampled coefficients about the recommended model, left and right foot, shape (2, n) [-]."""
    random = np.random.default_rng(_SEED)
    z, parameters = random.standard_normal(_DRAWS), posterior.draw(_DRAWS, _SEED).T
    draws = []
    for foot in FEET:
        bound = energy_bound(recommendation.body, foot)
        if recommendation.prediction == CALIBRATED:
            eta, k, s, gamma = parameters
            mean = np.clip(eta * shifted(ImpactGeometry.of_body(recommendation.body, foot), k), 0.0, bound)
            values = mean + scatter(mean, s, gamma) * z  # Eq. 137
        else:
            row = recommendation[recommendation.prediction]
            values = row.coefficients[foot] + row.scatter(foot) * z
        draws.append(np.clip(values, 0.0, bound))
    return np.array(draws)


def _in_space(solid: Solid, motion: Any, models: Sequence[Any] | None) -> Recommendation:
    from rocking.bodies.solid import SupportPolygon
    from rocking.restitution.space import impact_in_space, spatial_model, spatial_models
    from rocking.restitution.space.impact import NO_MATTER

    if motion is not None:
        raise InvalidValueError(
            "motion is allowed for plane bodies only; use rk.simulate for a Solid, with one model per call"
        )
    outside = ("it is a 3D body, and all measurements are of blocks that rock in one plane",)
    base, notes = solid.base, []
    if not isinstance(base, SupportPolygon):
        notes.append(
            "A round base rolls on its rim without impacts. The ideal model conserves energy; the loss of a real rim "
            "is not measured. rk.simulate computes rolling."
        )
        return Recommendation(solid, (), None, outside, tuple(notes), "", ())
    start = min(range(len(base.edges)), key=lambda i: _reach(solid, base.edges[i]))
    edge = base.edges[start]
    try:
        onto: Any = base.opposite(start)
        landing = "the opposite edge"
    except GeometryError:
        depth = [float(np.cross(edge.direction, corner.point - edge.point)[2]) for corner in base.corners]
        onto, landing = base.corners[depth.index(max(depth))], "the far corner"
    rows = []
    for candidate in [spatial_model(name) for name in _several(spatial_models() if models is None else models)]:
        if candidate.needs_solid and solid.known is not None:
            rows.append(ModelForBody(candidate.name, candidate.title, Standing.EXCLUDED, {}, reasons=(NO_MATTER,)))
            continue
        impact = impact_in_space(solid, -edge.direction, pivot=edge, onto=onto, model=candidate)
        reasons = tuple(flag.value for flag in impact.flags)
        standing = Standing.EXCLUDED if reasons else Standing.UNJUDGED
        rows.append(
            ModelForBody(candidate.name, candidate.title, standing, {landing: impact.coefficient}, reasons=reasons)
        )
    rows.sort(key=lambda candidate: candidate.standing is Standing.EXCLUDED)
    notes.append(
        f"The coefficients apply to the return from edge {start}, the edge of easiest overturning, with landing on "
        f"{landing}. rocking restitution lists all edges."
    )
    return _picked(solid, rows, None, outside, tuple(notes))


def _reach(solid: Solid, edge: Any) -> float:
    """Return the horizontal distance of the centre of mass from an edge, rounded to 1e-9 m for equal sides [m]."""
    return round(abs(float(np.cross(edge.direction, solid.centre - edge.point)[2])), 9)
