"""Impacts that die out: when they have brought a body to rest."""

from rocking.dynamics.parameters import RockingParameters
from rocking.dynamics.plane.event_functions import RestoringMoments

_LONGEST_WINDOW = 40.0
_HEIGHTS = 0.1  # what the heights of flights to rest may add to the logarithm of their gain
NOTHING = 1e-9
"""Speed over p alpha that is none: a body that the ground holds, and that is no faster, is at rest."""


def comes_to_rest(  # noqa: PLR0917 - the state, in the order of the engine
    parameters: RockingParameters,
    ground: RestoringMoments,
    sign: int,
    after: float,
    stretch: int,
    tau: float,
    rest_speed: float,
) -> bool:
    """Return whether the impacts to come provably add up to rest before the body could rise again.

    Flights take disjoint times, so that the speed gained by moments that change is bounded by their total variation;
    the sum of the flights is a geometric series. The proof is in the theory, "Rest".

    after: speed after the impact [rad/s]; rest_speed: speed over p alpha above which the question is not asked; below
    `NOTHING` it always is [-].
    """
    side = parameters.side(sign)
    unit = side.frequency_parameter * side.slenderness_angle
    held = ground.held(sign, stretch, tau)
    if after <= NOTHING * unit and held > 0.0:
        return True
    other, across = parameters.side(-sign), ground.held(-sign, stretch, tau)
    if not (after <= rest_speed * unit and held > 0.0 and across > 0.0):
        return False
    # all in units of stretches; the flights under the moments of now, as a guess of the time they take
    step = ground.push.step
    one, two = ((k.frequency_parameter * step) ** 2 for k in (side, other))
    r, q = parameters.largest(sign), parameters.largest(-sign)
    speed, lost = after * step, 1.0 - r * q
    flights, rate = 2.0 * speed * (two * across + q * one * held), one * held * (two * across) * lost  # Eq. 37
    if not flights < _LONGEST_WINDOW * rate:
        return False
    left, guess = 1.0 - tau, 1.5 * (flights / rate)
    stretches = min(int(guess - left) + 2, ground.until_jump(stretch)) if guess > left else 1
    window = ground.window(stretch, tau, stretches)
    if window is None:
        return False
    low, low_ = window.low[sign], window.low[-sign]
    x = 0.5 * (window.variation + _HEIGHTS)
    gain = 1.0 + x + x * x  # more than exp(x) up to x = 1
    heights = window.steepness * (speed * gain) ** 2 / min(one * low * low, two * low_ * low_)  # Eq. 40
    small = 2.2 * heights * (1.0 + q * q) <= _HEIGHTS * (1.0 - (r * q) ** 2) and heights <= 0.3
    if not (x <= 1.0 and small):
        return False
    total = 2.0 * speed * gain * (1.0 / (one * low) + q / (two * low_)) / (lost * (1.0 - heights))  # Eq. 16
    return bool(total <= left + (stretches - 1))
