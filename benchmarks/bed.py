"""Cost of a resolved impact: one with its history, 10,000 together, the same with SciPy, and from the table.

Run it alone: ``python -m benchmarks.bed [COUNT]``. Times are CPU times of this process on one core.
"""

import math
import statistics
import sys
from collections.abc import Callable

import numpy as np

from benchmarks import table
from benchmarks.table import Row
from benchmarks.timing import cpu_seconds
from rocking.bodies import Block
from rocking.restitution import model
from rocking.restitution.bed import (
    BedImpacts,
    ContactBed,
    Coulomb,
    HuntCrossley,
    KelvinVoigt,
    bed_impact,
    bed_impacts,
    setup_of,
)
from rocking.restitution.bed.setup import Setup

POINTS = 41
COUNT = 10_000
SECONDS = 10.0
AUDIT = 1e-8


def median_cpu(work: Callable[[], object], repeats: int) -> float:
    """Median CPU seconds of a call."""
    return statistics.median(cpu_seconds(work) for _ in range(repeats))


def random_setups(count: int, kind: str, seed: int = 1) -> list[Setup]:
    """Impacts of blocks of all slendernesses and sizes on beds of 41 points, damped and with friction."""
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


def single() -> list[Row]:
    """One impact with its history, compared with the integrator of SciPy on equal equations."""
    block = Block(width=0.2, height=0.4)
    law = KelvinVoigt(block.mass * (2.0 * math.pi * 400.0) ** 2, damping_ratio=1.0)
    bed = ContactBed.uniform(block, POINTS, law)
    fast = median_cpu(lambda: bed_impact(block, bed, angular_velocity=1.0), 21)
    slow = median_cpu(lambda: bed_impact(block, bed, angular_velocity=1.0, engine="reference", tolerance=1e-6), 1)
    description = f"one impact, {POINTS} points, with its history"
    return [
        Row(description, "-", f"{1e3 * fast:.2f} ms", "< 5 ms", fast < 5e-3),
        Row(description, "SciPy DOP853, the same equations", f"{slow / fast:,.0f} times faster", "for information"),
    ]


def batch(count: int, kind: str) -> list[Row]:
    """Many impacts of one law: time, and whether the energy of every one is accounted for."""
    setups, results = random_setups(count, kind), list[BedImpacts]()
    spent = cpu_seconds(lambda: results.append(bed_impacts(setups)))
    impacts, goal = results[0], SECONDS * count / COUNT
    audit, steps = np.abs(impacts.audit), float(np.mean(impacts.results["steps"]))
    failed = int(np.isnan(impacts.coefficient).sum())
    description = f"{count:,} impacts, {kind}, {POINTS} points"
    time_text = f"{spent:.1f} s ({1e3 * spent / count:.2f} ms each, {steps:.0f} steps)"
    closed = f"worst {audit.max():.1e}, median {np.median(audit):.1e}, {failed} failed"
    # the table of `contact-bed` holds Kelvin-Voigt impacts: the goal is theirs
    of_the_table = kind == "kelvin-voigt"
    timed = (f"< {goal:.0f} s", spent < goal) if of_the_table else ("for information", None)
    return [
        Row(description, "one core", time_text, *timed),
        Row(
            description,
            "their own energy before the impact",
            closed,
            f"< {AUDIT:.0e}",
            audit.max() < AUDIT and failed == 0,
        ),
    ]


def tabulated(count: int) -> Row:
    """The same question put to the table behind the model `contact-bed`."""
    slenderness = np.linspace(1.2, 8.0, count)
    bed = model("contact-bed", points=POINTS)
    spent = median_cpu(lambda: bed.of_slenderness(slenderness), 5)
    return Row(f"{count:,} coefficients from the table", "one core", f"{1e3 * spent:.1f} ms", "for information")


def main(count: int = COUNT) -> bool:
    """Print and keep the table; whether every goal was met."""
    rows = [*single(), *batch(count, "kelvin-voigt"), *batch(count, "hunt-crossley"), tabulated(count)]
    text = [
        "# Speed of the contact bed",
        "",
        "CPU time of one process on one core, in one run; made by `python -m benchmarks bed`. Blocks of h/b 1.2 to 8",
        "and 0.1 to 2 m, Coulomb friction 0.3 to 1, released at a tenth to eight tenths of the slenderness angle,",
        "followed to the next peak; relative error of a step 1e-9.",
        "",
        f"{table.machine()}.",
        f"{table.versions('numpy', 'scipy')}.",
        "",
        *table.lines(rows),
    ]
    if count == COUNT:
        table.keep("RESULTS-bed.md", text)
    else:
        print("\n".join(text))
    return all(row.met is not False for row in rows)


if __name__ == "__main__":
    sys.exit(0 if main(*(int(argument) for argument in sys.argv[1:])) else 1)
