"""Where pulses overturn a block by the slender-linear equations, over g alpha; REF numbers: see CONTRIBUTING.md.

They follow from the stable manifold of the unstable equilibrium: the linear equations overturn without an impact if A
times the integral of s(tau) exp(-(tau - tau_0)) from uplift tau_0 to the end exceeds one, A = a_p / (g alpha),
tau = p t; for full sines these are modes II (no impact) and I (one impact) of Zhang & Makris 2001 (EESD 30:461).
Keys are Omega = omega_p / p, or p times the duration of a rectangle.
"""

import math

from scipy.optimize import brentq

RECTANGLE = {0.5: 2.5414940825367982841, 1.0: 1.5819767068693264244, 2.0: 1.1565176427496656518}
HALF_SINE = {
    1: 1.3223965979078765668, 2: 1.8007239305607457817, 3: 2.2938723134392918526, 5: 3.2891467775230030447,
    8: 4.7870712683499157432, 10: 5.7865216516964278046,
}  # fmt: skip
SINE_NO_IMPACT = {
    1: 1.4183153355788508339, 2: 2.3499031269556409935, 3: 3.6311498724447945014, 8: 14.871352061270091178,
    10: 21.599989284727501635,
}  # fmt: skip
SINE_ONE_IMPACT = {  # r = 0.9: lower, upper
    2: (1.22517942326831362, 2.31440295302158405), 3: (1.40356535564278266, 3.48466273332249203),
    5: (3.01859986087179637, 6.31807052982744609), 6: (5.1641589274575678, 7.6698730415941765),
}  # fmt: skip
LOWER_AT_ONE = 1.13204711059768365  # r = 0.9, Omega = 1, where mode II begins before mode I ends
SINE_ONE_IMPACT_ELASTIC = {  # r = 1: lower
    1: 1.12780479486212521, 2: 1.21383084814880623, 3: 1.36705162931038883, 4: 1.6482806535939368,
    5: 2.22056633180111026, 6: 3.41721761686939524, 8: 6.87138435869612107, 10: 11.5999959514276214,
}  # fmt: skip
COSINE = {2: 5.225828526818421, 5: 36.34378926613579}


def mode_two(omega: float) -> float:
    """Mode II of the full sine, solved here."""

    def open_terms(psi: float) -> float:
        return math.cos(psi) - math.exp(-(2.0 * math.pi - psi) / omega) - omega * math.sin(psi)

    return float(1.0 / math.sin(brentq(open_terms, 1e-9, 0.5 * math.pi, xtol=1e-16)))
