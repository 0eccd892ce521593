"""Constants of the detection of impacts in sounds: name, value, meaning, unit, reason."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class SoundConstants:
    """Constants of `rocking.identification.readers.sound`.

    The reason "development" means a choice with the development rooms (seeds 10000 to 10059, 20000 to 20119), without a
    derivation. All other reasons are in the theory manual (Eq. 317, 318, 323), or state the effect of the value.
    "Position" is the time at which a click has the best match with the other clicks of its foot.
    """

    # alignment of the clicks of one foot
    before: float = (
        0.004  # start of a click before its position [s]; first detections are accurate to some milliseconds
    )
    after: float = 0.030  # end of a click in comparisons of shape and level [s]; development
    long_after: float = 0.060  # end of a click in alignments [s]; longer than `after` for modes with slow decay
    reach: float = (
        0.012  # largest shift of a click from its first detection [s]; 12 ms is also the tolerance of the tests
    )
    equalisation: float = (
        0.1  # noise added to the spectrum of clicks in the sharpening filter / clicks [-]; development
    )
    rounds: int = 6  # largest number of rounds of an alignment [-]; an alignment without changes ends earlier
    peaks: int = 10  # number of other positions that are tried per click [-]; development
    peak_distance: float = 5e-4  # smallest distance of another position [s]; less than one period of a mode
    rival_distance: float = 2e-3  # smallest distance of a rival position [s]; a period of a mode is some milliseconds
    rival_margin: float = (
        0.25  # smallest log likelihood ratio to a rival [-]; clicks with nearly equal rivals are excluded
    )
    fewest_values: float = 25.0  # N in Eq. 317; smallest N of a single click [-]; reason: development
    most_values: float = 60.0  # largest N of a single click in Eq. 317 [-]; limits the weight of a good match
    law_tail: float = 10.0  # degrees of freedom of the law in Eq. 317 [-]; heavy tail against single wrong times
    law_tolerance: float = 3e-3  # tolerance of the time between feet in Eq. 317 [s]; `onsets` finds this time later

    # time difference of the feet, Eq. 318
    # start of an averaged click before its position [s]; this interval also gives the noise power
    mode_noise: float = 0.012
    # end of an averaged click after its position [s]; frequency resolution 9 Hz = 1 / (0.012 s + 0.100 s)
    mode_decay: float = 0.100
    mode_band: tuple[float, float] = (
        150.0,
        9_000.0,
    )  # band of compared modes [Hz]; the lowest frequency of `clicks.py`
    subtracted_noise: float = (
        2.0  # subtracted noise / mean noise power [-]; 14 % (e^-2) of noise bins exceed this power
    )
    largest_foot_lag: float = 0.010  # largest correction of the time between feet [s]; 3.4 m of path at 2.9 ms per m
    foot_lag_step: float = 1e-5  # step of tried corrections [s]; small compared with the required RMS error of 0.15 ms
    agreement_weight: float = 30.0  # weight of agreeing modes [-]; maximum likelihood in 207 rooms at 8 dB
    largest_law_misfit: float = 30.0  # largest misfit of the law [-]; limits the influence of a single wrong time
    onset_failure: float = 0.05  # p0: density if both onsets are wrong [1/s]; keeps every time possible

    # onset of the mean click of one foot; times relative to its position [s]
    noise_start: float = -0.026  # start of the noise; 12 ms of noise until `analysis_start`
    analysis_start: float = -0.014  # start of the likelihood; 4 ms of noise before the earliest onset
    onset_earliest: float = -0.010  # earliest onset; a mode with slow growth has its best match late
    onset_latest: float = 0.004  # latest onset; equal to `before`
    analysis_end: float = 0.006  # end of the likelihood; 2 ms of click after the latest onset
    decay_end: float = 0.030  # end of the click for its spectrum; equal to `after`
    onset_step: float = (
        9e-5  # step of onsets [s]; 4 samples at 44.1 and 48 kHz, below the required RMS error of 0.15 ms
    )
    prediction_order: int = 6  # order of the prediction of noise [-]; three resonances of hum and echoes
    push_durations: tuple[float, ...] = (
        3e-4,
        8e-4,
    )  # w: durations of the impact [s], equally probable
    click_powers: tuple[float, ...] = tuple(
        np.geomspace(0.5, 500.0, 6).tolist()
    )  # ratios of click to noise [-]; -3 to 27 dB in steps of 6 dB

    # missed and false impacts, Eq. 323
    first_revised: int = 5  # first number of a revised impact [-]; earlier impacts give the law and the mean click
    search_range: float = 0.15  # largest deviation from the expected time / interval [-]; 4.3 deviations of 0.035
    noise_range: float = 0.040  # smallest half width of the neighbourhood with the noise level [s]; development
    loudness_ratio: float = 0.75  # level of an impact, relative to the last impact of its foot [-]; mean of 119 rooms
    loudness_scatter: float = 0.25  # standard deviation of `loudness_ratio` divided by its value [-]; 119 rooms
    noise_tail: float = (
        8.0  # degrees of freedom of noise and echoes [-]; heavy tail: echoes are louder than normal noise
    )

    # acceptance of a sound, and warnings
    smallest_similarity: float = (
        0.45  # smallest correlation [-]; 80 bodies have at least 0.69 at 8 dB, speech at most 0.24
    )
    fewest_times: int = 4  # smallest number of certain times [-]; the law needs three intervals
    largest_clipped: float = 1.0 / 3.0  # largest clipped fraction of a sound [-]; hum that clips hides the clicks
    neutral_contrast: float = (
        3.2  # contrast of a click that is an impact or noise with equal likelihood [-]; development
    )
    contrast_power: float = 5.0  # decrease of the contrasts of noise and echoes, as a power [-]; development
    revised_contrast: float = 3.0  # contrast of an impact detected only by its similarity [-]; slightly below neutral
    # largest standard deviation of the time difference of the feet without a warning [s]; the RMS error in 116 rooms is
    # 0.3 ms if the time difference is from the distributions of the onsets alone
    doubtful_foot_lag: float = 3e-4
    picture_pieces: int = 2000  # number of points of the sound in pictures [-]; enough for a picture


SOUND = SoundConstants()
