"""`rocking record show`: properties, intensity measures and spectrum of a record or a pulse."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rocking import checks
from rocking.answers import Answer, AnswerRows, Display
from rocking.cli import options
from rocking.cli.exports import DRAWN, Export, Exports
from rocking.cli.numbers import beside_g
from rocking.cli.page import Page, deliver
from rocking.cli.spelling import UsageError
from rocking.spec.motion_tables import MotionKeys

if TYPE_CHECKING:
    from rocking.motions.intensity import Measure
    from rocking.motions.motion import GroundMotion
    from rocking.motions.pulse import Motion
    from rocking.motions.spectrum import ResponseSpectrum

_MOST_PERIODS = 1000
_HEAD = (
    "kind", "format", "event", "date", "station", "component", "vertical_component", "samples", "time_step",
    "file_unit", "duration", "peak_vertical_acceleration",
)  # fmt: skip
_SPECTRUM = ("period", "pseudo_acceleration", "pseudo_velocity", "spectral_displacement")


def _write_csv(answer: "MotionPage", path: Path) -> None:
    """Write time, acceleration, velocity and displacement at the samples; values of a pulse are exact."""
    import numpy as np

    from rocking.motions.integrals import ground_displacement, ground_velocity
    from rocking.motions.motion import GroundMotion
    from rocking.plots.labels import traces
    from rocking.tables import Column, Table, to_csv

    motion, samples = answer.motion, answer.samples
    columns: dict[str, Any] = {"time": np.asarray(samples.time), "acceleration": samples.acceleration}
    if isinstance(motion, GroundMotion):
        columns |= {"velocity": ground_velocity(motion), "displacement": ground_displacement(motion)}
        if motion.vertical is not None:
            columns["vertical_acceleration"] = motion.vertical
    else:
        fine = traces(motion)
        columns |= {"velocity": fine.velocity, "displacement": fine.displacement}
    to_csv(Table("sample", {name: Column.of(name, values) for name, values in columns.items()}), path, blank=False)


EXPORTS = {"picture": DRAWN, "csv": Export((".csv",), _write_csv)}


def record_show(
    context: typer.Context,
    record: Annotated[
        list[str],
        typer.Argument(help="Record file, FILE#COMPONENT or pulse: sine:amplitude=3,period=0.8; or x=FILE z=FILE."),
    ],
    units: options.RecordUnits = None,
    scale: Annotated[float | None, options.key(MotionKeys, "scale")] = None,
    damping: Annotated[float, typer.Option(help="Damping ratio of the spectrum.")] = 0.05,
    periods: Annotated[
        str, typer.Option(help=r"Periods of the spectrum, separated by commas \[s].")
    ] = "0.1,0.2,0.5,1,2,3",
    sets: options.Set = None,
    output: Annotated[list[str] | None, options.output(EXPORTS)] = None,
    as_json: options.AsJson = False,
) -> None:
    """Run `rocking record show`."""
    from rocking.cli.arguments import Arguments, hinted
    from rocking.motions.spectrum import response_spectrum
    from rocking.plots.labels import fine_samples
    from rocking.reports.response_facts import measures_of
    from rocking.spec.construction import motion_of
    from rocking.spec.motion_tables import OneMotionTable
    from rocking.spec.reading import CommandFiles, checked

    exports = Exports.of(output, EXPORTS)
    arguments = Arguments(context, "motion")
    if scale is not None:
        checks.number("scale", scale)
    vertical_component = next((word.rpartition("#")[2] for word in record if word.startswith("z=")), "")
    with hinted(None, record[0].removeprefix("x="), vertical_component):
        scaled = arguments.table("motion", {"scale": scale}, keys={"scale"})
        table = checked(OneMotionTable, {**arguments.one_motion(record), **scaled})
        subject = motion_of(table, CommandFiles(Path()))
    subject = subject if table.scale == 1.0 else subject.scaled(table.scale)
    samples = fine_samples(subject)
    spectrum = response_spectrum(samples, parsed_periods(periods), damping)
    unit = arguments.acceleration or "m/s2"
    answer = MotionPage(subject, samples, measures_of(subject, samples), spectrum, unit)
    deliver(answer, exports, as_json=as_json)


def parsed_periods(text: str) -> list[float]:
    """Return the periods of a spectrum [s].

    >>> parsed_periods("0.1, 0.5,1")
    [0.1, 0.5, 1.0]
    """
    texts = [entry.strip() for entry in text.split(",") if entry.strip()]
    if not 1 <= len(texts) <= _MOST_PERIODS:
        raise UsageError(
            parameter="periods", allowed=f"1 to {_MOST_PERIODS} numbers such as 0.1,0.5,1", value=text[:60]
        )
    try:
        numbers = [float(entry) for entry in texts]
    except ValueError as error:
        raise UsageError(parameter="periods", allowed="numbers such as 0.1,0.5,1 [s]", value=text[:60]) from error
    hint = checks.number_hint(text)
    return [checks.positive("periods", number, "s", hint) for number in numbers]


@dataclass(frozen=True)
class MotionPage:
    """A motion with its intensity measures and spectrum."""

    motion: "Motion"
    samples: "GroundMotion"  # the motion, or a fine sampling of the pulse
    measures: "dict[str, Measure]"  # intensity measures by short name
    spectrum: "ResponseSpectrum"  # spectrum at the requested periods
    acceleration: str  # unit of printed accelerations

    def draw(self) -> Any:
        from rocking.plots import ground_motion_picture

        return ground_motion_picture(self.motion)

    def answer(self) -> Answer:
        """Return the motion, its intensity measures and its spectrum."""
        from rocking.reports.response_facts import record_answer, spectrum_answer

        answer = record_answer(self.motion, self.samples, self.measures)
        return answer | {"spectrum": spectrum_answer(self.spectrum)}

    def show(self, page: Page) -> None:
        answer, date = self.answer(), getattr(self.motion, "metadata", {}).get("date")
        display = Display(acceleration=beside_g(self.acceleration), own=answer.quantities)
        page.line(answer["name"], "bold")
        page.values(display.lines({**answer.values, "date": date}, _HEAD))
        for line in answer["provenance"] if answer["kind"] == "record" else ():
            page.line(f"  {line}", "dim")
        page.line("\nIntensity", "bold")
        page.values(display.lines(answer["intensity"], [*answer["intensity"]], in_full=True))
        spectrum = answer["spectrum"]
        damping = display.text("damping_ratio", spectrum["damping_ratio"])
        page.line(f"\nResponse spectrum, damping ratio {damping}", "bold")
        page.rows(AnswerRows({name: spectrum[name].tolist() for name in _SPECTRUM}), (), display, most=_MOST_PERIODS)
