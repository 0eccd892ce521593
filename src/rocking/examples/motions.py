"""Motions to try things with: synthetic records by seed, none of them of a real earthquake."""

from rocking.conventions import g
from rocking.motions.filters import highpassed
from rocking.motions.motion import GroundMotion
from rocking.motions.processing import scaled_to
from rocking.motions.pulses import mavroeidis_papageorgiou, ricker
from rocking.motions.synthetic import (
    Envelope,
    KanaiTajimi,
    NonstationaryFilter,
    PointSource,
    kanai_tajimi_motion,
    modulation_from_intensity,
    nonstationary_motion,
    point_source_motion,
    with_pulse,
)

FILTERED = "modulated filtered white noise (Rezaeian & Der Kiureghian 2008)"


def near_fault(seed: int) -> GroundMotion:
    """Return one pulse of velocity, 0.9 m/s in 1.2 s, within shaking of higher frequencies."""
    pulse = mavroeidis_papageorgiou(velocity=0.9, period=1.2, cycles=1.5, phase=0.5)
    return with_pulse(_shaking(seed, length=9.0, frequency=5.0, corner=1.0 / 1.2), pulse, arrival=5.0)


def far_field(seed: int) -> GroundMotion:
    """Return magnitude 6.8 at 40 km, scaled to 0.35 g."""
    return _to(0.35, point_source_motion(PointSource(magnitude=6.8, distance=40e3), seed=seed))


def long(seed: int) -> GroundMotion:
    """Return a minute of strong shaking, scaled to 0.35 g."""
    return _to(0.35, _shaking(seed, length=60.0, frequency=3.0, corner=0.1))


def soft_soil(seed: int) -> GroundMotion:
    """Return a layer that swings at 0.8 Hz, scaled to 0.35 g."""
    layer, envelope = KanaiTajimi(0.01, frequency=0.8, damping=0.25), Envelope(3.0, 12.0, 0.25)
    raw = kanai_tajimi_motion(layer, envelope, seed=seed, time_step=0.02, duration=45.0)
    what = "high-passed by a critically damped oscillator of 0.1 Hz"
    return _to(0.35, raw.changed(what, acceleration=highpassed(raw.acceleration, raw.time_step, 0.1)))


def three_components(seed: int) -> dict[str, GroundMotion]:
    """Return x and y alike, 0.4 g and 0.35 g, and z of higher frequency, 0.2 g."""
    # no seed shares a component with another
    parts = {"x": (0.4, 3.0), "y": (0.35, 3.0), "z": (0.2, 8.0)}
    return {
        axis: _to(peak, _shaking(3 * seed + k, length=12.0, frequency=frequency, corner=0.15))
        for k, (axis, (peak, frequency)) in enumerate(parts.items())
    }


def pulse() -> GroundMotion:
    """Return 0.5 g at the middle of 1 s, nothing else."""
    return ricker(amplitude=0.5 * g, period=1.0).sampled(0.005)


def _shaking(seed: int, length: float, frequency: float, corner: float) -> GroundMotion:
    """Return filtered noise; length: significant duration [s]; frequency: at its middle, corner: of a filter [Hz]."""
    middle = 0.6 * length
    modulation = modulation_from_intensity(1.0, length, middle)
    shaper = NonstationaryFilter(frequency, slope=-0.3 * frequency / length, middle=middle, damping=0.3)
    duration = round(modulation.time_of(0.999) + 2.0 / corner, 1)
    return nonstationary_motion(modulation, shaper, seed=seed, duration=duration, corner=corner)


def _to(share: float, motion: GroundMotion) -> GroundMotion:
    return scaled_to(motion, "pga", share * g)
