"""How sharply an experiment could tell the coefficient of restitution: bounds of Cramér and Rao, before it is made."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.identification import half_cycles, state_space
from rocking.identification.state_space import MEAN, SHARED, SPEED, START, Clicks, Model


@dataclass(frozen=True)
class Design:
    """What an experiment would tell.

    Parameters
    ----------
    peak : float
        Rotation from which the body is let go, over its slenderness angle [-].
    impacts : int
        Number of impacts whose times are kept.
    noise : float
        Standard deviation of a time [s].
    deviation : float
        Least standard deviation of the mean coefficient of restitution, with the scatter of impacts in it [-].
    """

    peak: float
    impacts: int
    noise: float
    deviation: float


def designs(
    alpha: float, p: float, p_error: float, coefficient: float, scatter: float, noise: float
) -> tuple[Design, ...]:
    """Return experiments with one body, from what is usual to what would tell more: height, impacts, noise."""
    found = [(peak, impacts, noise) for peak in (0.3, 0.5, 0.7, 0.9) for impacts in (6, 12, 20)]
    found += [(0.7, 12, 0.1 * noise), (0.7, 12, 10.0 * noise)]
    made = [
        Design(*each, bound(alpha, p, p_error, coefficient, scatter, peak=each[0], impacts=each[1], noise=each[2]))
        for each in found
    ]
    return tuple(sorted(made, key=lambda each: each.deviation))


def bound(
    alpha: Any, p: float, p_error: float, coefficient: float, scatter: float, *, peak: float, impacts: int, noise: float
) -> float:
    """Return the least standard deviation of the mean r from times of impacts, of a body let go from a peak."""
    alpha = checks.within("alpha", alpha, 0.0, 1.5, unit="rad", open_low=True)
    y = np.sqrt(1.0 - (np.sin(0.5 * alpha * (1.0 - peak)) / np.sin(0.5 * alpha)) ** 2) * coefficient
    mean, deviation = np.zeros(len(SHARED)), np.zeros(len(SHARED))
    mean[SPEED], mean[MEAN] = np.log(y * p * half_cycles.overturning_speed(np.array(alpha))), np.log(coefficient)
    deviation[START] = deviation[SPEED] = deviation[MEAN] = 10.0
    deviation[state_space.FREQUENCY] = p_error
    model = Model(np.arange(impacts - 1) % 2, (alpha, alpha), (p, p), mean, deviation)
    path = model.path(np.zeros((1, model.size)), np.array([scatter]))
    slopes: FloatArray = Clicks(path.times[0], np.arange(impacts)).residuals(path)[1][0] / noise
    root = np.linalg.qr(np.concatenate([slopes, np.eye(model.size)]), mode="r")
    return float(coefficient * 10.0 * np.linalg.norm(np.linalg.inv(root)[MEAN]))
