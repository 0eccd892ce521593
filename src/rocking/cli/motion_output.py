"""What `rocking motion` prints, writes and draws."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from rocking import checks
from rocking.cli.options import beside_g, in_unit
from rocking.conventions import ACCELERATION_UNITS, FloatArray, g
from rocking.errors import InvalidValueError
from rocking.motions.integrals import ground_displacement, ground_velocity
from rocking.motions.intensity import Measure
from rocking.motions.motion import GroundMotion
from rocking.motions.pulse import Pulse
from rocking.plots.traces import traces
from rocking.reports.motion_facts import MotionAnswer, motion_facts, spectrum_facts

_MOST_PERIODS = 1000


def periods_from(words: str) -> list[float]:
    """Return the periods of a spectrum from one word.

    words: numbers above zero with commas between [s]. Returns the periods [s].

    >>> periods_from("0.1, 0.5,1")
    [0.1, 0.5, 1.0]
    """
    parts = [part.strip() for part in words.split(",") if part.strip()]
    if not 1 <= len(parts) <= _MOST_PERIODS:
        raise InvalidValueError(f"periods must be 1 to {_MOST_PERIODS} numbers such as 0.1,0.5,1, got {words[:60]!r}")
    try:
        numbers = [float(part) for part in parts]
    except ValueError as error:
        raise InvalidValueError(f"periods must be numbers such as 0.1,0.5,1 [s], got {words[:60]!r}") from error
    hint = checks.decimal_comma(words).removeprefix("; ")
    return [checks.positive("periods", number, "s", hint) for number in numbers]


def show(answer: MotionAnswer, acceleration: str = "m/s2") -> None:
    """Print what it is, its intensity measures and its spectrum."""
    from rich.console import Console

    console = Console(highlight=False, soft_wrap=True)
    console.print(answer.motion.name, style="bold", markup=False)
    unit = beside_g(acceleration)
    for word, value in _facts(answer, unit):
        console.print(f"  {word + ':':<12} {value}", markup=False)
    for line in answer.samples.provenance if isinstance(answer.motion, GroundMotion) else ():
        console.print(f"  {line}", style="dim", markup=False)
    console.print()
    rows = [_row(one, unit) for one in answer.measures.values()]
    console.print(_table(("intensity measure", "value", "unit", ""), rows))
    console.print()
    spectrum = answer.spectrum
    console.print(f"Response spectrum, {100.0 * spectrum.damping:.4g} % damping", style="bold")
    size = ACCELERATION_UNITS[unit]
    columns = (spectrum.periods, spectrum.pseudo_acceleration / size, spectrum.pseudo_acceleration / g)
    values = zip(*columns, spectrum.pseudo_velocity, spectrum.displacement, strict=True)
    lines = [tuple(f"{value:.4g}" for value in row) for row in values]
    console.print(_table(("T [s]", f"PSA [{unit}]", "PSA [g]", "PSV [m/s]", "Sd [m]"), lines))


def as_json(answer: MotionAnswer) -> str:
    """Return everything as JSON.

    Returns one object; SI units, named in the keys where a quantity has one.
    """
    facts = motion_facts(answer.motion, answer.samples, answer.measures)
    facts["spectrum"] = spectrum_facts(answer.spectrum)
    return json.dumps(facts, indent=2, allow_nan=False)


def write_csv(answer: MotionAnswer, path: Path) -> None:
    """Write time, acceleration, velocity and displacement at the samples; of a pulse as its formulas give them."""
    from rocking.tables import Column, Table, to_csv

    motion, samples = answer.motion, answer.samples
    columns: dict[str, FloatArray] = {"time_s": np.asarray(samples.time), "acceleration_m_s2": samples.acceleration}
    if isinstance(motion, GroundMotion):
        columns |= {"velocity_m_s": ground_velocity(motion), "displacement_m": ground_displacement(motion)}
        if motion.vertical is not None:
            columns["vertical_acceleration_m_s2"] = motion.vertical
    else:
        fine = traces(motion)
        columns |= {"velocity_m_s": fine.velocity, "displacement_m": fine.displacement}
    to_csv(Table("sample", {name: Column(values, "") for name, values in columns.items()}), path, blank=False)


def draw(answer: MotionAnswer, path: Path) -> None:
    """Draw the motion and its spectrum."""
    from rocking.plots import ground_motion_picture, write

    write(ground_motion_picture(answer.motion), path)


def _facts(answer: MotionAnswer, unit: str) -> list[tuple[str, str]]:
    motion = answer.motion
    if isinstance(motion, Pulse):
        return [("kind", "pulse, known at every instant"), ("duration", f"{motion.duration:.6g} s")]
    told = motion.metadata
    keys = ("format", "event", "date", "station", "component", "vertical component")
    facts = [(key.replace("vertical component", "vertical"), told[key]) for key in keys if told.get(key)]
    facts.append(("samples", f"{len(motion)} at {motion.time_step:.6g} s, the file in {told.get('unit', 'm/s2')}"))
    facts.append(("duration", f"{motion.duration:.6g} s"))
    if motion.vertical is not None:
        facts.append(("upwards", f"{in_unit(motion.peak_vertical, unit)} ({motion.peak_vertical / g:.4g} g) at most"))
    return facts


def _row(measure: Measure, unit: str) -> tuple[str, ...]:
    if measure.unit != "m/s2":
        return measure.name, f"{measure.value:.4g}", measure.unit, ""
    return measure.name, *in_unit(measure.value, unit).split(), f"= {measure.value / g:.4g} g"


def _table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> Any:
    from rich.table import Table

    table = Table(box=None, pad_edge=False, header_style="bold")
    for place, word in enumerate(head):
        left = word in {"intensity measure", "unit", ""}
        table.add_column(word.replace("[", r"\["), justify="left" if left else "right", no_wrap=place == 0)
    for row in rows:
        table.add_row(*row)
    return table
