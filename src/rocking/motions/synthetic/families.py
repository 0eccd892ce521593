"""Families of synthetic motions: a generator, and a distribution for each of its parameters.

The distributions are round numbers chosen by the authors of this package so that the motions look like records of
strong shaking of the kind that a family is named for. They are illustrative ranges. They are not fits to records, not
the regressions on magnitude, distance and site of the papers whose generators they feed, and not a hazard model:
scale the motions to the level that a hazard model gives.
"""

import math
from collections.abc import Mapping

from rocking import checks
from rocking.motions.motion import GroundMotion
from rocking.motions.pulses import mavroeidis_papageorgiou
from rocking.motions.synthetic.distributions import Distribution, Lognormal, LogUniform, Uniform
from rocking.motions.synthetic.family import Family
from rocking.motions.synthetic.kanai_tajimi import Envelope, KanaiTajimi, kanai_tajimi_motion
from rocking.motions.synthetic.modulation import modulation_from_intensity
from rocking.motions.synthetic.oscillator import highpassed
from rocking.motions.synthetic.point_source import PointSource, point_source_motion
from rocking.motions.synthetic.pulse_like import with_pulse
from rocking.motions.synthetic.stochastic import NonstationaryFilter, nonstationary_motion


def families() -> dict[str, Family]:
    """Return every family.

    Returns
    -------
    dict of str to Family
        By name; a copy.

    Examples
    --------
    >>> list(families())
    ['firm-ground', 'soft-ground', 'kanai-tajimi', 'point-source', 'pulse-like']
    """
    return {one.name: one for one in _ALL}


def family(which: str | Family) -> Family:
    """Return a family by its name.

    Parameters
    ----------
    which : str or Family
        Name as in `families`; a family is returned as it is.

    Returns
    -------
    Family
        The family.

    Raises
    ------
    InvalidValueError
        If there is no such family.
    """
    if isinstance(which, Family):
        return which
    known = families()
    return known[checks.one_of("family", which, known)]


def _stochastic(drawn: Mapping[str, float], seed: int, step: float, corner: float) -> GroundMotion:
    length = drawn["significant_duration_s"]
    middle = drawn["middle_over_duration"] * length
    modulation = modulation_from_intensity(drawn["arias_intensity_m_s"], length, middle)
    shaper = NonstationaryFilter(
        drawn["frequency_hz"], drawn["slope_hz_s"], middle, drawn["damping"], lowest=0.2 * drawn["frequency_hz"]
    )
    # the high pass needs about two of its periods to come to rest
    duration = round(modulation.time_of(0.999) + 2.0 / corner, 9)
    return nonstationary_motion(modulation, shaper, seed=seed, time_step=step, duration=duration, corner=corner)


def _nonstationary(drawn: Mapping[str, float], seed: int, step: float) -> GroundMotion:
    return _stochastic(drawn, seed, step, drawn["corner_hz"])


def _layer(drawn: Mapping[str, float], seed: int, step: float) -> GroundMotion:
    layer = KanaiTajimi(drawn["density_m2_s3"], drawn["frequency_hz"], drawn["damping"])
    rise, plateau = drawn["rise_s"], drawn["plateau_s"]
    envelope = Envelope(rise, rise + plateau, drawn["decay_1_s"])
    corner = drawn["corner_hz"]
    duration = rise + plateau + 3.0 / drawn["decay_1_s"] + 2.0 / corner
    raw = kanai_tajimi_motion(layer, envelope, seed=seed, time_step=step, duration=duration)
    what = f"high-passed by a critically damped oscillator of {corner!r} Hz"
    return raw.changed(what, acceleration=highpassed(raw.acceleration, raw.time_step, corner))


def _source(drawn: Mapping[str, float], seed: int, step: float) -> GroundMotion:
    source = PointSource(
        magnitude=drawn["magnitude"],
        distance=1e3 * drawn["distance_km"],
        stress_drop=1e5 * drawn["stress_drop_bar"],
        kappa=drawn["kappa_s"],
    )
    return point_source_motion(source, seed=seed, time_step=step)


def _pulse_like(drawn: Mapping[str, float], seed: int, step: float) -> GroundMotion:
    period, cycles = drawn["pulse_period_s"], drawn["pulse_cycles"]
    pulse = mavroeidis_papageorgiou(drawn["pulse_velocity_m_s"], period, cycles, drawn["pulse_phase_rad"])
    # below the frequency of the pulse the motion shall be the pulse
    residual = _stochastic(drawn, seed, step, 1.0 / period)
    middle = drawn["middle_over_duration"] * drawn["significant_duration_s"]
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
