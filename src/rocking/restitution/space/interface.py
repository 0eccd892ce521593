"""3D restitution models by name, and impacts of solids."""

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
    """Return the 3D restitution models.

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
    """Return a 3D model by name.

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
        If the name is unknown.
    """
    if isinstance(model, SpatialModel):
        return model
    name = checks.spelling(model, _MODELS)
    name = name if name in _MODELS else checks.spelling(f"{model}-3d", _MODELS)
    if name not in _MODELS:
        raise UnknownModelError(
            "unknown restitution model in space {name!r}; models: {names}", name=model, names=", ".join(_MODELS),
            hint=checks.nearest(model, _MODELS),
        )  # fmt: skip
    return _MODELS[name]()


def impact_in_space(
    solid: Solid, velocity: Any, *, pivot: Any, onto: Any, model: Any = DEFAULT_RESTITUTION
) -> SpatialRestitution:
    """Return the result of a 3D impact.

    Parameters
    ----------
    solid : Solid
        The body, which is upright at the impact.
    velocity : array_like, shape (3,)
        Angular velocity before the impact, along the axis of rotation and right-handed [rad/s].
    pivot : Corner, Edge or array_like, shape (2,)
        Pivot before the impact: a point (x, y) of the ground in coordinates of the user [m], a corner or an edge.
    onto : Corner, Edge or array_like, shape (2,)
        Corner or edge of landing. A point (x, y) means a corner [m].
    model : str or SpatialModel
        The model.

    Returns
    -------
    SpatialRestitution
        Angular velocity after the impact, energies, flags.

    Raises
    ------
    InvalidValueError
        If the body does not rotate towards the ground, or if a value is not finite.
    UnknownModelError
        If the name of the model is unknown.
    GeometryError
        If pivot or landing point are not points of the base, because they are above the ground or outside the base.

    Examples
    --------
    A prism rotates from one corner over its diagonal onto the opposite corner:

    >>> from rocking.bodies.solid import Solid, box
    >>> prism = Solid(box(1.0, 1.0, 4.0))
    >>> result = impact_in_space(prism, [-1.0, 1.0, 0.0], pivot=(-0.5, -0.5), onto=(0.5, 0.5), model="housner")
    >>> round(result.coefficient * 71, 9)
    59.0
    """
    checks.of_kind("solid", solid, Solid, "a Solid")
    spatial = spatial_model(model)
    start, landing = _local(solid, "pivot", pivot), _local(solid, "onto", onto)
    before = vector("velocity", velocity, "rad/s")
    if isinstance(start, Edge) and np.abs(np.cross(before, start.direction)).max() > 1e-9 * np.abs(before).max():
        raise InvalidValueError("velocity of a body that turns about an edge must be along the edge")
    pivot, speed = _nearest(solid, start, landing), norm(before)
    if not speed > 0.0:
        raise InvalidValueError("velocity must not be zero")
    down = float(np.cross(before, middle_of_base(solid) - pivot)[2])
    if not down < 1e-12 * speed * solid.size:
        raise InvalidValueError(
            "{parameter} must rotate the base towards the ground about the pivot, but the centre of the base rises at "
            "{speed:.3g} m/s; check the sign: the vector is along the axis, right-handed",
            parameter="velocity", speed=down,
        )  # fmt: skip
    impact = SpatialImpact(
        solid.local_moments, before, pivot, landing, matter=partial(_placed, solid), base=solid.local_base
    )
    return spatial.after(impact)


def _placed(solid: Solid) -> Placed:
    return solid, np.zeros(3)


def edge_coefficient(
    solid: Solid, model: Any = DEFAULT_RESTITUTION, *, start: float = 0, onto: float | None = None
) -> float:
    """Return the coefficient of restitution of a body that rotates from one edge of its base onto another edge.

    A free round base has no such impact. It rolls around its rim, and the ideal model conserves its energy at the flat
    position (M. Srinivasan, A. Ruina, "Rocking and rolling: a can that appears to rock might actually roll", 2008). For
    a round base, the result is the coefficient of a drum that is guided in one vertical plane. Do not use this result
    for a free drum; the 3D response computes its rolling.

    For an impact on the parallel edge, the result is the plane coefficient. For an impact from an edge e1 on an edge e2
    that is not parallel, KED and horizontal momentum give ``|e1 . e2|`` times the coefficient of e2, because the
    horizontal velocities are ``omega z (e1 x n)``.

    Parameters
    ----------
    solid : Solid
        The body.
    model : str or SpatialModel
        The model.
    start : float
        Index of the edge of rotation before the impact. For a round base, the direction of the tangent point [rad].
    onto : float, optional
        Index of the edge of landing; by default the edge on the opposite side. For a round base, a direction [rad].

    Returns
    -------
    float
        theta_dot_after / theta_dot_before, zero for a body that stops [-].

    Raises
    ------
    GeometryError
        If the edge does not exist, or no edge is parallel.

    Examples
    --------
    >>> from rocking.bodies.solid import Solid, box, cylinder
    >>> round(edge_coefficient(Solid(box(1.0, 1.0, 4.0)), "housner"), 12)
    0.911764705882
    >>> round(edge_coefficient(Solid(cylinder(1.0, 2.0)), "ked"), 12)
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
    """Return the start of the step: the point at rest that is nearest to the landing [m]."""
    if isinstance(start, Corner):
        return start.point
    target = onto.point if isinstance(onto, Corner) else sum(_ends(solid, onto), np.zeros(3)) / 2.0
    first, last = _ends(solid, start)
    along = (target - start.point) * start.direction
    low, high, position = (
        float(value.sum())
        for value in ((first - start.point) * start.direction, (last - start.point) * start.direction, along)
    )
    return np.asarray(start.point + min(max(position, low), high) * start.direction)


def _ends(solid: Solid, edge: Edge) -> tuple[FloatArray, FloatArray]:
    """Return the ends of the segment of a line that is in contact with the base [m]."""
    base, along = solid.local_base, edge.direction
    assert isinstance(base, (SupportPolygon, RoundBase))
    points = np.atleast_2d(base.vertices if isinstance(base, SupportPolygon) else base.centre)
    arm = points - edge.point[:2]
    distances = np.abs(along[0] * arm[:, 1] - along[1] * arm[:, 0])
    positions = (arm[:, 0] * along[0] + arm[:, 1] * along[1])[distances <= distances.min() + 1e-9 * solid.size]
    return edge.point + float(positions.min()) * along, edge.point + float(positions.max()) * along


def _gap_of_line(base: Base, edge: Edge) -> float:
    """Return the distance of a line on the ground from the base [m]; zero or negative for contact."""
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


def _check_on_base(solid: Solid, name: str, point: FloatArray, gap: float) -> None:
    if gap > 1e-9 * solid.size:
        x, y = (solid.origin + point)[:2].tolist()
        raise GeometryError(
            "{parameter} must touch the base, got ({x:g}, {y:g}) m, at {gap:.3g} m or more from the base",
            parameter=name, x=x, y=y, gap=gap, hint="check unit and coordinates",
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
