"""A motion in plain values, SI units: what it is, its intensity measures and its response spectrum."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from rocking.motions.intensity import Measure, intensity_measures, key_with_unit
from rocking.motions.motion import GroundMotion
from rocking.motions.pulse import Pulse
from rocking.motions.spectrum import ResponseSpectrum, response_spectrum
from rocking.plots.traces import Traces, fine_samples, traces


@dataclass(frozen=True, slots=True)
class MotionAnswer:
    """One motion and what was measured on it."""

    motion: GroundMotion | Pulse
    samples: GroundMotion  # itself, or the pulse cut finely
    measures: dict[str, Measure]  # intensity measures by short name
    spectrum: ResponseSpectrum  # response at the periods asked for

    @classmethod
    def of(cls, motion: GroundMotion | Pulse, periods: Sequence[float], damping: float) -> "MotionAnswer":
        """Measure a motion, with a spectrum at some periods [s] for a damping ratio from 0 to below 1 [-]."""
        samples = fine_samples(motion)
        spectrum = response_spectrum(samples, list(periods), damping)
        return cls(motion, samples, measures_of(motion, samples), spectrum)


def measures_of(
    motion: GroundMotion | Pulse, samples: GroundMotion, curves: Traces | None = None
) -> dict[str, Measure]:
    """Return the intensity measures of a motion; those of a pulse that its formulas give come from these."""
    measures = intensity_measures(samples)
    if not isinstance(motion, Pulse):
        return measures
    # these three are known from the formulas, not only from samples
    peaks = (traces(motion) if curves is None else curves).peaks
    exact = {f"pg{name[0]}": abs(value) for name, (_, value) in peaks.items()}
    return measures | {key: replace(measures[key], value=value) for key, value in exact.items()}


def motion_facts(motion: GroundMotion | Pulse, samples: GroundMotion, measures: dict[str, Measure]) -> dict[str, Any]:
    """Return what a motion is and how strong."""
    record = isinstance(motion, GroundMotion)
    metadata = motion.metadata if isinstance(motion, GroundMotion) else {}
    return {
        "kind": "record" if record else "pulse",
        "name": motion.name,
        **{key: metadata.get(key) for key in ("format", "event", "station", "component")},
        "vertical_component": metadata.get("vertical component"),
        "file_unit": metadata.get("unit"),
        "samples": len(samples) if record else None,
        "time_step_s": samples.time_step if record else None,
        "duration_s": motion.duration,
        "warnings": list(motion.doubts),
        "provenance": list(motion.provenance) if isinstance(motion, GroundMotion) else [repr(motion)],
        "peak_vertical_acceleration_m_s2": None if samples.vertical is None else samples.peak_vertical,
        "intensity": {key_with_unit(key, one.unit): one.value for key, one in measures.items()},
    }


def spectrum_facts(spectrum: ResponseSpectrum) -> dict[str, Any]:
    """Return a response spectrum."""
    return {
        "damping_ratio": spectrum.damping,
        "period_s": spectrum.periods.tolist(),
        "psa_m_s2": spectrum.pseudo_acceleration.tolist(),
        "psv_m_s": spectrum.pseudo_velocity.tolist(),
        "sd_m": spectrum.displacement.tolist(),
        "absolute_acceleration_m_s2": spectrum.absolute_acceleration.tolist(),
    }
