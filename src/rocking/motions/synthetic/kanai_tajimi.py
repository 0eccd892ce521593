"""Kanai-Tajimi motions: white noise at the bedrock, filtered by a soil layer and multiplied by an envelope."""

import math
from dataclasses import dataclass

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.motions.filters import exponential, recurrence, transition
from rocking.motions.motion import GroundMotion
from rocking.motions.synthetic.sampling import described, normals, times

MIN_PHASE = 1e-3  # smallest phase of the filter in one step [rad], to limit rounding errors of the covariance


@dataclass(frozen=True)
class KanaiTajimi:
    """Soil layer as an oscillator under white noise.

    Parameters
    ----------
    density : float
        Two-sided power spectral density S0 of the noise over circular frequency [m2/s3 per rad].
    frequency : float
        Natural frequency of the layer [Hz]. The default 2.5 Hz (5 pi rad/s) is usual for firm ground.
    damping : float
        Damping ratio of the layer, between 0 and 1 [-]. The default 0.6 is usual.
    """

    density: float
    frequency: float = 2.5
    damping: float = 0.6

    def __post_init__(self) -> None:
        object.__setattr__(self, "density", checks.positive("density", self.density, "m2/s3"))
        object.__setattr__(self, "frequency", checks.positive("frequency", self.frequency, "Hz"))
        damping = checks.within("damping", self.damping, 0.0, 1.0, open_low=True, open_high=True)
        object.__setattr__(self, "damping", damping)

    @property
    def variance(self) -> float:
        """Stationary variance of the acceleration, ``pi S0 w (1 + 4 z^2) / (2 z)`` [m2/s4]."""
        omega = 2.0 * math.pi * self.frequency
        return math.pi * self.density * omega * (1.0 + 4.0 * self.damping**2) / (2.0 * self.damping)  # Eq. 164

    def power(self, frequency: FloatArray) -> FloatArray:
        """Return the power spectral density of the acceleration.

        Parameters
        ----------
        frequency : ndarray
            Frequencies [Hz].

        Returns
        -------
        ndarray
            Two-sided spectral density over circular frequency [m2/s3 per rad].
        """
        ratio = (frequency / self.frequency) ** 2
        coupling = 4.0 * self.damping**2 * ratio
        return self.density * (1.0 + coupling) / ((1.0 - ratio) ** 2 + coupling)  # Eq. 163


@dataclass(frozen=True)
class Envelope:
    """Envelope with parabolic rise, plateau and exponential decay (Jennings, Housner & Tsai 1968).

    Parameters
    ----------
    rise : float
        End of the parabola [s]; zero for no parabola.
    plateau : float
        End of the plateau [s], not before the end of the parabola.
    decay : float
        Decay rate after the plateau [1/s]; zero for no decay.

    Examples
    --------
    >>> Envelope(2.0, 4.0, 1.0)(np.array([0.0, 1.0, 3.0, 4.0])).tolist()
    [0.0, 0.25, 1.0, 1.0]
    """

    rise: float = 2.0
    plateau: float = 10.0
    decay: float = 0.3

    def __post_init__(self) -> None:
        object.__setattr__(self, "rise", checks.within("rise", self.rise, 0.0, math.inf, unit="s"))
        plateau = checks.within("plateau", self.plateau, self.rise, math.inf, unit="s", hint="not before the rise")
        object.__setattr__(self, "plateau", plateau)
        object.__setattr__(self, "decay", checks.within("decay", self.decay, 0.0, math.inf, unit="1/s"))

    def __call__(self, time: FloatArray) -> FloatArray:
        """Return the factor, from 0 to 1, at times >= 0."""
        up = np.minimum(time / self.rise, 1.0) ** 2 if self.rise > 0.0 else np.ones_like(time)
        return up * exponential(-self.decay * np.maximum(time - self.plateau, 0.0))  # Eq. 165


def kanai_tajimi_motion(
    layer: KanaiTajimi,
    envelope: Envelope | None = None,
    *,
    seed: int,
    time_step: float = 0.01,
    duration: float = 20.0,
) -> GroundMotion:
    """Return one synthetic motion.

    The layer is stationary from the start. The recurrence and the covariance of the noise within a step are exact, so
    that the samples have the closed-form variance for any time step. The model has power at zero frequency. Therefore,
    velocity and displacement drift. `bandpassed` or `detrended` removes the drift.

    Parameters
    ----------
    layer : KanaiTajimi
        Soil layer and the noise below it.
    envelope : Envelope, optional
        Factor over time. The default is `Envelope()`.
    seed : int
        Random seed; equal seeds give equal bits [-].
    time_step : float
        Time step between samples [s].
    duration : float
        Duration of the motion [s].

    Returns
    -------
    GroundMotion
        Motion with its parameters as metadata.

    Raises
    ------
    InvalidValueError
        If a parameter is outside its range, or the time step is too short or too long for the layer.

    Examples
    --------
    >>> motion = kanai_tajimi_motion(KanaiTajimi(density=0.01), seed=7, duration=5.0)
    >>> len(motion), motion.metadata["layer.density"]
    (501, '0.01')
    """
    envelope = Envelope() if envelope is None else envelope
    time = times(time_step, duration)
    step = float(time[1])
    omega = 2.0 * math.pi * layer.frequency
    if not MIN_PHASE <= omega * step < math.pi:
        low, high = MIN_PHASE / omega, math.pi / omega
        raise InvalidValueError(
            "time_step must be in [{low:g}, {high:g}) s for this layer, got {step:g}", low=low, high=high, step=step
        )
    acceleration = envelope(time) * _stationary(layer, omega, step, normals(seed, time.size, 2))
    parameters = described(layer=layer, envelope=envelope, seed=int(seed), time_step=step, duration=duration)
    line = f"simulated: Kanai-Tajimi filtered white noise under an envelope, seed {seed}"
    return GroundMotion(
        acceleration, step, name=f"synthetic, Kanai-Tajimi, seed {seed}", metadata=parameters, provenance=(line,)
    )


def _stationary(layer: KanaiTajimi, omega: float, step: float, kicks: FloatArray) -> FloatArray:
    # displacement is multiplied by omega, so that both states have equal variance and no correlation
    zeta = layer.damping
    deviation = math.sqrt(math.pi * layer.density / (2.0 * zeta * omega))
    move = transition(omega, zeta, step) * np.array([[1.0, omega], [1.0 / omega, 1.0]])
    (m00, m01), (m10, m11) = move.tolist()
    # Cholesky factor of the covariance that a step adds: identity - move move^T
    s00 = math.sqrt(1.0 - (m00 * m00 + m01 * m01))  # Eq. 166
    s10 = -(m00 * m10 + m01 * m11) / s00
    s11 = math.sqrt(1.0 - (m10 * m10 + m11 * m11) - s10 * s10)
    first, second = deviation * kicks.T
    added = s00 * first[1:], s10 * first[1:] + s11 * second[1:]
    z, v = recurrence(move, (float(first[0]), float(second[0])), *added)
    return -omega * (z + 2.0 * zeta * v)
