"""What an impact leaves of an angular velocity: the interface, the projection, and two laws beside it."""

from typing import Any, Protocol, runtime_checkable

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.dynamics.spatial.attitude import cross
from rocking.dynamics.spatial.rocker import SpatialBody
from rocking.errors import InvalidValueError, UnknownModelError


@runtime_checkable
class SpatialImpactLaw(Protocol):
    """What an impact costs in space; the engine finds which points stay on the ground, a law how fast the body goes on.

    Any object with these two members serves.
    """

    @property
    def label(self) -> str:
        """What to call it in titles and tables."""
        ...

    def velocity_after(
        self,
        body: SpatialBody,
        before: FloatArray,
        after: FloatArray,
        axis: FloatArray | None,
        up: FloatArray,
        velocity: FloatArray,
    ) -> FloatArray:
        """Return the angular velocity after an impact.

        Parameters
        ----------
        body : SpatialBody
            The body.
        before, after : ndarray, shape (3,)
            Pivots before and after, in body axes [m].
        axis : ndarray, shape (3,), optional
            Unit vector of the edge about which the body turns afterwards; None for a vertex [-].
        up : ndarray, shape (3,)
            Vertical in body axes [-].
        velocity : ndarray, shape (3,)
            Angular velocity before, in body axes [rad/s].

        Returns
        -------
        ndarray, shape (3,)
            Angular velocity after, in body axes; along `axis` if there is one [rad/s].
        """
        ...


def projected(
    body: SpatialBody, before: FloatArray, after: FloatArray, axis: FloatArray | None, velocity: FloatArray
) -> FloatArray:
    """Return the plastic impact without slip: the orthogonal projection of the velocities in the kinetic metric.

    The impulse acts at the new pivot B, so angular momentum about B stays: ``I_B w+ = I_C w- + m rho_B x (w- x
    rho_A)``; about an edge its component along the edge.

    Parameters
    ----------
    body : SpatialBody
        The body.
    before, after : ndarray, shape (3,)
        Pivots before and after, in body axes [m].
    axis : ndarray, shape (3,), optional
        Unit vector of the new edge; None for a vertex [-].
    velocity : ndarray, shape (3,)
        Angular velocity before, in body axes [rad/s].

    Returns
    -------
    ndarray, shape (3,)
        Angular velocity after, in body axes [rad/s].

    Examples
    --------
    >>> box = SpatialBody.box(1.0, 1.0, 4.0)  # corner to opposite corner: 59 / 71
    >>> diagonal = np.array([1.0, -1.0, 0.0])
    >>> ratio = projected(box, box.vertices[0], box.vertices[2], None, diagonal) / 59.0 * 71.0
    >>> ratio.round(12).tolist()
    [1.0, -1.0, 0.0]
    """
    old, new = body.centre - before, body.centre - after
    momentum = body.inertia @ velocity + body.mass * cross(new, cross(velocity, old))
    inertia = body.inertia_about(after)
    if axis is None:
        return np.asarray(np.linalg.solve(inertia, momentum))
    return np.asarray(axis * (axis @ momentum) / (axis @ inertia @ axis))


class HousnerSpatial:
    """The plastic impact without slip on the points that stay (Housner 1963 in space)."""

    label = "housner-3d"

    def velocity_after(
        self,
        body: SpatialBody,
        before: FloatArray,
        after: FloatArray,
        axis: FloatArray | None,
        up: FloatArray,
        velocity: FloatArray,
    ) -> FloatArray:
        """Return the projection.

        Parameters
        ----------
        body, before, after, axis, up, velocity
            As in `SpatialImpactLaw`.

        Returns
        -------
        ndarray, shape (3,)
            Angular velocity after, in body axes [rad/s].
        """
        return projected(body, before, after, axis, velocity)


class HorizontalMomentumSpatial:
    """Only the horizontal velocities of the particles go on: their momentum about the new pivot stays.

    ``I_B w+ = Int rho (S - B) x P_h (w- x (S - A)) dV`` with P_h the horizontal part; about an edge its component
    along the edge. The integral needs only mass, centre and inertia, since P_h is the same everywhere.
    """

    label = "horizontal-momentum-3d"

    def velocity_after(
        self,
        body: SpatialBody,
        before: FloatArray,
        after: FloatArray,
        axis: FloatArray | None,
        up: FloatArray,
        velocity: FloatArray,
    ) -> FloatArray:
        """Return the angular velocity with that momentum.

        Parameters
        ----------
        body, before, after, axis, up, velocity
            As in `SpatialImpactLaw`.

        Returns
        -------
        ndarray, shape (3,)
            Angular velocity after, in body axes [rad/s].
        """
        second = 0.5 * np.trace(body.inertia) * np.eye(3) - body.inertia  # Int rho x x^T about the centre
        speed = cross(velocity, body.centre - before)
        level = speed - up * (up @ speed)
        momentum = body.inertia @ velocity + cross(up, second @ cross(up, velocity))
        momentum += body.mass * cross(body.centre - after, level)
        inertia = body.inertia_about(after)
        if axis is None:
            return np.asarray(np.linalg.solve(inertia, momentum))
        return np.asarray(axis * (axis @ momentum) / (axis @ inertia @ axis))


class FixedSpatial:
    """The direction of the projection, and r^2 of the energy.

    For symmetric bodies in the plane r is the ratio of velocities.

    A vertex that only grazes the ground costs this share as well, which no real impact does: for bodies that turn
    about edges, not for wobbling ones.

    Parameters
    ----------
    coefficient : float
        r, from 0 to 1 [-].
    """

    def __init__(self, coefficient: float) -> None:
        self.coefficient = checks.within("restitution", coefficient, 0.0, 1.0, hint="more would create energy")

    @property
    def label(self) -> str:
        """The coefficient."""
        return f"{self.coefficient:.6g}"

    def velocity_after(
        self,
        body: SpatialBody,
        before: FloatArray,
        after: FloatArray,
        axis: FloatArray | None,
        up: FloatArray,
        velocity: FloatArray,
    ) -> FloatArray:
        """Return the scaled projection.

        Parameters
        ----------
        body, before, after, axis, up, velocity
            As in `SpatialImpactLaw`.

        Returns
        -------
        ndarray, shape (3,)
            Angular velocity after, in body axes [rad/s].
        """
        made = projected(body, before, after, axis, velocity)
        left = float(made @ body.inertia_about(after) @ made)
        if not left > 0.0:
            return made
        return np.asarray(self.coefficient * np.sqrt(velocity @ body.inertia_about(before) @ velocity / left) * made)


LAWS: dict[str, type] = {"housner-3d": HousnerSpatial, "horizontal-momentum-3d": HorizontalMomentumSpatial}
"""Laws that need nothing but mass, centre and inertia, by name."""


def law_of(restitution: Any) -> SpatialImpactLaw:
    """Return an impact law.

    Parameters
    ----------
    restitution : str, float or SpatialImpactLaw
        Name of a law, a coefficient from 0 to 1, or a law.

    Returns
    -------
    SpatialImpactLaw
        The law.

    Raises
    ------
    UnknownModelError
        If there is no law of that name.
    InvalidValueError
        If it is none of these.
    """
    if isinstance(restitution, str):
        if restitution not in LAWS:
            raise UnknownModelError(
                f"no impact law in space is called {restitution!r}; there are {', '.join(LAWS)}, a coefficient in "
                "[0, 1], or any object with velocity_after and label"
            )
        made: SpatialImpactLaw = LAWS[restitution]()
        return made
    if isinstance(restitution, type):
        raise InvalidValueError(f"restitution must be a law, not its class, got {restitution!r:.60}")
    return restitution if isinstance(restitution, SpatialImpactLaw) else FixedSpatial(restitution)
