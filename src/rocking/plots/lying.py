"""The end of a fall: the same equation of motion about the same foot, until the body meets the ground."""

import math
from dataclasses import dataclass

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.plane import equations
from rocking.dynamics.response import Response
from rocking.outcome import Outcome

_STEP = 0.01
"""Step of the integration, over 1 / p: what the fourth order leaves out is below 1e-8 of the angle."""
_MOST_STEPS = 20_000
_HALVINGS = 50


@dataclass(frozen=True, eq=False)
class Fall:
    """What follows the last state of a response whose body overturned.

    The response ends at a quarter turn, or before it where its motion does and only energy decides. From there the
    equation of motion goes on, with whatever the ground still does, until a corner of the body meets the ground. There
    the body is taken to lie: what a hard landing on a side does is not part of the model.
    """

    time: FloatArray  # increasing, from the end of the response; empty if the body does not overturn [s]
    rotation: FloatArray  # rotation, velocity: theta [rad] and theta' [rad/s]
    velocity: FloatArray


def fall_of(response: Response, lying: tuple[float, float]) -> Fall:
    """Return how the fall of a response goes on after its last state.

    lying: rotations, below and above zero, at which the body lies on its left and on its right side [rad].

    >>> import rocking as rk
    >>> body, quarter = rk.Block(width=0.5, height=2.0), 0.5 * np.pi
    >>> fall = fall_of(rk.free_rocking(body, rotation=0.25), (-quarter, quarter))
    >>> bool(abs(fall.rotation[-1] - quarter) < 1e-12)
    True
    """
    if response.outcome is not Outcome.OVERTURNED:
        return Fall(np.empty(0), np.empty(0), np.empty(0))
    last = response.dense_output
    falling = _Falling(response, lying)
    rows = [(float(last.end[-1]), float(last.rotation[-1, 1]), float(last.velocity[-1, 1]))]
    side = 1.0 if (rows[0][1] or rows[0][2]) > 0.0 else -1.0
    while not falling.lies(rows[-1], side) and len(rows) < _MOST_STEPS:
        side, state = falling.advanced(side, rows[-1])
        rows.append(state)
    time, rotation, velocity = np.array(rows).T
    return Fall(time, np.clip(rotation, *lying), velocity)


_State = tuple[float, float, float]


@dataclass(frozen=True)
class _Falling:
    """A body on its way: (time, theta, theta') from step to step."""

    response: Response
    lying: tuple[float, float]

    def lies(self, state: _State, side: float) -> bool:
        return side * state[1] >= side * self.lying[side > 0.0]

    def advanced(self, side: float, state: _State) -> tuple[float, _State]:
        """Return side and state after a step, or where the body meets the ground or the other foot within it."""
        step = _STEP / self.response.parameters.side(side).frequency_parameter
        after = self._step(side, state, step)
        lands = side * after[1] < 0.0
        if not (lands or self.lies(after, side)):
            return side, after
        low, high = 0.0, step
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            tried = self._step(side, state, middle)
            beyond = side * tried[1] < 0.0 if lands else self.lies(tried, side)
            low, high = (low, middle) if beyond else (middle, high)
        time, rotation, speed = self._step(side, state, high)
        if not lands:
            return side, (time, rotation, speed)
        return -side, (time, 0.0, self._coefficient(-side, speed) * speed)

    def _coefficient(self, onto: float, speed: float) -> float:
        parameters, run = self.response.parameters, self.response.trajectory
        return parameters.coefficient(onto, abs(speed), self.response.stream, run.impacts + 1)

    def _step(self, side: float, state: _State, step: float) -> _State:
        """Return the state after a step, by the classical method of Runge and Kutta."""
        time, start = state[0], np.array(state[1:])

        def slope(share: float, y: FloatArray) -> FloatArray:
            return np.array([y[1], self._acceleration(side, time + share * step, float(y[0]))])

        first = slope(0.0, start)
        second = slope(0.5, start + 0.5 * step * first)
        third = slope(0.5, start + 0.5 * step * second)
        fourth = slope(1.0, start + step * third)
        end = start + step / 6.0 * (first + 2.0 * second + 2.0 * third + fourth)
        return time + step, float(end[0]), float(end[1])

    def _acceleration(self, side: float, time: float, rotation: float) -> float:
        response, segments = self.response, self.response.segments
        place, k = time / segments.step, math.floor(time / segments.step)
        push = weight = 0.0
        if k < segments.count:
            powers = (place - k) ** np.arange(segments.degree + 1) * response.scale / response.settings.gravity
            push = float(segments.horizontal[k] @ powers)
            weight = 0.0 if segments.vertical is None else float(segments.vertical[k] @ powers)
        on = response.parameters.side(side)
        return float(
            equations.angular_acceleration(
                rotation, side, on.slenderness_angle, on.frequency_parameter, push, 1.0 + weight,
                linear=response.settings.linear,
            )
        )  # fmt: skip
