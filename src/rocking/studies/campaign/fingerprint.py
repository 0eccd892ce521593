"""The last digits of an engine: which bits it computes at this place, in sixteen hexadecimal digits."""

import hashlib
from functools import cache

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics import engine
from rocking.dynamics.batch import Batch, Rows
from rocking.dynamics.engine import RESULTS
from rocking.dynamics.impact_law import ConstantRestitution, ImpactLaw, RandomRestitution, SpeedRestitution
from rocking.dynamics.settings import Settings
from rocking.motions.segments import Segments
from rocking.studies.histories import Histories

LAST_DIGITS = "another processor, build or ROCKING_ISA"
"""What may make an engine compute other last digits."""

_EACH = 16
_OF_REFERENCE = 4


def engine_of(histories: Histories) -> str:
    """Return the engine that computes histories here, with the last digits that it gives.

    Returns as in ``fast, 0123456789abcdef``: engines of the same words give the same bits, whatever the machine.
    """
    chosen = engine.chosen(histories.engine, histories.law)
    return f"{chosen}, {_fingerprint(chosen, engine.instruction_set() if chosen == 'fast' else '')}"


def kind_of(name: str) -> str:
    """Return which engine it is, whatever its last digits."""
    return name.partition(", ")[0]


@cache
def _fingerprint(chosen: str, instruction_set: str) -> str:
    """Hash the results of a few histories; the instruction set is what the cache tells engines apart by."""
    made = hashlib.sha256()
    count = _EACH if chosen == "fast" else _OF_REFERENCE
    for motions, law, settings in _batches():
        results = Batch(motions, law, settings, 1, chosen).run(count, lambda first, last: _rows(count))[0]
        for name, kind in RESULTS.items():
            made.update(np.ascontiguousarray(results[name], np.dtype(kind).newbyteorder("<")).tobytes())
    return made.hexdigest()[:16]


def _batches() -> list[tuple[list[Segments], ImpactLaw, Settings]]:
    """Pulses and records, with and without a vertical part, all laws, both kinds of equations, all orders."""
    quantiles = {"right": np.arange(33) / 256.0 + 0.8125, "left": np.arange(33) / 512.0 + 0.875}
    by_speed = SpeedRestitution(np.array([0.0, 1.0, 4.0]), np.array([1.0, 0.9375, 0.75]))
    drawn = RandomRestitution(quantiles, 7)
    plain, linear = Settings(gravity=9.8125), Settings(gravity=9.8125, linear=True)
    return [
        (_pulses(), drawn, plain),
        (_records(vertical=False), ConstantRestitution(), Settings(gravity=9.8125, order=6)),
        (_records(vertical=True), by_speed, plain),
        (_pulses(), by_speed, linear),
    ]


def _pulses() -> list[Segments]:
    """Waves of parabolas: four stretches up, four down; of fractions that every machine has to the last bit."""
    bump = np.array([0.0, 4.0, -4.0, 0.5, -0.5, 0.0, 0.25, -0.25])
    waves = np.array([1.0, -1.0, 1.0, -1.0])[:, None] * bump
    return [Segments(step, size * waves) for size, step in ((2.0, 0.25), (6.0, 0.25), (12.0, 0.5), (3.0, 0.75))]


def _records(*, vertical: bool) -> list[Segments]:
    """Shaking by remainders of whole numbers, which look like noise and are the same everywhere."""
    return [
        Segments.between_samples(0.03125, _noise(37 + k, size), _noise(91 + k, 0.25 * size) if vertical else None)
        for k, size in enumerate((2.0, 6.0, 12.0, 3.0))
    ]


def _noise(factor: int, size: float) -> FloatArray:
    number = np.arange(96)
    return np.asarray(size * ((number * number * factor + 11 * number) % 101 - 50) / 64.0, np.float64)


def _rows(count: int) -> Rows:
    """Bodies from squat to slender, one of which no engine can take."""
    k = np.arange(_EACH)[-count:]
    alpha = 0.0625 + 0.03125 * (k * 5 % 13)
    values = {
        "alpha_right": alpha, "alpha_left": 0.75 * alpha + 0.03125, "p_right": 1.0 + 0.25 * (k * 7 % 16),
        "p_left": 1.125 + 0.25 * (k * 7 % 16), "r_right": 0.75 + k / 128.0, "r_left": 0.875 - k / 128.0,
        "q_right": 0.5 + k / 128.0, "q_left": 0.75 - k / 128.0,
        "share_right": 1.0 - k / 64.0, "share_left": 0.5 + k / 64.0,
        "scale": np.where(k == _EACH - 1, np.nan, 0.5 + k / 16.0), "rotation": np.where(k % 5 == 4, 0.03125, 0.0),
    }  # fmt: skip
    return Rows.of(count, k % 4, k, **values)
