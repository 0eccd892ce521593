"""What a resolved impact costs: one with its history, ten thousand at once, and the same by SciPy.

Run it alone: ``python -m benchmarks.bed [COUNT]``. Times are CPU times of this process, medians of repeats.
"""

import math
import statistics
import sys
import time
from collections.abc import Callable

import numpy as np

from rocking.bodies import Block
from rocking.dynamics.bed import ContactBed, Coulomb, HuntCrossley, KelvinVoigt, bed_impact, bed_impacts, setup_of
from rocking.dynamics.bed.tables import Setup

POINTS = 41


def median_cpu(work: Callable[[], object], repeats: int) -> float:
    times = []
    for _ in range(repeats):
        begin = time.process_time()
        work()
        times.append(time.process_time() - begin)
    return statistics.median(times)


def random_setups(count: int, kind: str, seed: int = 1) -> list[Setup]:
    random = np.random.default_rng(seed)
    setups = []
    for _ in range(count):
        ratio, width = random.uniform(1.2, 8.0), 10 ** random.uniform(-1.0, 0.3)
        block = Block(width=width, height=width * ratio)
        if kind == "hunt-crossley":
            law: KelvinVoigt | HuntCrossley = HuntCrossley(block.mass * 10 ** random.uniform(6.0, 9.0), viscosity=1.0)
        else:
            frequency = 2.0 * math.pi * 10 ** random.uniform(1.5, 3.0)
            law = KelvinVoigt(block.mass * frequency**2, damping_ratio=10 ** random.uniform(-0.5, 0.5))
        bed = ContactBed.uniform(block, POINTS, law, friction=Coulomb(random.uniform(0.3, 1.0)))
        setups.append(setup_of(block, bed, rotation=random.uniform(0.1, 0.8) * math.atan(1.0 / ratio)))
    return setups


def main(count: int = 10_000) -> None:
    block = Block(width=0.2, height=0.4)
    law = KelvinVoigt(block.mass * (2.0 * math.pi * 400.0) ** 2, damping_ratio=1.0)
    bed = ContactBed.uniform(block, POINTS, law)
    fast = median_cpu(lambda: bed_impact(block, bed, angular_velocity=1.0), 21)
    slow = median_cpu(lambda: bed_impact(block, bed, angular_velocity=1.0, engine="reference", tolerance=1e-6), 1)
    print(f"one impact, {POINTS} points, with its history: {1e3 * fast:.2f} ms; SciPy {slow / fast:.0f} times that")
    for kind in ("kelvin-voigt", "hunt-crossley"):
        setups = random_setups(count, kind)
        begin = time.process_time()
        impacts = bed_impacts(setups)
        spent = time.process_time() - begin
        audit = np.abs(impacts.audit)
        print(
            f"{count} impacts, {kind}, {POINTS} points, one core: {spent:.1f} s, {1e3 * spent / count:.2f} ms each, "
            f"{np.mean(impacts.counts[:, 1]):.0f} steps; audit median {np.median(audit):.0e}, worst {audit.max():.0e}; "
            f"{np.isnan(impacts.coefficient).sum()} failed"
        )


if __name__ == "__main__":
    main(*(int(argument) for argument in sys.argv[1:]))
