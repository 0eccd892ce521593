"""What shakes: records, pulses, synthetic motions, and what is measured on them."""

from typing import TYPE_CHECKING

from rocking.lazy import exports
from rocking.motions.segments import Segments as Segments  # what engines integrate

if TYPE_CHECKING:
    from rocking.motions import pulses as pulses
    from rocking.motions import synthetic as synthetic
    from rocking.motions.components import rotated as rotated
    from rocking.motions.components import rotd_pga as rotd_pga
    from rocking.motions.components import with_vertical as with_vertical
    from rocking.motions.flatfiles import Flatfile as Flatfile
    from rocking.motions.flatfiles import flatfile as flatfile
    from rocking.motions.integrals import arias_intensity as arias_intensity
    from rocking.motions.integrals import ground_displacement as ground_displacement
    from rocking.motions.integrals import ground_velocity as ground_velocity
    from rocking.motions.integrals import peak_ground_displacement as peak_ground_displacement
    from rocking.motions.integrals import peak_ground_velocity as peak_ground_velocity
    from rocking.motions.integrals import significant_duration as significant_duration
    from rocking.motions.integrals import significant_times as significant_times
    from rocking.motions.intensity import IntensityMeasure as IntensityMeasure
    from rocking.motions.intensity import Measure as Measure
    from rocking.motions.intensity import RockingScale as RockingScale
    from rocking.motions.intensity import cumulative_absolute_velocity as cumulative_absolute_velocity
    from rocking.motions.intensity import housner_intensity as housner_intensity
    from rocking.motions.intensity import intensity_measures as intensity_measures
    from rocking.motions.intensity import measure as measure
    from rocking.motions.intensity import measures as measures
    from rocking.motions.intensity import normalised_acceleration as normalised_acceleration
    from rocking.motions.intensity import normalised_velocity as normalised_velocity
    from rocking.motions.intensity import peak_ground_acceleration as peak_ground_acceleration
    from rocking.motions.intensity import spectral_acceleration as spectral_acceleration
    from rocking.motions.intensity import spectral_measure as spectral_measure
    from rocking.motions.motion import GroundMotion as GroundMotion
    from rocking.motions.pipeline import processed as processed
    from rocking.motions.processing import bandpassed as bandpassed
    from rocking.motions.processing import demeaned as demeaned
    from rocking.motions.processing import detrended as detrended
    from rocking.motions.processing import padded as padded
    from rocking.motions.processing import resampled as resampled
    from rocking.motions.processing import scaled_to as scaled_to
    from rocking.motions.processing import tapered as tapered
    from rocking.motions.processing import trimmed as trimmed
    from rocking.motions.processing import trimmed_to_significant as trimmed_to_significant
    from rocking.motions.pulse import Pulse as Pulse
    from rocking.motions.selection import selected as selected
    from rocking.motions.spectrum import ResponseSpectrum as ResponseSpectrum
    from rocking.motions.spectrum import fourier_amplitudes as fourier_amplitudes
    from rocking.motions.spectrum import response_spectrum as response_spectrum
    from rocking.motions.spectrum import rotd_spectrum as rotd_spectrum
    from rocking.motions.target_spectra import target_spectrum as target_spectrum
else:
    __all__, __getattr__, __dir__ = exports(__name__)
