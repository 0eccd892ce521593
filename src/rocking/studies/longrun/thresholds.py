"""Thresholds of harmonic rocking in closed form, for slender bodies."""

import math
from dataclasses import asdict, dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.optimize import brentq

from rocking import checks
from rocking.conventions import FloatArray

if TYPE_CHECKING:
    from rocking.studies.longrun.system import HarmonicRocking


@dataclass(frozen=True)
class SlenderThresholds:
    """Amplitude ratios a / (g alpha) of a slender body under harmonic ground motion.

    Parameters
    ----------
    uplift : float
        Smallest amplitude that lifts a body at rest, which overturns it if it acts statically: 1.
    fold : float
        Smallest amplitude with a symmetric orbit of one impact per half period.
    melnikov : float
        First-order threshold of heteroclinic tangency, for a coefficient of restitution near 1.
    heteroclinic : float
        Exact threshold of the tangency of the saddles' manifolds through one impact.
    housner : float
        Housner's amplitude of a half sine that overturns a body from rest; it is unconservative.
    no_impact : float
        Smallest amplitude that overturns a body from rest at the phase of uplift, without impact, within one half sine.
    one_impact : float
        Smallest amplitude that overturns a body from rest after one impact, within one full sine; NaN if there is none.
    """

    uplift: float
    fold: float
    melnikov: float
    heteroclinic: float
    housner: float
    no_impact: float
    one_impact: float


def slender_conditions(frequency: float, restitution: float) -> tuple[FloatArray, FloatArray]:
    """Return forced rotation and rate / frequency at an impact of the symmetric orbit: at speed 0, by speed."""
    w = checks.positive("frequency", frequency)
    r = checks.within("restitution", restitution, 0.0, 1.0, open_low=True)
    c, s = math.cosh(math.pi / w), math.sinh(math.pi / w)
    # Eq. 333: (1 + c) X + s Y = c - 1 - v s,  s X + (1 + c) Y = s - v (c + 1 / r)
    sides = np.array([[c - 1.0, -s], [s, -(c + 1.0 / r)]])
    at_zero, by_speed = np.linalg.solve([[1.0 + c, s], [s, 1.0 + c]], sides).T * [1.0, 1.0 / w]
    return at_zero, by_speed


def slender_thresholds(frequency: float, restitution: float) -> SlenderThresholds:
    """Return the thresholds of a slender body.

    Parameters
    ----------
    frequency : float
        Circular frequency / p [-].
    restitution : float
        Coefficient of restitution, in (0, 1] [-].

    Returns
    -------
    SlenderThresholds
        Amplitude ratios [-].

    Raises
    ------
    InvalidValueError
        If a value is outside its range.

    References
    ----------
    Lenci and Rega (2006), Int. J. Bifurcation Chaos 16 (heteroclinic tangency); Spanos and Koh (1984), J. Eng. Mech.
    110:1627-1642 (symmetric orbit); Housner (1963), Bull. Seismol. Soc. Am. 53:403-417; Shi, Anooshehpoor, Zeng and
    Brune (1996), Bull. Seismol. Soc. Am. 86:1364-1371 (half sine); Zhang and Makris (2001), J. Eng. Mech. 127:473-483
    (full sine).

    Examples
    --------
    >>> round(slender_thresholds(2.0, 0.5).heteroclinic, 12)
    1.386750490563
    """
    w = checks.positive("frequency", frequency)
    r = checks.within("restitution", restitution, 0.0, 1.0, open_low=True)
    free, by_speed = slender_conditions(w, r)
    least_squared = free @ free - (free @ by_speed) ** 2 / (by_speed @ by_speed)
    return SlenderThresholds(
        uplift=1.0,
        fold=(1.0 + w * w) * math.sqrt(least_squared),  # Eq. 334
        melnikov=(1.0 + w * w) * (1.0 - r * r) / 4.0,  # Eq. 339
        # Eq. 338
        heteroclinic=(1.0 + w * w) * (1.0 - r) / math.sqrt((w * (1.0 - r)) ** 2 + (1.0 + r) ** 2),
        housner=math.hypot(1.0, w),
        no_impact=_half_sine(w),
        one_impact=_full_sine(w, r),
    )


def thresholds_of(system: "HarmonicRocking") -> dict[str, float]:
    """Return the thresholds of the slender body with the frequency ratio and the coefficient of a system, by name.

    Only the amplitude of uplift holds for a body that is not symmetric, or a coefficient that depends on the speed.
    """
    restitution = float(system.sides[2])
    if not system.is_symmetric or system.factors.size or restitution == 0.0:
        return {"uplift": 1.0}
    thresholds = asdict(slender_thresholds(system.frequency_ratio, restitution))
    return {name: value for name, value in thresholds.items() if math.isfinite(value)}


def _half_sine(w: float) -> float:
    """Return the amplitude at which a half sine overturns without impact: cos x + exp(-(pi - x) / w) = w sin x."""
    # Eq. 340
    x = brentq(lambda x: math.cos(x) + math.exp(-(math.pi - x) / w) - w * math.sin(x), 1e-12, math.pi / 2.0, xtol=1e-15)
    return 1.0 / math.sin(x)


def _full_sine(w: float, r: float) -> float:
    """Return the smallest amplitude at which a full sine overturns after one impact; NaN if there is none."""

    def margin(amplitude: float) -> float:
        """Return x + 1 + x' at the end of the sine, reduced to the impact; below 0 the body overturns."""
        g, start = amplitude / (1.0 + w * w), math.asin(1.0 / amplitude)
        end = (2.0 * math.pi - start) / w

        def motion(t: Any, slope: int = 0) -> Any:
            waves = (np.sin, np.cos)[slope](w * t + start) * w**slope
            growing, decaying = (np.cosh, np.sinh)[:: 1 - 2 * slope]
            return 1.0 - slope + (g / amplitude - 1.0) * growing(t) + g * w * math.cos(start) * decaying(t) - g * waves

        times = np.linspace(0.0, end, 2000)[1:]
        below = np.flatnonzero(motion(times) < 0.0)
        if not below.size:  # the impact, if any, comes after the sine
            x, rate = float(motion(end)), float(motion(end, 1))
            return 1.0 - r * math.sqrt(max(rate**2 + x * (2.0 - x), 0.0)) if x + rate < 1.0 else math.inf
        if not below[0]:
            return math.inf
        impact = brentq(motion, times[below[0] - 1], times[below[0]], xtol=1e-15)
        phase = w * impact + start
        ground = math.sin(phase) + w * math.cos(phase) - w * math.exp(impact - end)
        return float(1.0 + r * motion(impact, 1) + g * ground)  # Eq. 342

    amplitudes = np.geomspace(1.0 + 1e-9, 1.0 + w * w, 400).tolist()
    for low, high in pairwise(amplitudes):
        if margin(high) < 0.0:
            return float(brentq(margin, low, high, xtol=1e-14))
    return math.nan
