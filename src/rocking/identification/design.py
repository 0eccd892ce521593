"""Expected accuracy of experiments: Cramér-Rao bounds of the coefficient of restitution."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.identification import state_space
from rocking.identification.state_space import MEAN, SHARED, SPEED, START, Clicks, Model


def settling_bound(coefficient: float, ratio: float, impacts: int | None = None) -> float:
    """Return the smallest standard deviation of r from times of small impacts, t_inf - D r^n, n = 0..impacts.

    `ratio` is the noise of a time / D. Without `impacts`, their number is infinite, and the time of rest is known.
    """
    if impacts is None:
        return float(ratio * (1.0 - coefficient**2) ** 1.5)  # Eq. 276
    n = np.arange(impacts + 1.0)
    slopes = np.column_stack([np.ones_like(n), -(coefficient**n), -n * coefficient ** (n - 1.0)])
    return float(ratio * np.sqrt(np.linalg.inv(slopes.T @ slopes)[2, 2]))


def one_impact_bound(frequency_parameter: float, before: float, after: float, noise: float) -> float:
    """Return the smallest standard deviation of ln r from three times around one impact, for a known p."""
    a, b = (frequency_parameter / np.sinh(frequency_parameter * duration) for duration in (after, before))
    return float(noise * np.sqrt(2.0 * (a * a + a * b + b * b)))  # Eq. 277


def peaks_bound(before: float, after: float, noise: float) -> float:
    """Return the smallest standard deviation of ln r from the peaks before and after an impact.

    Peaks and noise are divided by alpha.
    """
    parts = [(1.0 - f) / (1.0 - (1.0 - f) ** 2) for f in (before, after)]
    return float(noise * np.hypot(parts[0], parts[1]))  # Eq. 278


@dataclass(frozen=True)
class Design:
    """An experiment with its expected accuracy."""

    release_ratio: float  # initial rotation / slenderness angle [-]
    impacts: int  # number of measured impacts
    timing_noise: float  # standard deviation of a time [s]
    # smallest standard deviation of the mean coefficient of restitution, including the scatter of impacts [-]
    deviation: float


def designs(
    alpha: float, p: float, p_error: float, coefficient: float, scatter: float, noise: float
) -> tuple[Design, ...]:
    """Return possible experiments with one body, sorted by accuracy: release rotation, impacts, noise."""
    settings = [(peak, impacts, noise) for peak in (0.3, 0.5, 0.7, 0.9) for impacts in (6, 12, 20)]
    settings += [(0.7, 12, 0.1 * noise), (0.7, 12, 10.0 * noise)]
    experiments = [
        Design(
            peak,
            impacts,
            noise,
            bound(alpha, p, p_error, coefficient, scatter, peak=peak, impacts=impacts, noise=noise),
        )
        for peak, impacts, noise in settings
    ]
    return tuple(sorted(experiments, key=lambda design: design.deviation))


def bound(
    alpha: Any, p: float, p_error: float, coefficient: float, scatter: float, *, peak: float, impacts: int, noise: float
) -> float:
    """Return the smallest standard deviation of the mean r from times of impacts after a release."""
    alpha = checks.within("alpha", alpha, 0.0, 1.5, unit="rad", open_low=True)
    y = np.sqrt(1.0 - (np.sin(0.5 * alpha * (1.0 - peak)) / np.sin(0.5 * alpha)) ** 2) * coefficient
    mean, deviation = np.zeros(len(SHARED)), np.zeros(len(SHARED))
    mean[SPEED], mean[MEAN] = np.log(y * p * state_space.overturning_speed(np.array(alpha))), np.log(coefficient)
    deviation[START] = deviation[SPEED] = deviation[MEAN] = 10.0
    deviation[state_space.FREQUENCY] = p_error
    model = Model(np.arange(impacts - 1) % 2, (alpha, alpha), (p, p), mean, deviation)
    path = model.path(np.zeros((1, model.size)), np.array([scatter]))
    slopes: FloatArray = Clicks(path.times[0], np.arange(impacts)).residuals(path)[1][0] / noise
    root = np.linalg.qr(np.concatenate([slopes, np.eye(model.size)]), mode="r")
    return float(coefficient * 10.0 * np.linalg.norm(np.linalg.inv(root)[MEAN]))
