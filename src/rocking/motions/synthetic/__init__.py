"""Synthetic ground motions: stochastic models with random seeds."""

from rocking.motions.synthetic.distributions import Lognormal, LogUniform, Uniform
from rocking.motions.synthetic.families import Family, families, family, with_pulse
from rocking.motions.synthetic.kanai_tajimi import Envelope, KanaiTajimi, kanai_tajimi_motion
from rocking.motions.synthetic.point_source import PointSource, point_source_motion
from rocking.motions.synthetic.stochastic import (
    GammaModulation,
    NonstationaryFilter,
    modulation_from_intensity,
    nonstationary_motion,
)

__all__ = [
    "Envelope",
    "Family",
    "GammaModulation",
    "KanaiTajimi",
    "LogUniform",
    "Lognormal",
    "NonstationaryFilter",
    "PointSource",
    "Uniform",
    "families",
    "family",
    "kanai_tajimi_motion",
    "modulation_from_intensity",
    "nonstationary_motion",
    "point_source_motion",
    "with_pulse",
]
