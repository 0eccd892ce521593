"""A family of synthetic motions: a generator, a distribution for each of its parameters, and where these come from."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.motions.motion import GroundMotion
from rocking.motions.synthetic.distributions import Distribution

HONESTY = "illustrative ranges chosen by this package: no fit to records, no hazard model"
"""What every family says about where its distributions come from."""


@dataclass(frozen=True)
class Family:
    """A generator with the distributions of its parameters.

    Parameters
    ----------
    name : str
        Short name.
    title : str
        What the motions are like, in a few words.
    generator : str
        Which model of ground motion, with its source.
    distributions : mapping of str to Distribution
        By parameter, in the order of drawing; the unit stands in the name.
    make : callable
        Takes the values by parameter, a seed and a time step [s]; returns a motion.
    time_step : float
        Step between samples unless asked otherwise [s].
    origin : str
        Where the distributions come from.
    """

    name: str
    title: str
    generator: str
    distributions: Mapping[str, Distribution]
    make: Callable[[Mapping[str, float], int, float], GroundMotion]
    time_step: float = 0.01
    origin: str = HONESTY

    def parameters(self, shares: FloatArray) -> dict[str, float]:
        """Return the parameters of a motion from uniform random numbers.

        Parameters
        ----------
        shares : ndarray
            One number from 0 to 1 for each parameter, in the order of `distributions` [-].

        Returns
        -------
        dict of str to float
            Value by parameter.

        Raises
        ------
        InvalidValueError
            If there is not one number for each parameter.
        """
        if np.shape(shares) != (len(self.distributions),):
            raise InvalidValueError(f"shares must be {len(self.distributions)} numbers, got shape {np.shape(shares)}")
        pairs = zip(self.distributions.items(), shares, strict=True)
        # twelve digits: the last ones hang on the C library
        return {name: float(f"{spread.value_at(float(share)):.12g}") for (name, spread), share in pairs}

    def motion(self, seed: int, number: int = 0, time_step: float | None = None) -> GroundMotion:
        """Return one motion of the family.

        Parameters
        ----------
        seed : int
            Seed of the whole set, at least 0 [-].
        number : int
            Number of the motion, at least 0; seed and number alone make the motion [-].
        time_step : float, optional
            Step between samples; that of the family if not given [s].

        Returns
        -------
        GroundMotion
            The motion, with what was drawn as metadata.

        Examples
        --------
        >>> from rocking.motions.synthetic.families import family
        >>> motion = family("point-source").motion(seed=7, number=3)
        >>> motion.name, 5.5 <= float(motion.metadata["magnitude"]) <= 7.5
        ('point-source, seed 7, number 3', True)
        """
        seed, number = whole("seed", seed), whole("number", number)
        step = self.time_step if time_step is None else checks.positive("time_step", time_step, "s")
        shares, noise = _random(seed, number, len(self.distributions))
        drawn = self.parameters(shares)
        told = {"family": self.name, "seed": str(seed), "number": str(number)}
        told |= {name: repr(value) for name, value in drawn.items()}
        made = self.make(drawn, noise, step)
        line = f"parameters drawn from the family {self.name} ({self.origin}), seed {seed}, number {number}"
        return made.changed(line, name=f"{self.name}, seed {seed}, number {number}", metadata=told)


def whole(name: str, value: object, low: int = 0, high: int = 2**63 - 1) -> int:
    """Return a whole number within its range."""
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or not low <= int(value) <= high:
        raise InvalidValueError(f"{name} must be a whole number in [{low}, {high}], got {value!r:.60}")
    return int(value)


def _random(seed: int, number: int, count: int) -> tuple[FloatArray, int]:
    """Return uniform numbers for the parameters, and a seed for the noise."""
    parameters, noise = np.random.SeedSequence(entropy=seed, spawn_key=(number,)).spawn(2)
    low, high = noise.generate_state(2, np.uint64).tolist()
    return np.random.Generator(np.random.Philox(parameters)).random(count), low | high << 64
