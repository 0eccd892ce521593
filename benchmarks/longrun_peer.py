"""Harmonic rocking as a numba loop: Runge-Kutta steps of fourth order, impacts by Newton's method."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

STEPS = 100  # steps in a period: an error of about 1e-7 of alpha in a period


def periods(with_tangent: bool) -> Callable[..., Any]:
    """Return a function that follows one history over periods, with or without a tangent vector."""
    from numba import njit

    @njit
    def rates(t: float, y: Any, side: float, body: Any) -> Any:
        x, v, a, b = y
        alpha, p2, push, omega = body
        angle, ground = alpha * side - x, push * math.sin(omega * t)
        sine, cosine = math.sin(angle), math.cos(angle)
        rate = -p2 * (sine + ground * cosine)
        return (v, rate, b, p2 * (cosine - ground * sine) * a) if with_tangent else (v, rate, 0.0, 0.0)

    @njit
    def step(t: float, h: float, y: Any, side: float, body: Any) -> Any:
        x, v, a, b = y
        k1 = rates(t, y, side, body)
        g = 0.5 * h
        k2 = rates(t + g, (x + g * k1[0], v + g * k1[1], a + g * k1[2], b + g * k1[3]), side, body)
        k3 = rates(t + g, (x + g * k2[0], v + g * k2[1], a + g * k2[2], b + g * k2[3]), side, body)
        k4 = rates(t + h, (x + h * k3[0], v + h * k3[1], a + h * k3[2], b + h * k3[3]), side, body)
        s = h / 6.0
        return (
            x + s * (k1[0] + 2.0 * (k2[0] + k3[0]) + k4[0]), v + s * (k1[1] + 2.0 * (k2[1] + k3[1]) + k4[1]),
            a + s * (k1[2] + 2.0 * (k2[2] + k3[2]) + k4[2]), b + s * (k1[3] + 2.0 * (k2[3] + k3[3]) + k4[3]),
        )  # fmt: skip

    @njit
    def follow(t: float, x: float, v: float, count: int, r: float, body: Any) -> Any:
        """Return rotation, velocity and the logarithm of the growth after periods; NaN once overturned."""
        h = 2.0 * math.pi / (body[3] * STEPS)
        y, side, growth = (x, v, 1.0, 0.0), 1.0 if v > 0.0 else -1.0, 0.0
        for _ in range(count):
            for _ in range(STEPS):
                left = h
                while left > 0.0:
                    made = step(t, left, y, side, body)
                    if side * made[0] >= 0.0:
                        t, y, left = t + left, made, 0.0
                        continue
                    part = left * y[0] / (y[0] - made[0])
                    for _ in range(6):
                        made = step(t, part, y, side, body)
                        part -= made[0] / made[1]
                    x, v, a, b = step(t, part, y, side, body)
                    if with_tangent:
                        before = rates(t + part, (0.0, v, 0.0, 0.0), side, body)[1]
                        after = rates(t + part, (0.0, r * v, 0.0, 0.0), -side, body)[1]
                        a, b = r * a, r * b + (after - r * before) / v * a
                    t, y, left, side = t + part, (0.0, r * v, a, b), left - part, -side
                if abs(y[0]) > 0.5 * math.pi:
                    return np.nan, np.nan, np.nan
            if with_tangent:
                size = math.hypot(y[2], y[3] / math.sqrt(body[1]))
                growth += math.log(size)
                y = (y[0], y[1], y[2] / size, y[3] / size)
        return y[0], y[1], growth

    return follow
