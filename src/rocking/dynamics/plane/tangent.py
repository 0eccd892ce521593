"""Derivatives of the states of a plane body with respect to the initial state and to parameters, through impacts."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.answers import Answer
from rocking.conventions import FloatArray
from rocking.dynamics.impact_laws import ImpactLaw
from rocking.dynamics.plane.equations import EventKind, angular_acceleration
from rocking.dynamics.taylor import shifted

if TYPE_CHECKING:
    from rocking.dynamics.response import Response

_ORDER = 16  # intervals of a dense output are short
PARAMETERS = ("amplitude", "frequency", "restitution", "slenderness")


@dataclass(frozen=True, eq=False)
class Tangent:
    """Derivatives of the states of a plane response with respect to the initial state and to parameters.

    If the body comes to rest, small differences of the initial state vanish: the derivatives are zero after a rest.

    Parameters
    ----------
    time, rotation : ndarray
        Times [s] and rotations [rad] of the samples, shape (samples,).
    by_start : ndarray
        Derivatives of rotation [rad] and angular velocity [rad/s] with respect to their initial values, shape
        (samples, 2, 2).
    by_parameter : dict of str to ndarray
        Derivatives with respect to each parameter, shape (samples, 2): ``amplitude`` and
        ``frequency``, factors on the ground acceleration and on all its frequencies [-]; ``restitution``, both
        coefficients [-]; ``slenderness``, both slenderness angles at constant frequency parameters [rad].
    determinants : ndarray
        Determinant r d(r v)/dv of each impact, shape (impacts,); their product is that of `by_start`.
    frequency_parameter : float
        p of the right foot, which scales the angular velocity in `growth` [rad/s].
    """

    time: FloatArray
    rotation: FloatArray
    by_start: FloatArray
    by_parameter: dict[str, FloatArray]
    determinants: FloatArray
    frequency_parameter: float

    @property
    def growth(self) -> FloatArray:
        """Largest growth of a difference in rotation and angular velocity / p since the start, shape (samples,)."""
        p = self.frequency_parameter
        a, b, c, d = (self.by_start * np.array([[1.0, p], [1.0 / p, 1.0]])).reshape(-1, 4).T
        squares = 0.5 * (a * a + b * b + c * c + d * d)  # largest singular value in closed form
        return np.asarray(np.sqrt(squares + np.sqrt(np.maximum(squares**2 - (a * d - b * c) ** 2, 0.0))))

    @property
    def growth_rate(self) -> FloatArray:
        """Logarithm of the growth / time [1/s], shape (samples,): NaN at time 0, minus infinity after a rest."""
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.asarray(np.log(self.growth) / self.time)

    @property
    def relative_change(self) -> float:
        """Relative changes: peak rotation / motion [-]; NaN if the peak is at the start or end."""
        peak = int(np.argmax(np.abs(self.rotation)))
        is_inside = 0 < peak < self.rotation.size - 1
        return float(abs(self.by_parameter["amplitude"][peak, 0] / self.rotation[peak])) if is_inside else np.nan

    def answer(self) -> Answer:
        """Return the growth of small differences.

        Returns
        -------
        Answer
            Rate and time of the largest growth since the start, without them for a start at rest; relative change of
            the peak, without it for free rocking or a body that overturns.
        """
        values: dict[str, float] = {}
        last = 1 + int(np.argmax(self.growth[1:])) if self.time.size > 1 else 0
        if last and self.growth[last] > 0.0:
            values |= {"growth_rate": self.growth_rate[last], "growth_time": self.time[last]}
        if self.relative_change > 0.0:
            values["relative_change"] = self.relative_change
        return Answer(values)


def tangent_of(response: "Response") -> Tangent:
    """Return the tangent dynamics along the states and events of a response, of either engine."""
    output, parameters = response.dense_output, response.parameters
    nodes, flows = np.append(output.start, output.end[-1]), _flows(response)
    impacts = [event for event in response.trajectory.events if event.kind is EventKind.IMPACT]
    matrices, determinants = np.empty((nodes.size, 2, 2 + len(PARAMETERS))), np.empty(len(impacts))
    jumps = np.zeros(nodes.size)  # a jump of the ground acceleration comes earlier at higher frequencies
    jumps[1:-1] = (output.acceleration[1:, 0] - output.acceleration[:-1, 1]) * nodes[1:-1]
    matrix, count = np.hstack([np.eye(2), np.zeros((2, len(PARAMETERS)))]), 0
    for k, time in enumerate(nodes.tolist()):
        if k:
            matrix = flows[k - 1, :, :2] @ matrix
            matrix[:, 2:] += flows[k - 1, :, 2:]
        before = count
        while count < len(impacts) and impacts[count].time <= time:
            event, (push, lift) = impacts[count], (x[max(k - 1, 0), min(k, 1)] for x in (output.push, output.lift))
            r, base = event.coefficient, parameters.side(event.side).coefficient
            slope = r + base * abs(event.before) * _slope(parameters.law, abs(event.before), response.stream, count)
            falling, rising = (_acceleration(response, side, push, lift) for side in (-event.side, event.side))
            # Eq. 332
            matrix = np.array([[r, 0.0], [(rising - slope * falling) / event.before, slope]]) @ matrix
            matrix[1, 4] += event.after / base if base else event.before
            determinants[count] = r * slope
            count += 1
        if count == before:
            matrix[1, 3] += jumps[k]
        matrices[k] = matrix
    at = matrices[np.searchsorted(nodes, response.time)]
    by_parameter = {name: at[:, :, 2 + column] for column, name in enumerate(PARAMETERS)}
    p = parameters.right.frequency_parameter
    return Tangent(response.time, response.rotation, at[:, :, :2], by_parameter, determinants, p)


def _acceleration(response: "Response", sign: int, push: float, lift: float) -> float:
    """Return the acceleration on one foot at an impact [rad/s2]."""
    side, g = response.parameters.side(sign), response.settings.gravity
    angles = side.slenderness_angle, side.frequency_parameter
    return float(angular_acceleration(0.0, sign, *angles, push / g, 1.0 + lift / g, linear=response.settings.linear))


def _slope(law: ImpactLaw, speed: float, stream: int, impact: int) -> float:
    """Return the derivative of the factor of a law with respect to the speed [s/rad]."""
    if law.kind == 1:
        k = int(np.searchsorted(law.at, speed, side="right"))
        inside = 0 < k < law.at.size
        return float((law.factors[k] - law.factors[k - 1]) / (law.at[k] - law.at[k - 1])) if inside else 0.0
    if law.kind >= 0 or not speed:
        return 0.0
    step = 1e-5 * speed
    return (law.factor(speed + step, stream, impact) - law.factor(speed - step, stream, impact)) / (2.0 * step)


def _flows(response: "Response") -> FloatArray:
    """Return derivatives of the final state of each interval with respect to its initial state and parameters."""
    # shape (intervals, 2, 2 + parameters); zero at rest. Series in u = alpha - |theta| over 0 <= x <= 1
    output, segments, settings = response.dense_output, response.segments, response.settings
    side, length = output.side, output.length
    at: Any = output.start / segments.step
    width: Any = length / segments.step
    stretch = np.clip((at + 0.5 * width).astype(np.int64), 0, segments.count - 1)

    def ground(motion: FloatArray | None) -> tuple[list[Any], list[Any]]:
        """Return a ground acceleration / g, and its derivative by a factor on the frequency."""
        if motion is None:
            return [np.zeros_like(at)], [np.zeros_like(at)]
        columns: list[Any] = list((response.scale / settings.gravity * motion[stretch]).T)
        terms: list[Any] = list(shifted(columns, at - stretch, width))
        after = [*terms[1:], np.zeros_like(at)]
        return terms, [output.start / length * (k + 1) * after[k] + k * terms[k] for k in range(len(terms))]

    pushes = [[side * c for c in terms] for terms in ground(segments.horizontal)]
    u = output.alpha - np.abs(output.rotation[:, 0])
    kappa, rate = (output.p * length) ** 2, -side * output.velocity[:, 0] * length
    vectors = _variations(u, rate, kappa, pushes, ground(segments.vertical), linear=settings.linear)
    flow = np.zeros((at.size, 2, 2 + len(PARAMETERS)))
    flow[:, 0, :4] = np.sum(vectors, axis=0).T
    flow[:, 1, :4] = (np.tensordot(np.arange(len(vectors)), vectors, 1) / length).T
    flow[:, :, 1] *= length[:, None]
    flow[:, :, 2:4] *= -side[:, None, None]
    flow[:, 0, 5], flow[:, 1, 5] = side * (1.0 - flow[:, 0, 0]), -side * flow[:, 1, 0]
    flow[side == 0.0] = 0.0
    return flow


def _variations(u: Any, rate: Any, kappa: Any, pushes: Any, lifts: Any, *, linear: bool) -> list[Any]:
    """Return series of the changes of u by u, by its rate, by amplitude and by frequency, each of shape (4, n)."""
    (push, push_rate), (lift, lift_rate) = pushes, lifts
    weight = [1.0 + lift[0], *lift[1:]]
    zero, one = np.zeros_like(u), np.ones_like(u)
    motion, sines, cosines = [u, rate], [u if linear else np.sin(u)], [one if linear else np.cos(u)]
    stiffness: list[Any] = []
    vectors: list[Any] = [np.stack([one, zero, zero, zero]), np.stack([zero, one, zero, zero])]

    def product(a: list[Any], b: list[Any], k: int) -> Any:
        return sum(a[j] * b[k - j] for j in range(min(k + 1, len(a))))

    for k in range(_ORDER - 1):
        over = kappa / ((k + 1) * (k + 2))
        motion.append(over * (product(weight, sines, k) + product(push, cosines, k)))  # Eq. 14
        stiffness.append(product(weight, cosines, k) - (0.0 if linear else product(push, sines, k)))
        change = product(stiffness, vectors, k)
        change[2] += product(push, cosines, k) + product(lift, sines, k)
        change[3] += product(push_rate, cosines, k) + product(lift_rate, sines, k)
        vectors.append(over * change)
        rates = [(j + 1) * motion[j + 1] for j in range(k + 1)]
        sines.append(motion[k + 1] if linear else product(rates, cosines, k) / (k + 1))
        cosines.append(zero if linear else -product(rates, sines, k) / (k + 1))
    return vectors
