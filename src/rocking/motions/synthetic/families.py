"""Families of synthetic motions: generators with distributions of their parameters."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.motions.filters import highpassed
from rocking.motions.motion import GroundMotion, checked_motion
from rocking.motions.pulse import Pulse
from rocking.motions.pulses import mavroeidis_papageorgiou
from rocking.motions.synthetic.distributions import Distribution, Lognormal, LogUniform, Uniform
from rocking.motions.synthetic.kanai_tajimi import Envelope, KanaiTajimi, kanai_tajimi_motion
from rocking.motions.synthetic.point_source import PointSource, point_source_motion
from rocking.motions.synthetic.sampling import MOST_SAMPLES
from rocking.motions.synthetic.stochastic import NonstationaryFilter, modulation_from_intensity, nonstationary_motion

HONESTY = "illustrative ranges chosen by this package: no fit to records, no hazard model"
"""Source of the distributions of every family."""


@dataclass(frozen=True)
class Family:
    """A generator with the distributions of its parameters.

    Parameters
    ----------
    name : str
        Short name.
    title : str
        Short description of the motions.
    generator : str
        Model of ground motion, with its source.
    distributions : mapping of str to Distribution
        Distributions by parameter name, in the order of sampling. The name contains the unit.
    make : callable
        Function of the values by parameter, a seed and a time step [s], which returns a motion.
    time_step : float
        Default time step between samples [s].
    origin : str
        Source of the distributions.
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
            Numbers from 0 to 1, one per parameter, in the order of `distributions` [-].

        Returns
        -------
        dict of str to float
            Values by parameter.
        """
        if np.shape(shares) != (len(self.distributions),):
            raise InvalidValueError(
                "{parameter} must be {count} numbers, got shape {shape}", parameter="shares",
                count=len(self.distributions), shape=np.shape(shares),
            )  # fmt: skip
        pairs = zip(self.distributions.items(), shares, strict=True)
        # rounded to twelve digits, because further digits depend on the C library
        return {name: float(f"{spread.quantile(float(share)):.12g}") for (name, spread), share in pairs}

    def motion(self, seed: int, number: int = 0, time_step: float | None = None) -> GroundMotion:
        """Return one motion of the family.

        Parameters
        ----------
        seed : int
            Seed of the set, at least 0 [-].
        number : int
            Number of the motion, at least 0 [-]. Seed and number define the motion.
        time_step : float, optional
            Time step between samples [s]. The default is the time step of the family.

        Returns
        -------
        GroundMotion
            Motion with the sampled parameters as metadata.

        Examples
        --------
        >>> motion = family("point-source").motion(seed=7, number=3)
        >>> motion.name, 5.5 <= float(motion.metadata["magnitude"]) <= 7.5
        ('point-source, seed 7, number 3', True)
        """
        seed, number = checks.whole("seed", seed), checks.whole("number", number)
        step = self.time_step if time_step is None else checks.positive("time_step", time_step, "s")
        shares, noise = _random(seed, number, len(self.distributions))
        sampled = self.parameters(shares)
        metadata = {"family": self.name, "seed": str(seed), "number": str(number)}
        metadata |= {name: repr(value) for name, value in sampled.items()}
        motion = self.make(sampled, noise, step)
        line = f"parameters sampled from the family {self.name} ({self.origin}), seed {seed}, number {number}"
        return motion.changed(line, name=f"{self.name}, seed {seed}, number {number}", metadata=metadata)


def _random(seed: int, number: int, count: int) -> tuple[FloatArray, int]:
    """Return uniform numbers for the parameters, and a seed for the noise."""
    parameters, noise = np.random.SeedSequence(entropy=seed, spawn_key=(number,)).spawn(2)
    low, high = noise.generate_state(2, np.uint64).tolist()
    return np.random.Generator(np.random.Philox(parameters)).random(count), low | high << 64


def with_pulse(residual: GroundMotion, pulse: Pulse, arrival: float) -> GroundMotion:
    """Return the sum of a motion and a pulse.

    Parameters
    ----------
    residual : GroundMotion
        Record without its pulse. The vertical part of the record is unchanged.
    pulse : Pulse
        Pulse, sampled at the time step of the residual.
    arrival : float
        Time of the middle of the pulse [s], rounded to a whole step. The pulse must not begin before the motion.

    Returns
    -------
    GroundMotion
        Sum of both motions. It is longer than the residual if the pulse ends later.

    Examples
    --------
    >>> from rocking.motions.pulses import mavroeidis_papageorgiou
    >>> still = GroundMotion([0.0, 0.0], time_step=0.01)
    >>> motion = with_pulse(still, mavroeidis_papageorgiou(velocity=0.5, period=1.0), arrival=1.0)
    >>> from rocking.motions import peak_ground_velocity
    >>> round(peak_ground_velocity(motion), 3)
    0.5
    """
    residual = checked_motion(residual, "residual")
    checks.of_kind("pulse", pulse, Pulse, "a pulse such as pulses.mavroeidis_papageorgiou(..)")
    step, half = residual.time_step, 0.5 * pulse.duration
    arrival = checks.within(
        "arrival", arrival, half, MOST_SAMPLES * step - half, unit="s", hint="the pulse would begin before the motion"
    )
    first = max(round((arrival - half) / step), 0)
    count = max(len(residual), first + math.ceil(pulse.duration / step) + 2)
    horizontal = np.zeros(count)
    horizontal[: len(residual)] = residual.acceleration
    horizontal += pulse.acceleration((np.arange(count) - first) * step)
    vertical = None
    if residual.vertical is not None:
        vertical = np.concatenate([residual.vertical, np.zeros(count - len(residual))])
    action = f"{pulse.name} added, its middle at {first * step + half:g} s"
    return residual.changed(action, acceleration=horizontal, vertical=vertical)


def families() -> dict[str, Family]:
    """Return all families.

    Returns
    -------
    dict of str to Family
        Families by name, in a new dict.

    Examples
    --------
    >>> list(families())
    ['firm-ground', 'soft-ground', 'kanai-tajimi', 'point-source', 'pulse-like']
    """
    return {item.name: item for item in _ALL}


def family(which: str | Family) -> Family:
    """Return a family by its name.

    Parameters
    ----------
    which : str or Family
        Name from `families`; a family is returned unchanged.

    Returns
    -------
    Family
        Family of motions.
    """
    if isinstance(which, Family):
        return which
    available = families()
    return available[checks.one_of("family", which, available)]


def _stochastic(sampled: Mapping[str, float], seed: int, step: float, corner: float) -> GroundMotion:
    length = sampled["significant_duration_s"]
    middle = sampled["middle_over_duration"] * length
    modulation = modulation_from_intensity(sampled["arias_intensity_m_s"], length, middle)
    shaper = NonstationaryFilter(
        sampled["frequency_hz"], sampled["slope_hz_s"], middle, sampled["damping"], lowest=0.2 * sampled["frequency_hz"]
    )
    # the high pass comes to rest after about two of its periods
    duration = round(modulation.time_of(0.999) + 2.0 / corner, 9)
    return nonstationary_motion(modulation, shaper, seed=seed, time_step=step, duration=duration, corner=corner)


def _nonstationary(sampled: Mapping[str, float], seed: int, step: float) -> GroundMotion:
    return _stochastic(sampled, seed, step, sampled["corner_hz"])


def _layer(sampled: Mapping[str, float], seed: int, step: float) -> GroundMotion:
    layer = KanaiTajimi(sampled["density_m2_s3"], sampled["frequency_hz"], sampled["damping"])
    rise, plateau = sampled["rise_s"], sampled["plateau_s"]
    envelope = Envelope(rise, rise + plateau, sampled["decay_1_s"])
    corner = sampled["corner_hz"]
    duration = rise + plateau + 3.0 / sampled["decay_1_s"] + 2.0 / corner
    raw = kanai_tajimi_motion(layer, envelope, seed=seed, time_step=step, duration=duration)
    action = f"high-passed by a critically damped oscillator of {corner!r} Hz"
    return raw.changed(action, acceleration=highpassed(raw.acceleration, raw.time_step, corner))


def _source(sampled: Mapping[str, float], seed: int, step: float) -> GroundMotion:
    source = PointSource(
        magnitude=sampled["magnitude"],
        distance=1e3 * sampled["distance_km"],
        stress_drop=1e5 * sampled["stress_drop_bar"],
        kappa=sampled["kappa_s"],
    )
    return point_source_motion(source, seed=seed, time_step=step)


def _pulse_like(sampled: Mapping[str, float], seed: int, step: float) -> GroundMotion:
    period, cycles = sampled["pulse_period_s"], sampled["pulse_cycles"]
    pulse = mavroeidis_papageorgiou(sampled["pulse_velocity_m_s"], period, cycles, sampled["pulse_phase_rad"])
    # below the frequency of the high pass, only the pulse remains
    residual = _stochastic(sampled, seed, step, 1.0 / period)
    middle = sampled["middle_over_duration"] * sampled["significant_duration_s"]
    return with_pulse(residual, pulse, max(middle, 0.5 * pulse.duration + step))


_FILTERED = (
    "modulated filtered white noise (Rezaeian & Der Kiureghian 2008, Earthquake Engineering & Structural Dynamics "
    "37:1565)"
)
_FIRM: dict[str, Distribution] = {
    "arias_intensity_m_s": Lognormal(0.05, 5.0, median=0.5, deviation=0.8),
    "significant_duration_s": Lognormal(5.0, 30.0, median=12.0, deviation=0.4),
    "middle_over_duration": Uniform(0.4, 0.9),
    "frequency_hz": Lognormal(2.0, 12.0, median=5.0, deviation=0.4),
    "slope_hz_s": Uniform(-0.2, 0.0),
    "damping": Uniform(0.15, 0.45),
}
_ALL = (
    Family(
        "firm-ground",
        "ordinary motions on firm ground, rich in high frequencies",
        _FILTERED,
        _FIRM | {"corner_hz": LogUniform(0.08, 0.2)},
        _nonstationary,
    ),
    Family(
        "soft-ground",
        "long motions on soft ground, with slow strong waves",
        _FILTERED,
        {
            "arias_intensity_m_s": Lognormal(0.05, 5.0, median=0.5, deviation=0.8),
            "significant_duration_s": Lognormal(10.0, 50.0, median=22.0, deviation=0.4),
            "middle_over_duration": Uniform(0.4, 0.9),
            "frequency_hz": Lognormal(0.6, 3.0, median=1.4, deviation=0.35),
            "slope_hz_s": Uniform(-0.03, 0.0),
            "damping": Uniform(0.1, 0.3),
            "corner_hz": LogUniform(0.05, 0.12),
        },
        _nonstationary,
        time_step=0.02,
    ),
    Family(
        "kanai-tajimi",
        "a layer of soil shaken by white noise under a simple envelope",
        "Kanai (1957) and Tajimi (1960), envelope of Jennings, Housner & Tsai (1968)",
        {
            "density_m2_s3": Lognormal(0.001, 0.1, median=0.01, deviation=0.8),
            "frequency_hz": Lognormal(1.0, 6.0, median=2.5, deviation=0.4),
            "damping": Uniform(0.3, 0.8),
            "rise_s": Uniform(1.0, 4.0),
            "plateau_s": Uniform(3.0, 12.0),
            "decay_1_s": LogUniform(0.2, 0.8),
            "corner_hz": LogUniform(0.08, 0.2),
        },
        _layer,
    ),
    Family(
        "point-source",
        "the far field of earthquakes of magnitude 5.5 to 7.5 at 10 to 80 km",
        "stochastic point source (Boore 2003, Pure and Applied Geophysics 160:635)",
        {
            "magnitude": Uniform(5.5, 7.5),
            "distance_km": LogUniform(10.0, 80.0),
            "stress_drop_bar": Lognormal(30.0, 300.0, median=100.0, deviation=0.5),
            "kappa_s": Uniform(0.02, 0.06),
        },
        _source,
    ),
    Family(
        "pulse-like",
        "motions near a fault: one long pulse of velocity within ordinary shaking",
        "pulse of Mavroeidis & Papageorgiou (2003) on " + _FILTERED,
        _FIRM
        | {
            "pulse_velocity_m_s": Lognormal(0.2, 1.8, median=0.6, deviation=0.4),
            "pulse_period_s": Lognormal(0.5, 6.0, median=2.0, deviation=0.5),
            "pulse_cycles": Uniform(1.0, 2.5),
            "pulse_phase_rad": Uniform(0.0, 2.0 * math.pi),
        },
        _pulse_like,
    ),
)
