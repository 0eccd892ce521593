"""Models in space by name, and the two questions that are asked of them."""

from functools import partial
from typing import Any

import numpy as np

from rocking import checks
from rocking.bodies.solid import Base, Corner, Edge, RoundBase, Solid, SupportPolygon
from rocking.bodies.solid.surfaces import vector
from rocking.conventions import DEFAULT_RESTITUTION, FloatArray
from rocking.errors import GeometryError, InvalidValueError, UnknownModelError
from rocking.portable import norm
from rocking.restitution.space.calibrated import SpatialCalibrated
from rocking.restitution.space.horizontal_momentum import SpatialHorizontalMomentum
from rocking.restitution.space.housner import SpatialHousner
from rocking.restitution.space.impact import Placed, SpatialImpact
from rocking.restitution.space.impulse_position import SpatialKed
from rocking.restitution.space.ked import SpatialKedPoint
from rocking.restitution.space.model import SpatialModel, SpatialRestitution, middle_of_base

_MODELS: dict[str, type[SpatialModel]] = {
    kind.name: kind
    for kind in (SpatialHousner, SpatialHorizontalMomentum, SpatialKed, SpatialKedPoint, SpatialCalibrated)
}


def spatial_models() -> dict[str, type[SpatialModel]]:
    """Return every restitution model in space.

    Returns
    -------
    dict of str to type
        Name to class; a copy.

    Examples
    --------
    >>> sorted(spatial_models())
    ['calibrated-3d', 'horizontal-momentum-3d', 'housner-3d', 'ked-3d', 'ked-3d-point']
    """
    return dict(_MODELS)


def spatial_model(model: str | SpatialModel) -> SpatialModel:
    """Return a model in space by name.

    Parameters
    ----------
    model : str or SpatialModel
        Name, with or without "-3d", or the model itself.

    Returns
    -------
    SpatialModel
        The model.

    Raises
    ------
    UnknownModelError
        If there is no model of that name.
    """
    if isinstance(model, SpatialModel):
        return model
    name = checks.spelling(model, _MODELS)
    name = name if name in _MODELS else checks.spelling(f"{model}-3d", _MODELS)
    if name not in _MODELS:
        raise UnknownModelError(
            "no restitution model in space is called {name!r}; there are {names}", name=model, names=", ".join(_MODELS),
            hint=checks.nearest(model, _MODELS),
        )  # fmt: skip
    return _MODELS[name]()


def impact_in_space(
    solid: Solid, velocity: Any, *, pivot: Any, onto: Any, model: Any = DEFAULT_RESTITUTION
) -> SpatialRestitution:
    """Return what an impact in space does to the angular velocity.

    Parameters
    ----------
    solid : Solid
        The body, at the moment of the impact standing as it was described.
    velocity : array_like, shape (3,)
        Angular velocity before, along the axis and right-handed [rad/s].
    pivot : Corner, Edge or array_like, shape (2,)
        What it turned about: a point (x, y) of the ground in the user's coordinates [m].
    onto : Corner, Edge or array_like, shape (2,)
        What it lands on; a point (x, y) means a corner [m].
    model : str or SpatialModel
        The model.

    Returns
    -------
    SpatialRestitution
        Angular velocity after, energies, flags.

    Raises
    ------
    InvalidValueError
        If the body does not come down, or a value is not finite.
    UnknownModelError
        If there is no model of that name.
    GeometryError
        If pivot or landing point are no points of the base: off the ground, or outside it.

    Examples
    --------
    A prism that falls back from one corner over its diagonal onto the opposite one:

    >>> from rocking.bodies.solid import Solid, box
    >>> prism = Solid(box(1.0, 1.0, 4.0))
    >>> result = impact_in_space(prism, [-1.0, 1.0, 0.0], pivot=(-0.5, -0.5), onto=(0.5, 0.5), model="housner")
    >>> round(result.coefficient * 71, 9)
    59.0
    """
    checks.of_kind("solid", solid, Solid, "a Solid")
    found = spatial_model(model)
    start, landing = _local(solid, "pivot", pivot), _local(solid, "onto", onto)
    before = vector("velocity", velocity, "rad/s")
    if isinstance(start, Edge) and np.abs(np.cross(before, start.direction)).max() > 1e-9 * np.abs(before).max():
        raise InvalidValueError("a body that turns about an edge has its angular velocity along that edge")
    pivot, speed = _nearest(solid, start, landing), norm(before)
    if not speed > 0.0:
        raise InvalidValueError("velocity must not be zero: a body at rest has no impact")
    down = float(np.cross(before, middle_of_base(solid) - pivot)[2])
    if not down < 1e-12 * speed * solid.size:
        raise InvalidValueError(
            "{parameter} must turn the base onto the ground about the pivot; its middle rises at {speed:.3g} m/s: is "
            "the sign of the angular velocity wrong? The vector points along the axis, right-handed",
            parameter="velocity", speed=down,
        )  # fmt: skip
    impact = SpatialImpact(
        solid.local_moments, before, pivot, landing, matter=partial(_placed, solid), base=solid.local_base
    )
    return found.after(impact)


def _placed(solid: Solid) -> Placed:
    return solid, np.zeros(3)


def edge_coefficient(
    solid: Solid, model: Any = DEFAULT_RESTITUTION, *, start: float = 0, onto: float | None = None
) -> float:
    """Return the coefficient of restitution of a body that falls back from one edge of its base onto another.

    A round base has no such impact of its own: free in space it rolls round its rim, and in the ideal model keeps its
    energy where it passes flat (M. Srinivasan, A. Ruina, "Rocking and rolling: a can that appears to rock might
    actually roll", 2008). What is returned for one is the coefficient of a drum that is held to one vertical plane; it
    must not be used for a free one, which the response in space follows as it rolls.

    Onto the parallel edge it is the plane coefficient; from an edge e1 onto an edge e2 at an angle KED and
    horizontal momentum give ``|e1 . e2|`` times the coefficient of e2, because the horizontal velocities are
    ``omega z (e1 x n)``.

    Parameters
    ----------
    solid : Solid
        The body.
    model : str or SpatialModel
        The model.
    start : float
        Number of the edge it turned about; for a round base the direction of the tangent point [rad].
    onto : float, optional
        Number of the edge that it lands on; by default the one on the opposite side. For a round base a
        direction [rad].

    Returns
    -------
    float
        theta_dot_after / theta_dot_before, zero where the body stops [-].

    Raises
    ------
    GeometryError
        If there is no such edge, or none is parallel.

    Examples
    --------
    >>> from rocking.bodies.solid import Solid, box, cylinder
    >>> round(edge_coefficient(Solid(box(1.0, 1.0, 4.0)), "housner"), 12)
    0.911764705882
    >>> round(edge_coefficient(Solid(cylinder(1.0, 2.0))), 12)
    0.837210880308
    """
    base = solid.base
    before = base.edge(start)
    if onto is None and isinstance(base, SupportPolygon):
        after = base.opposite(int(checks.number("start", start)))
    else:
        after = base.edge(start + np.pi if onto is None else onto)
    return impact_in_space(solid, -before.direction, pivot=before, onto=after, model=model).coefficient


def _local(solid: Solid, name: str, value: Any) -> Corner | Edge:
    if isinstance(value, Edge):
        along = vector(f"direction of {name}", value.direction, "-")
        if abs(norm(along) - 1.0) > 1e-9 or along[2] != 0.0:
            raise GeometryError(
                "{parameter}: the direction of an edge must be a level unit vector, got {direction}", parameter=name,
                direction=along.tolist(),
            )  # fmt: skip
        edge = Edge(_grounded(solid, name, value.point), along)
        _check_on_base(solid, name, edge.point, _gap_of_line(solid.local_base, edge))
        return edge
    corner = Corner(_grounded(solid, name, value.point if isinstance(value, Corner) else value))
    _check_on_base(solid, name, corner.point, -solid.local_base.margin(corner.point[:2]))
    return corner


def _nearest(solid: Solid, start: Corner | Edge, onto: Corner | Edge) -> FloatArray:
    """Return the point at rest that is nearest to the landing place: from there the step is measured."""
    if isinstance(start, Corner):
        return start.point
    target = onto.point if isinstance(onto, Corner) else sum(_ends(solid, onto), np.zeros(3)) / 2.0
    first, last = _ends(solid, start)
    along = (target - start.point) * start.direction
    low, high, share = (
        float(value.sum())
        for value in ((first - start.point) * start.direction, (last - start.point) * start.direction, along)
    )
    return np.asarray(start.point + min(max(share, low), high) * start.direction)


def _ends(solid: Solid, edge: Edge) -> tuple[FloatArray, FloatArray]:
    """Return the ends of the stretch of a line that the base touches."""
    base, along = solid.local_base, edge.direction
    assert isinstance(base, (SupportPolygon, RoundBase))
    points = np.atleast_2d(base.vertices if isinstance(base, SupportPolygon) else base.centre)
    arm = points - edge.point[:2]
    aside = np.abs(along[0] * arm[:, 1] - along[1] * arm[:, 0])
    shares = (arm[:, 0] * along[0] + arm[:, 1] * along[1])[aside <= aside.min() + 1e-9 * solid.size]
    return edge.point + float(shares.min()) * along, edge.point + float(shares.max()) * along


def _gap_of_line(base: Base, edge: Edge) -> float:
    """Return how far a line in the ground passes the base, zero or less where it touches it [m]."""
    reach = base.radius if isinstance(base, RoundBase) else 0.0
    if isinstance(base, RoundBase):
        points = base.centre[None]
    elif isinstance(base, SupportPolygon):
        points = base.vertices
    else:
        return -base.margin(edge.point[:2])
    along, arm = edge.direction, points - edge.point[:2]
    aside = along[0] * arm[:, 1] - along[1] * arm[:, 0]
    return float(max(aside.min(), -aside.max())) - reach


def _check_on_base(solid: Solid, name: str, given: FloatArray, gap: float) -> None:
    if gap > 1e-9 * solid.size:
        x, y = (solid.origin + given)[:2].tolist()
        raise GeometryError(
            "{parameter} must touch the base, got ({x:g}, {y:g}) m, which passes it at {gap:.3g} m or more",
            parameter=name, x=x, y=y, gap=gap, hint="is it in the unit and the coordinates of the body?",
        )  # fmt: skip


def _grounded(solid: Solid, name: str, value: Any) -> FloatArray:
    array = checks.real_array(name, value, "m")
    full = np.array([*array.tolist(), solid.ground]) if array.shape == (2,) else array
    local = vector(name, full) - solid.origin
    if abs(float(local[2])) > 1e-9 * solid.size:
        raise GeometryError(
            "{parameter} must lie on the ground, z = {ground:g} m, got z = {z:g} m", parameter=name,
            ground=solid.ground, z=float(full[2]),
        )  # fmt: skip
    local[2] = 0.0
    return local
