"""What the measurements say about the coefficient of a body, asked of the layer above by name."""

from collections.abc import Callable
from importlib import import_module
from typing import Protocol

from rocking.bodies import Body
from rocking.conventions import FloatArray, Foot
from rocking.dynamics.impact_law import RandomRestitution
from rocking.studies.sensitivity.sampled import SampledRestitution

# the evidence belongs to the layer above, which is asked for by name and only where a study wants it
_PROVIDER = ("rocking.evidence._restitution_distribution", "restitution_distribution")


class Posterior(Protocol):
    """A distribution of the coefficient of restitution of one body: `rocking.evidence.RestitutionDistribution`."""

    @property
    def quantiles(self) -> FloatArray:
        """Coefficients at equally spaced probabilities [-]."""

    @property
    def extrapolated(self) -> bool:
        """Whether the slenderness of the body is outside what was measured."""

    def sample(self, count: int, seed: int, onto: Foot | None = None) -> FloatArray:
        """Return coefficients drawn from it.

        Returns coefficients [-].
        """

    def per_history(self, seed: int) -> SampledRestitution:
        """Return the law that draws once for every history."""

    def per_impact(self, seed: int) -> RandomRestitution:
        """Return the law that draws at every impact."""


def posterior(body: Body) -> Posterior:
    """Return what all measurements say about the coefficient of restitution of a body.

    >>> from rocking.bodies import Block
    >>> found = posterior(Block(width=0.5, height=2.0))
    >>> bool(0.85 < found.sample(1000, seed=1).mean() < 0.95)
    True
    """
    place, name = _PROVIDER
    provider: Callable[[Body], Posterior] = getattr(import_module(place), name)
    return provider(body)
