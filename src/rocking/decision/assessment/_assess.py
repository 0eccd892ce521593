"""`assess`: histories with all models, in 2D or 3D, margins, code methods, a probability, and measures."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, cast

import numpy as np

from rocking import checks, conventions
from rocking.bodies import Body, Solid
from rocking.bodies.equilibria import StablePose
from rocking.bodies.frame import refuse_frame
from rocking.conventions import FEET, FloatArray, IntArray
from rocking.decision.assessment.answer import BodyAssessment, ModelMargin, StandingSolid, just_above
from rocking.decision.code_methods import CODE_METHODS
from rocking.decision.code_methods.methods import BodySides, Shaking
from rocking.decision.prediction import predict
from rocking.decision.prediction.mechanics import FRICTION, Uncertain, ground_components, motion_sequence
from rocking.decision.prediction.space import SampledInSpace
from rocking.decision.remedies import (
    CALIBRATED,
    Margins,
    find_min_factors,
    highest_acceleration,
    lifting_factor,
    remedies,
)
from rocking.dynamics.mechanics import mechanics_for
from rocking.dynamics.parameters import RockingParameters
from rocking.errors import InvalidValueError, RockingError
from rocking.evidence import restitution_distribution
from rocking.messages import listed
from rocking.motions.components import Components, components_of, rotated, with_vertical
from rocking.motions.intensity import sampled
from rocking.motions.motion import GroundMotion
from rocking.restitution import RestitutionModel, model, models
from rocking.studies.motion_sets import MotionList

SPACE_DIRECTIONS = 6
"""Directions of a solid over half a turn; both polarities cover the full turn."""

POINTS, REACH, TOGETHER = 24, 20.0, 8
"""Number of factors in the search for the smallest overturning factor, largest factor over the uplift factor, and
factors per batch. The computing time of a 3D history is a thousand times that of a 2D history."""

TURN, SAME = 2.0 * math.pi, 1e-9


@dataclass(frozen=True, eq=False)
class TurnedMotion(Components):
    """A motion of several components, in the axes of a rotated solid."""

    unique_name: str
    azimuth: float  # angle from the ground's x axis to the solid's x axis [rad]
    in_plane: GroundMotion  # component in the plane of the plane body

    @property
    def name(self) -> str:
        return self.unique_name

    @property
    def vertical(self) -> FloatArray | None:
        """Vertical acceleration [m/s2]."""
        return self.in_plane.vertical


class SolidHistories:
    """Histories of a solid under motions, in all directions and both polarities."""

    def __init__(self, solid: Solid, motions: Any, azimuth: Any, friction: float, options: dict[str, Any]) -> None:
        self.components = [Components(*components_of(motions[k])) for k in range(len(motions))]
        for components in self.components:
            ground_components(components)  # this call raises an error for other types
        fixed = {"base": 0.0, "centre": 1.0, "offset": 0.0, "level": 0.0, "restitution": 0.0, "model_error": "off"}
        inputs = {"friction": friction, **fixed}
        self._mechanics, self._options = SampledInSpace(solid, self.components, inputs, options["gravity"]), options
        pose, equilibria = self._mechanics.pose, self._mechanics.solid.equilibria()
        self._edges, self._outward = pose.edge_distances, _outward(pose)
        fixed_azimuth = float(azimuth) if isinstance(azimuth, (int, float)) else None
        # uplift begins at the nearest edge, or at the edge in the stated direction
        uplift_factors = self._edges
        if fixed_azimuth is not None:
            by_motion = [self._edge_uplift_factors(components, fixed_azimuth) for components in self.components]
            uplift_factors = np.min(by_motion, axis=0)
        azimuths = np.arctan2(self._outward[:, 1], self._outward[:, 0]) + 0.0
        governing_edges = np.flatnonzero(uplift_factors <= (1.0 + SAME) * uplift_factors.min())
        edge = governing_edges[np.lexsort((-azimuths[governing_edges], np.abs(azimuths[governing_edges])))[0]]
        edge_distance = float(self._edges[edge])
        self.standing = StandingSolid(
            self._mechanics.solid, pose, float(azimuths[edge]), edge_distance,
            bool(edge_distance <= (1.0 + SAME) * self._edges.min()),
            next(iter(equilibria.neighbours(pose)), None),
        )  # fmt: skip
        self.motions: list[TurnedMotion] = []
        self.records: IntArray = np.empty(0, np.int64)
        self._turn(fixed_azimuth)

    def _turn(self, fixed_azimuth: float | None) -> None:
        """Rotate each motion into each possible direction of the solid."""
        plane, records = self.standing.plane_azimuth, list[int]()
        for k, components in enumerate(self.components):
            x = sampled(components.x)
            z = None if components.z is None else sampled(components.z)
            for step in range(SPACE_DIRECTIONS if fixed_azimuth is None else 1):
                azimuth = 0.5 * TURN * step / SPACE_DIRECTIONS if fixed_azimuth is None else fixed_azimuth + plane
                in_plane = x
                if components.y is not None or fixed_azimuth is not None:
                    y = x.changed("none", acceleration=0.0 * x.acceleration) if components.y is None else components.y
                    length = min(len(x), len(y))
                    first, second = (
                        component.changed("cut", acceleration=component.acceleration[:length]) for component in (x, y)
                    )
                    in_plane, _ = rotated(first, second, azimuth)
                direction = f", {math.degrees(azimuth):.0f} deg" if fixed_azimuth is None else ""
                unique_name = numbered(f"{components.x.name}{direction}", self.motions)
                ground = in_plane if z is None else with_vertical(in_plane, z)
                self.motions.append(TurnedMotion(*components.parts, unique_name, azimuth - plane, ground))
                records.append(k)
        self.records = np.array(records)

    @property
    def body(self) -> Body:
        """The plane body of the solid."""
        return self.standing.solid.in_plane(self.standing.plane_azimuth)

    @property
    def polarities(self) -> int:
        """Number of different polarities: 1 for a solid that is symmetric under half a turn, otherwise 2."""
        size, inertia = self._edges.min() * SAME, self._mechanics.inertia
        corners = np.round(self._mechanics.shapes.corners / size) + 0.0
        same = set(map(tuple, corners.tolist())) == set(map(tuple, (corners * [-1.0, -1.0, 1.0] + 0.0).tolist()))
        return 1 if same and np.abs(inertia[2, :2]).max() <= SAME * np.trace(inertia) else 2

    def uplift_factors(self) -> FloatArray:
        """Return the smallest factor on each motion with uplift over an edge, both polarities [-]."""
        return np.array([self._edge_uplift_factors(motion, motion.azimuth).min() for motion in self.motions])

    def _edge_uplift_factors(self, motion: Components, azimuth: float) -> FloatArray:
        """Return the smallest factor on a motion with uplift over each edge, both polarities [-]."""
        ground = [np.zeros(0) if component is None else sampled(component).acceleration for component in motion.parts]
        x, y, vertical = (np.pad(component, (0, max(map(len, ground)) - len(component))) for component in ground)
        c, s = math.cos(azimuth), math.sin(azimuth)
        outward = self._outward @ np.array([[c, s], [-s, c]])  # normals in the axes of the ground
        height, gravity = self._mechanics.pose.height, self._options["gravity"]
        push = np.abs(outward[:, :1] * x + outward[:, 1:] * y) * height - self._edges[:, None] * vertical
        return np.asarray(gravity * self._edges / np.maximum(push.max(axis=1), 1e-300))  # Eq. 312

    def margin(
        self, plane_margin: ModelMargin, restitution: Any, level: float, uplift_factors: FloatArray
    ) -> ModelMargin:
        """Return the margin with one restitution.

        `plane_margin` is the margin of the plane body, with its coefficients. `restitution` is as for `predict`, and
        `level` is the probability in the distribution of the restitution.
        """
        mechanics, polarities, count = self._mechanics.with_restitution(restitution), self.polarities, len(self.motions)
        peaks = np.array([motion.peak for motion in self.motions])
        grid = np.array([
            np.geomspace(factor, highest_acceleration(factor * peak, REACH) / peak, POINTS)
            for factor, peak in zip(uplift_factors, peaks, strict=True)
        ])  # fmt: skip

        def overturned(rows: IntArray, factors: FloatArray) -> FloatArray:
            return self._run(mechanics, level, rows, factors)[0]

        unscaled = overturned(np.arange(polarities * count), np.ones(polarities * count)).reshape(polarities, count)
        min_factors = find_min_factors(np.tile(grid, (polarities, 1)), overturned, TOGETHER).reshape(polarities, count)
        # the factor 1 may lie in an overturning interval between two levels of the search
        min_factors = np.where(unscaled == 1.0, np.minimum(min_factors, 1.0), min_factors)
        return replace(plane_margin, overturned=np.maximum.reduce(unscaled), min_factors_by_polarity=min_factors)

    def with_overturning(self, margin: ModelMargin, restitution: Any, level: float, in_plane: float) -> StandingSolid:
        """Return the solid with its overturning at the smallest factor; `in_plane` is the factor of the plane body."""
        mechanics, (polarity, motion) = self._mechanics.with_restitution(restitution), margin.governing_case
        azimuth = self.motions[motion].azimuth + 0.5 * TURN * polarity
        standing = replace(
            self.standing, min_factor_in_plane=in_plane, restitution=mechanics.law(level), azimuth=azimuth
        )
        if not math.isfinite(margin.min_factor):
            return standing
        factor, row = np.array([just_above(margin.min_factor)]), np.array([polarity * len(self.motions) + motion])
        columns = self._run(mechanics, level, row, factor)
        overturned, sliding_distance, direction = (float(column[0]) for column in columns)
        own_direction = math.remainder(direction - azimuth, TURN) if overturned == 1.0 else math.nan
        return replace(standing, overturning_direction=own_direction, sliding_distance=sliding_distance)

    def _run(
        self, mechanics: SampledInSpace, level: float, rows: IntArray, factors: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return flag of overturning, sliding distance [m] and direction of overturning [rad] of each row."""
        polarity, motion = np.divmod(rows, len(self.motions))
        azimuths = np.array([turned_motion.azimuth for turned_motion in self.motions])[motion] / TURN + 0.5 * polarity
        levels = {"restitution": np.full(rows.size, level), "azimuth": azimuths % 1.0}
        draws = np.column_stack([levels[name] for name in mechanics.widths])
        results = np.full((3, rows.size), np.nan)
        for k in np.unique(self.records[motion]):
            indices = np.flatnonzero(self.records[motion] == k)
            endings = mechanics.run(draws[indices], int(k), factors[indices], self._options["threads"])
            assert endings.direction is not None
            results[:, indices] = endings.overturning, endings.sliding, endings.direction
            if self._options["progress"] is not None:
                self._options["progress"](indices.size)
        return results[0], results[1], results[2]


def numbered(name: str, named: Sequence[Any]) -> str:
    """Return a unique name, with a number appended if another motion has the same name."""
    count = sum(other.name.partition(" (no. ")[0] == name for other in named)
    return f"{name} (no. {count + 1})" if count else name


def _outward(pose: StablePose) -> FloatArray:
    """Return the horizontal outward normals of the edges of the base, in the initial pose."""
    along = np.roll(pose.support, -1, axis=0) - pose.support
    return np.asarray(np.column_stack([along[:, 1], -along[:, 0]]) / np.linalg.norm(along, axis=1, keepdims=True))


ENDS = {"low": 0.025, "high": 0.975}
"""Quantiles of the calibrated model at both ends of the 95 % interval of single measured bodies."""

MAX_MARGIN = 50.0
"""Largest required margin of measures, equal to the largest factor in the search for margins [-]."""

DIRECTIONS = 12
"""Directions of two components over half a turn; both polarities cover the full turn."""

IN_SPACE = conventions.DEFAULT_RESTITUTION, *conventions.COMPARED_RESTITUTIONS
"""Default models of solids."""


def assess(  # noqa: PLR0913 - inputs, assumptions and settings
    body: Body | Solid,
    motions: Any,
    restitution: Any = None,
    *,
    friction: Any = None,
    margin: float = 1.0,
    pga: float | None = None,
    gravity: float = conventions.g,
    threads: int | None = None,
    progress: Callable[[int], None] | None = None,
    **known: Any,
) -> BodyAssessment:
    """Assess overturning of a body: outcome, margin, probability, causes and measures.

    Histories of pure rocking are computed under all motions, in both polarities, with all restitution models. The model
    with the smallest margin is also computed with sliding. A search over scale factors gives the smallest factor with
    overturning. The result also contains a probability, with uncertain inputs sampled, and the code methods.

    Parameters
    ----------
    body : Block, Section, MassPoints or Solid
        A plane body, or a solid with contact at the vertices of its hull, in its stable pose. Code methods and
        measures of a solid apply to ``solid.in_plane`` over its nearest edge.
    motions : GroundMotion, Pulse, or mapping with x, y and z, or a sequence of them
        With a y component, a plane body is computed in 12 directions. A solid is computed in 6 directions, or in
        the direction of a number as ``azimuth``.
    restitution : str, float, RestitutionModel or a sequence of them, optional
        Names, models and coefficients. Default: all registered models, with the mean and both ends of the 95 %
        interval of the calibrated model. Solids: "calibrated", "ked", "housner" and coefficients [-].
    friction : as for `predict`
        Coefficient of friction; histories with sliding, and all histories of a solid, use its median [-].
    margin : float
        Required factor on the motions after measures, at most 50 [-].
    pga : float, optional
        Peak ground acceleration to which each motion is scaled, as for `predict` [m/s2].
    gravity : float
        Acceleration of gravity [m/s2].
    threads : int, optional
        Threads of the engine.
    progress : callable, optional
        Called with the number of histories done since the last call.
    **known
        Other inputs of `predict`: ``base``, ``centre``, ``polarity``, ``azimuth``, ``count``, ``seed`` and more;
        its ``restitution`` as ``predicted``. A number as azimuth fixes the direction of the body.

    Returns
    -------
    BodyAssessment
        Outcome, margins, probability, code methods, measures.

    Raises
    ------
    InvalidValueError
        If the body has another type, a motion is zero at all times, or a value is outside its range.

    Examples
    --------
    >>> import rocking as rk
    >>> block = rk.Block(width=0.5, height=2.0, mass=300.0)
    >>> assessment = assess(block, rk.pulses.sine(2.0, 0.8), ["ked", 0.95], count=16)
    >>> assessment.verdict
    'No uplift and no overturning: 0 of 1 motion, 2 restitution cases (1 model, 1 coefficient), both polarities.'
    """
    checks.of_kind("body", refuse_frame(body), (Body, Solid), "a Block, Section, MassPoints or Solid")
    checks.within("margin", margin, 0.0, MAX_MARGIN, open_low=True)
    margin, gravity = float(margin), checks.positive("gravity", gravity, "m/s2")
    if isinstance(restitution, (str, int, float, RestitutionModel)):
        restitution = [restitution]
    motion_set = motion_sequence(motions, pga)
    stated = (mu for mu in (friction, FRICTION[0]) if mu is not None)
    coefficient = Uncertain.of("friction", next(stated), *FRICTION[1:]).median
    options, subject = {"gravity": gravity, "threads": threads, "progress": progress}, cast(Any, body)
    space: SolidHistories | None = None
    moving: Sequence[Any]
    if not mechanics_for(subject, friction, study=True).in_plane:
        space = SolidHistories(subject, motion_set, known.get("azimuth"), coefficient, options)
        flat, body = space.body, space.standing.solid
        moving, records, motion_set = space.motions, space.records, space.components
        plane = [item.in_plane for item in space.motions]
        restitution = [
            item.removesuffix("-3d") if isinstance(item, str) else item
            for item in (IN_SPACE if restitution is None else restitution)
        ]
    else:
        plane, records = in_the_plane(motion_set, known.get("azimuth"))
        flat, moving = subject, plane
    if zero_motion := next((item for item in plane if not item.peak > 0.0), None):
        raise InvalidValueError(
            "motion {motion!r} is zero throughout; use a motion with acceleration", motion=zero_motion.name
        )
    unique_motions = list({id(item): item for item in plane}.values())
    unique_index = [next(k for k, other in enumerate(unique_motions) if other is item) for item in plane]
    unique_set = MotionList(unique_motions)
    uplift_factors = (
        np.array([lifting_factor(flat, item, gravity) for item in plane]) if space is None else space.uplift_factors()
    )

    chosen = choices(flat, restitution)
    margins, plane_margins, refused = _margins(flat, unique_set, chosen, options, space, uplift_factors)
    ranked = sorted(margins, key=lambda name: np.nan_to_num(margins[name].min_factor, nan=np.inf))
    lowest = float(np.nanmin([*(item.min_factor for item in plane_margins.values()), np.inf]))
    standing = None
    if space is None:
        sliding = _margin(flat, unique_set, chosen[ranked[0]], {**options, "friction": coefficient})
    else:
        sliding = margins[ranked[0]]
        standing = space.with_overturning(sliding, *_sampled_restitution(ranked[0], chosen[ranked[0]]), lowest)
    overturning_factor = max(lowest, sliding.min_factor) if space else lowest
    sides, shaking = BodySides.of([flat], gravity), Shaking.of(unique_set)
    prediction = predict(
        body, motion_set, restitution=known.pop("predicted", None), friction=friction, gravity=gravity, threads=threads,
        progress=progress, **known,
    )  # fmt: skip
    return BodyAssessment(
        body=flat, motions=tuple(moving), records=records, models=margins, refused=refused,
        friction=coefficient, sliding=sliding, uplift_factors=uplift_factors,
        capacities={name: item.capacity(sides, shaking)[unique_index, 0] for name, item in CODE_METHODS.items()},
        prediction=prediction,
        remedies=remedies(
            flat, unique_motions, margin, gravity, {name: chosen[name] for name in ranked},
            falls=overturning_factor <= margin,
        ),
        gravity=gravity, standing=standing,
        outside={name: item.outside(sides, shaking) for name, item in CODE_METHODS.items()},
        vertical=int(shaking.vertical.sum()),
    )  # fmt: skip


def in_the_plane(motions: Any, azimuth: Any = None) -> tuple[list[GroundMotion], IntArray]:
    """Return the motions in the plane of a body, and the index of the input motion for each of them.

    One component is unchanged; two components are rotated into all directions.
    """
    turned_motions: list[GroundMotion] = []
    records: list[int] = []
    for k in range(len(motions)):
        along, across, upright = ground_components(motions[k])
        components = {"": sampled(along)}
        if across is not None:
            fixed = isinstance(azimuth, (int, float))
            angles = [float(azimuth)] if fixed else np.pi * np.arange(DIRECTIONS) / DIRECTIONS
            components = {f", {np.degrees(a):.0f} deg": rotated(along, across, float(a))[0] for a in angles}
        for suffix, component in components.items():
            name = f"{along.name}{suffix}"
            vertical = component.vertical if upright is None else with_vertical(component, sampled(upright)).vertical
            samples = component.acceleration if vertical is None else component.acceleration[: len(vertical)]
            unique_name = numbered(name, turned_motions)
            turned_motions.append(
                GroundMotion(
                    samples, component.time_step, vertical, unique_name, component.metadata, component.provenance
                )
            )
            records.append(k)
    return turned_motions, np.array(records)


def choices(body: Body, restitutions: Sequence[Any] | None) -> Mapping[str, Any]:
    """Return the restitutions of histories by their names."""
    restitution_by_name: dict[str, Any] = {}
    defaults = [CALIBRATED, *(name for name in models() if name not in {CALIBRATED, "fixed"})]
    for choice in defaults if restitutions is None else restitutions:
        if choice == CALIBRATED:
            restitution_by_name[CALIBRATED], distribution = model(choice), restitution_distribution(body)
            for end, level in ENDS.items():
                restitution_by_name[f"{CALIBRATED}, {end}"] = {
                    foot: float(distribution.quantile(level, foot)) for foot in FEET
                }
        elif isinstance(choice, (int, float)):
            restitution_by_name[f"r = {choice:g}"] = float(choice)
        else:
            chosen_model = model(choice)
            restitution_by_name[chosen_model.label] = chosen_model
    return restitution_by_name


def _sampled_restitution(name: str, choice: Any) -> tuple[Any, float]:
    """Return a restitution of a solid in the form for `predict`, and the probability in its distribution."""
    label, _, end = name.partition(", ")
    if label == CALIBRATED:
        return None, ENDS.get(end, 0.5)
    return (choice if isinstance(choice, float) else label), 0.5


def _margins(
    body: Body, motions: MotionList, chosen: Mapping[str, Any], options: dict[str, Any],
    space: SolidHistories | None, uplift_factors: FloatArray,
) -> tuple[dict[str, ModelMargin], dict[str, ModelMargin], dict[str, str]]:  # fmt: skip
    """Return margins, margins of the plane body of a solid, and reasons of missing margins, by restitution."""
    margins, plane_margins, refused = dict[str, ModelMargin](), dict[str, ModelMargin](), dict[str, str]()
    for name, choice in chosen.items():
        try:
            flat = _margin(body, motions, choice, options)
            margins[name] = (
                flat if space is None else space.margin(flat, *_sampled_restitution(name, choice), uplift_factors)
            )
            plane_margins[name] = flat
        except RockingError as error:
            refused[name] = str(error)
    if not margins:
        raise InvalidValueError(
            "no restitution model applies to this body: {reasons}", reasons=listed(refused.values())
        )
    return margins, plane_margins, refused


def _margin(body: Body, motions: MotionList, restitution: Any, options: dict[str, Any]) -> ModelMargin:
    margins = Margins.of(body, motions, restitution, "pga", None, options)
    # the factor 1 may lie in an overturning interval between two levels of the search
    min_factors = np.where(
        margins.overturned_by_polarity[:, :, 0] == 1.0,
        np.minimum(margins.min_factors_by_polarity, 1.0),
        margins.min_factors_by_polarity,
    )
    parameters = RockingParameters.of_body(body, restitution, options["gravity"])
    return ModelMargin(
        {foot: getattr(parameters, foot).coefficient for foot in FEET}, margins.overturned[:, 0], min_factors
    )
