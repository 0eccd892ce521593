"""`rocking record convert`: processing steps of a record, and its conversion to another format."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rocking import checks, plausibility
from rocking.answers import Answer, Display
from rocking.cli import options
from rocking.cli.exports import DRAWN, Export, Exports
from rocking.cli.page import Page, deliver
from rocking.cli.spelling import UsageError
from rocking.conventions import ACCELERATION_UNITS
from rocking.quantities import closely
from rocking.spec.motion_tables import MotionKeys

if TYPE_CHECKING:
    from rocking.motions.motion import GroundMotion
    from rocking.spec.motion_tables import ComponentsTable
    from rocking.spec.reading import InputFiles

_PEAKS = ("peak_ground_acceleration", "peak_ground_velocity", "peak_ground_displacement", "end_velocity")
_CLOSELY = closely(**dict.fromkeys(_PEAKS, ".6g"))


def _as(form: str) -> Any:
    def write(answer: "Conversion", path: Path) -> None:
        from rocking.motions.formats import Component, Record, write_motion, write_record

        if len(answer.pairs) == 1:
            write_motion(answer.leading[1], path, form, answer.units)
            return
        factor, after = (
            ACCELERATION_UNITS[answer.units],
            {axis: processed for axis, (_, processed) in answer.pairs.items()},
        )
        parts = tuple(
            Component(
                motion.metadata.get("component", axis), motion.acceleration / factor, answer.units, motion.time_step
            )
            for axis, motion in after.items()
        )
        write_record(Record(form, parts, metadata={"event": answer.name, **answer.leading[0].metadata}), path, form)

    return write


def _provenance(answer: "Conversion", path: Path) -> None:
    path.write_text(json.dumps(answer.answer().plain(), indent=1) + "\n", encoding="utf-8")


def _kinds() -> dict[str, Export]:
    """Return the kinds of output files: every record format, a picture, and the provenance."""
    from rocking.motions.formats import formats

    exports = {name: Export(form.suffixes, _as(name)) for name, form in formats().items()}
    others = {"picture": DRAWN, "provenance": Export((".json",), _provenance)}
    return {"columns": exports["columns"], **exports, **others}


def record_convert(
    context: typer.Context,
    record: Annotated[
        list[str],
        typer.Argument(help=r"Record file, FILE#COMPONENT, x=FILE y=FILE z=FILE, or TOML with \[motion]."),
    ],
    units: options.RecordUnits = None,
    scale: Annotated[float | None, options.key(MotionKeys, "scale")] = None,
    sets: options.SetOfProcessing = None,
    output_units: Annotated[
        str | None,
        typer.Option(
            help=f"Unit in formats without a fixed unit: {', '.join(ACCELERATION_UNITS)}. "
            "[default: unit of the record]",
            rich_help_panel=options.OUTPUT,
        ),
    ] = None,
    output: Annotated[
        list[str] | None,
        options.output(
            "File; the extension selects the format; or NAME=FILE, see rocking record formats; .png, .svg, .pdf: "
            "picture; .json: processing steps; repeatable."
        ),
    ] = None,
    as_json: options.AsJson = False,
) -> None:
    """Run `rocking record convert`."""
    from rocking.cli.arguments import Arguments, document_file, hinted, with_sets
    from rocking.motions.motion import GroundMotion
    from rocking.spec.documents.records import RecordDocument
    from rocking.spec.motion_tables import ComponentsTable
    from rocking.spec.reading import CommandFiles, InputFiles, checked, tables_in

    exports = Exports.of(output, _kinds())
    if output_units is not None:
        output_units = checks.one_of("--output-units", output_units, ACCELERATION_UNITS)
        _check_free_unit(exports)
    arguments = Arguments(context, "motion")
    file = document_file(context, record[0], ("motion",), ("record",)) if len(record) == 1 else None
    files = CommandFiles(Path()) if file is None else InputFiles(file.parent)
    vertical_component = next((word.rpartition("#")[2] for word in record if word.startswith("z=")), "")
    with hinted(None, record[0].removeprefix("x="), vertical_component):
        if file is None:
            scaled = arguments.table("motion", {"scale": scale}, keys={"scale"})
            level = any(word.startswith("y=") for word in record)
            own = arguments.components(record) if level else arguments.one_motion(record)
            table = checked(ComponentsTable, {**own, **scaled})
        else:
            table = checked(RecordDocument, with_sets(tables_in(file) or {}, arguments.sets)).motion
        named = [entry.record for entry in (table, *table.components.values()) if entry.record]
        exports.spare(*(word.removeprefix(f"{word[:1]}=") for word in record), *named)
        pairs = _pairs(table, files)
    if not all(isinstance(motion, GroundMotion) for pair in pairs.values() for motion in pair):
        raise UsageError("Give a record file, got the pulse {pulse!r:.80}", pulse=record[0])
    # formats without a stated unit keep the unit of the file
    unit = output_units or next(iter(pairs.values()))[0].metadata.get("unit", "m/s2")
    written = tuple(str(path) for _, path in exports.files)
    deliver(Conversion(pairs, unit, written), exports, as_json=as_json)


def _check_free_unit(exports: Exports) -> None:
    """Refuse a unit if no output file can have it."""
    from rocking.motions.formats import formats

    free = [name for name, form in formats().items() if form.unit_is_free]
    if exports.names.isdisjoint(free):
        raise UsageError(
            "{parameter} needs an output file of a format without a fixed unit: {formats}",
            parameter="--output-units", formats=", ".join(free),
        )  # fmt: skip


def _pairs(table: "ComponentsTable", files: "InputFiles") -> dict[str, Any]:
    """Return each component before and after its steps by axis; the axis of a single component is empty."""
    from rocking.spec.construction import components_of, motion_of

    tables = table.components or {"": table}
    before = {axis: motion_of(motion, files, raw=True) for axis, motion in tables.items()}
    if table.components:
        after = components_of(table, files, table.scale)
    else:
        motion = motion_of(table, files)
        after = {"": motion if table.scale == 1.0 else motion.scaled(table.scale)}
    return {axis: (before[axis], after[axis]) for axis in tables}


@dataclass(frozen=True)
class Conversion:
    """A record before and after its steps."""

    pairs: dict[str, "tuple[GroundMotion, GroundMotion]"]  # components by axis; empty axis for a single component
    units: str  # unit in files whose format states no unit
    files: tuple[str, ...]

    @property
    def leading(self) -> "tuple[GroundMotion, GroundMotion]":
        """The component with the largest peak, before and after."""
        return max(self.pairs.values(), key=lambda pair: pair[1].peak)

    @property
    def name(self) -> str:
        return ", ".join(dict.fromkeys(after.name for _, after in self.pairs.values()))

    def draw(self) -> Any:
        from rocking.plots import processing_picture

        return processing_picture(*self.leading)

    def answer(self) -> Answer:
        """Return the record before and after its steps."""
        by_axis = {axis: _told(*pair) for axis, pair in self.pairs.items()}
        facts = by_axis[""] if len(by_axis) == 1 else {"components": by_axis}
        return Answer({"name": self.name, **facts, "files": self.files})

    def show(self, page: Page) -> None:
        rows = []
        for axis, pair in self.pairs.items():
            page.line(f"{axis}  {pair[1].name}".strip(), "bold")
            for line in pair[1].provenance:
                page.line(f"  {line}", "dim")
            named = zip(("before", "after"), pair, strict=True)
            rows += [{"": f"{axis} {name}".strip(), **_facts(motion)} for name, motion in named]
        page.line()
        page.rows(rows, (), Display(own=_CLOSELY), most=len(rows))
        if not self.files:
            page.line("No file written. Files: -o FILE.at2; picture before and after: -o FILE.png")


def _told(before: "GroundMotion", after: "GroundMotion") -> dict[str, Any]:
    facts: dict[str, dict[str, Any]] = {
        name: {**_facts(motion), "warnings": _doubts(motion)} for name, motion in (("before", before), ("after", after))
    }
    facts["before"]["warnings"] += filter(None, [before.metadata.get("doubts")])
    return {**facts, "metadata": dict(before.metadata), "provenance": list(after.provenance)}


def _doubts(motion: "GroundMotion") -> list[str]:
    """Return implausible values of the samples and of their integrals."""
    end, velocity, displacement = (
        _facts(motion)[key] for key in ("end_velocity", "peak_ground_velocity", "peak_ground_displacement")
    )
    return [*motion.doubts, *plausibility.of_integrals(end, velocity, displacement)]


def _facts(motion: "GroundMotion") -> dict[str, float]:
    from rocking.motions import ground_velocity, peak_ground_displacement, peak_ground_velocity

    return {
        "samples": len(motion),
        "time_step": motion.time_step,
        "peak_ground_acceleration": motion.peak,
        "peak_ground_velocity": peak_ground_velocity(motion),
        "peak_ground_displacement": peak_ground_displacement(motion),
        "end_velocity": float(ground_velocity(motion)[-1]),
    }
