"""What shakes: records, pulses, synthetic motions, and what is measured on them."""

from typing import TYPE_CHECKING

from rocking.lazy import exports
from rocking.motions import pulses, synthetic
from rocking.motions.components import rotated, rotd_pga, with_vertical
from rocking.motions.integrals import (
    arias_intensity,
    ground_displacement,
    ground_velocity,
    peak_ground_displacement,
    peak_ground_velocity,
    significant_duration,
    significant_times,
)
from rocking.motions.intensity import (
    IntensityMeasure,
    Measure,
    RockingScale,
    cumulative_absolute_velocity,
    housner_intensity,
    intensity_measures,
    measure,
    measures,
    normalised_acceleration,
    normalised_velocity,
    peak_ground_acceleration,
    spectral_acceleration,
    spectral_measure,
)
from rocking.motions.motion import GroundMotion
from rocking.motions.processing import (
    bandpassed,
    demeaned,
    detrended,
    padded,
    resampled,
    scaled_to,
    tapered,
    trimmed,
    trimmed_to_significant,
)
from rocking.motions.pulse import Pulse
from rocking.motions.segments import Segments as Segments  # what engines integrate
from rocking.motions.spectrum import ResponseSpectrum, response_spectrum

if TYPE_CHECKING:
    from rocking.motions.flatfiles import Flatfile, flatfile
    from rocking.motions.fourier import fourier_amplitudes
    from rocking.motions.pipeline import processed
    from rocking.motions.rotd import rotd_spectrum
    from rocking.motions.selection import Selection, selected
    from rocking.motions.target_spectra import TargetSpectrum, target_spectrum

__all__ = [
    "Flatfile",
    "GroundMotion",
    "IntensityMeasure",
    "Measure",
    "Pulse",
    "ResponseSpectrum",
    "RockingScale",
    "Selection",
    "TargetSpectrum",
    "arias_intensity",
    "bandpassed",
    "cumulative_absolute_velocity",
    "demeaned",
    "detrended",
    "flatfile",
    "fourier_amplitudes",
    "ground_displacement",
    "ground_velocity",
    "housner_intensity",
    "intensity_measures",
    "measure",
    "measures",
    "normalised_acceleration",
    "normalised_velocity",
    "padded",
    "peak_ground_acceleration",
    "peak_ground_displacement",
    "peak_ground_velocity",
    "processed",
    "pulses",
    "resampled",
    "response_spectrum",
    "rotated",
    "rotd_pga",
    "rotd_spectrum",
    "scaled_to",
    "selected",
    "significant_duration",
    "significant_times",
    "spectral_acceleration",
    "spectral_measure",
    "synthetic",
    "tapered",
    "target_spectrum",
    "trimmed",
    "trimmed_to_significant",
    "with_vertical",
]

# of sets of records, which a response does not need
_HOMES = {
    "flatfiles": ("Flatfile", "flatfile"),
    "fourier": ("fourier_amplitudes",),
    "pipeline": ("processed",),
    "rotd": ("rotd_spectrum",),
    "selection": ("Selection", "selected"),
    "target_spectra": ("TargetSpectrum", "target_spectrum"),
}

__getattr__, _ = exports(__name__, {name: f"{__name__}.{home}" for home, names in _HOMES.items() for name in names})


def __dir__() -> list[str]:
    return __all__
