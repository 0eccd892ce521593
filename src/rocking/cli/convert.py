"""`rocking convert`: a record, put through its steps where there are any, in another format."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rocking import plausibility
from rocking.cli import options
from rocking.cli.exports import PICTURES, Export, Exports, draw
from rocking.cli.page import Page, deliver
from rocking.conventions import g
from rocking.errors import InvalidValueError

if TYPE_CHECKING:
    from rocking.motions.motion import GroundMotion


def _as(form: str) -> Any:
    def write(answer: "Conversion", path: Path) -> None:
        from rocking.motions.formats import write_motion

        write_motion(answer.after, path, form, answer.units)

    return write


def _provenance(answer: "Conversion", path: Path) -> None:
    path.write_text(json.dumps(answer.facts(), indent=1) + "\n", encoding="utf-8")


def _kinds() -> dict[str, Export]:
    """Return the kinds of files that are written: every format, a picture, and what was done."""
    from rocking.motions.formats import formats

    known = {name: Export(form.suffixes, _as(name)) for name, form in formats().items()}
    others = {"picture": Export(PICTURES, draw, "matplotlib"), "provenance": Export((".json",), _provenance)}
    return {"columns": known["columns"], **known, **others}


def convert(
    context: typer.Context,
    record: Annotated[
        list[str],
        typer.Argument(
            help=r"Record file, file#COMPONENT; vertical part too: x=FILE z=FILE; or a TOML with \[motion]."
        ),
    ],
    units: options.RecordUnits = None,
    scale: Annotated[float | None, options.key(options.tables.MotionKeys, "scale")] = None,
    sets: options.Set = None,
    out: Annotated[
        list[str] | None,
        typer.Option(
            help="Write a file, again for more: in a format by its ending, or NAME=FILE as rocking formats names it; "
            ".png, .svg and .pdf draw it before and after, .json keeps what was done.",
            rich_help_panel=options.OUTPUT,
        ),
    ] = None,
    as_json: options.AsJson = False,
) -> None:
    """Write a record in another format, corrected by --set "motion.process=mean; bandpass:low=0.1,high=25; taper"."""
    from rocking.cli.arguments import Arguments, document_file, hinted, with_sets
    from rocking.motions.motion import GroundMotion
    from rocking.spec.construction import motion_of
    from rocking.spec.document import OneMotionTable, RecordDocument
    from rocking.spec.reading import CommandFiles, InputFiles, checked, tables_in

    exports = Exports.of(out, _kinds())
    arguments = Arguments(context, "motion")
    file = document_file(context, record[0], ("motion",), ("record",)) if len(record) == 1 else None
    files = CommandFiles(Path()) if file is None else InputFiles(file.parent)
    upright = next((word.rpartition("#")[2] for word in record if word.startswith("z=")), "")
    with hinted(None, record[0].removeprefix("x="), upright):
        if file is None:
            scaled = arguments.table("motion", {"scale": scale}, keys={"scale"})
            if any(word.startswith("y=") for word in record):
                raise InvalidValueError(
                    "one horizontal component is written, x= with z=; rocking motions turns two of them, by "
                    "--set motion.process=rotate:angle=30"
                )
            table = checked(OneMotionTable, {**arguments.one_motion(record), **scaled})
        else:
            table = checked(RecordDocument, with_sets(tables_in(file) or {}, arguments.sets)).motion
        exports.spare(*record, *filter(None, [table.record]))
        before = motion_of(table, files, raw=True)
        after = motion_of(table, files)
    if not isinstance(before, GroundMotion) or not isinstance(after, GroundMotion):
        raise InvalidValueError(f"a record file is converted, got the pulse {record[0]!r:.80}")
    after = after if table.scale == 1.0 else after.scaled(table.scale)
    # a format without a unit of its own keeps that of the file
    unit = before.metadata.get("unit", "m/s2")
    written = tuple(str(path) for _, path in exports.files)
    deliver(Conversion(before, after, unit, written), exports, as_json=as_json)


@dataclass(frozen=True)
class Conversion:
    """A record before and after its steps."""

    before: "GroundMotion"
    after: "GroundMotion"
    units: str  # of formats that state none
    files: tuple[str, ...]

    def draw(self) -> Any:
        from rocking.plots import processing_picture

        return processing_picture(self.before, self.after)

    def facts(self) -> dict[str, Any]:
        told: dict[str, dict[str, Any]] = {
            name: {**_facts(motion), "warnings": _doubts(motion)}
            for name, motion in (("before", self.before), ("after", self.after))
        }
        told["before"]["warnings"] += filter(None, [self.before.metadata.get("doubts")])
        said = {"metadata": dict(self.before.metadata), "provenance": list(self.after.provenance)}
        return {"name": self.after.name, **told, **said, "files": list(self.files)}

    def show(self, page: Page) -> None:
        page.line(self.after.name, "bold")
        for line in self.after.provenance:
            page.line(f"  {line}", "dim")
        page.line()
        rows = [
            (name, *(f"{value:.6g}" for value in _facts(motion).values()), f"{motion.peak / g:.4g}")
            for name, motion in (("before", self.before), ("after", self.after))
        ]
        head = ("", "samples", "step [s]", "PGA [m/s2]", "PGV [m/s]", "PGD [m]", "v at end [m/s]", "PGA [g]")
        page.table(head, rows, ("",))
        if not self.files:
            page.line("Nothing was written: --out FILE.at2 writes it, --out FILE.png draws it before and after.")


def _doubts(motion: "GroundMotion") -> list[str]:
    """Return what is hardly meant, of the samples and of what they integrate to."""
    end, velocity, displacement = (_facts(motion)[key] for key in ("end_velocity_m_s", "pgv_m_s", "pgd_m"))
    return [*motion.doubts, *plausibility.of_integrals(end, velocity, displacement)]


def _facts(motion: "GroundMotion") -> dict[str, float]:
    from rocking.motions import ground_velocity, peak_ground_displacement, peak_ground_velocity

    return {
        "samples": len(motion),
        "time_step_s": motion.time_step,
        "pga_m_s2": motion.peak,
        "pgv_m_s": peak_ground_velocity(motion),
        "pgd_m": peak_ground_displacement(motion),
        "end_velocity_m_s": float(ground_velocity(motion)[-1]),
    }
