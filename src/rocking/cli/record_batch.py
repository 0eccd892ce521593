"""`rocking record batch`: measures of the records of a folder, and selection by a target spectrum."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rocking import checks
from rocking.answers import Answer, Display
from rocking.cli import options
from rocking.cli.exports import DRAWN, Export, Exports
from rocking.cli.numbers import beside_g
from rocking.cli.page import Page, bar, deliver
from rocking.cli.spelling import UsageError
from rocking.errors import RockingError
from rocking.messages import Message, Option
from rocking.quantities import QUANTITIES, Quantity

if TYPE_CHECKING:
    from rocking.motions.flatfiles import Flatfile
    from rocking.motions.selection import Selection

_MOST_PROCESSES = 8  # default limit
_SHOWN = ("pga", "pgv", "arias", "d5_95")


def _csv(answer: "SetAnswer", path: Path) -> None:
    from rocking.tables import to_csv

    to_csv(answer.flatfile.flat(), path)


def _excel(answer: "SetAnswer", path: Path) -> None:
    from rocking.tables import Table, to_excel

    left_out = Table.of_rows("file", ("file", "reason"), [(name, str(reason)) for name, reason in answer.left_out])
    to_excel([("records", answer.flatfile.flat()), ("left out", left_out)], path)


def _netcdf(answer: "SetAnswer", path: Path) -> None:
    from rocking.tables import to_netcdf

    to_netcdf(answer.flatfile.to_xarray(), path)


EXPORTS = {
    "csv": Export((".csv",), _csv),
    "excel": Export((".xlsx",), _excel, "openpyxl"),
    "netcdf": Export((".nc",), _netcdf, "h5netcdf"),
    "picture": DRAWN,
}


def record_batch(
    context: typer.Context,
    record: Annotated[
        list[str],
        typer.Argument(help=r"Folder, quoted pattern, record files, list of records (.csv) or TOML with \[motions]."),
    ],
    units: options.RecordUnits = None,
    damping: Annotated[float, typer.Option(help="Damping ratio of the spectra.")] = 0.05,
    periods: Annotated[
        str | None,
        typer.Option(help=r"Periods of the spectra, separated by commas \[s]. [default: 30 from 0.02 to 10]"),
    ] = None,
    sets: options.SetOfRecords = None,
    workers: Annotated[
        int | None, typer.Option(help="Number of processes. [default: number of processors, at most 8]")
    ] = None,
    output: Annotated[list[str] | None, options.output(EXPORTS)] = None,
    as_json: options.AsJson = False,
) -> None:
    """Run `rocking record batch`."""
    from rocking.cli.arguments import Arguments, document_file, is_file, with_sets
    from rocking.cli.record_show import parsed_periods
    from rocking.dynamics.settings import processors
    from rocking.motions.flatfiles import PERIODS, flatfile
    from rocking.spec.documents.records import RecordSetDocument
    from rocking.spec.motion_tables import MotionTable
    from rocking.spec.reading import CommandFiles, InputFiles, checked, is_pattern, tables_in
    from rocking.spec.record_sets import record_set

    exports = Exports.of(output, EXPORTS)
    arguments = Arguments(context, "motion")
    allowed_options = ("record", "damping", "periods", "workers")
    file = document_file(context, record[0], ("motions",), allowed_options) if len(record) == 1 else None
    files = CommandFiles(Path()) if file is None else InputFiles(file.parent)
    if missing := [word for word in record if not is_file(word) and not is_pattern(word)]:
        raise UsageError("{file:.200}: no such file or folder", file=missing[0])
    damping = checks.within("--damping", damping, 0.0, 1.0, open_high=True, hint="a ratio, not a percentage")
    spectrum_periods = PERIODS if periods is None else parsed_periods(periods)
    count = min(processors(), _MOST_PROCESSES) if workers is None else checks.whole("--workers", workers, 1, 256)
    if file is None:
        values = {"records": list(record), "units": arguments.acceleration}
        table = checked(MotionTable, arguments.table("motion", values, {"records": record[0]}))
    else:
        tables = with_sets(tables_in(file) or {}, arguments.sets, lists=True)
        (table,) = checked(RecordSetDocument, tables).motions
    with bar("files", quiet=as_json) as progress:
        records, chosen = record_set(table, files, count, progress)
    with bar("records", len(records), quiet=as_json) as progress:
        measured = flatfile(records, spectrum_periods, damping, workers=count, progress=progress)
    left_out = (*records.left_out, *measured.left_out)
    deliver(SetAnswer(measured, chosen, left_out, arguments.acceleration or "m/s2"), exports, as_json=as_json)


@dataclass(frozen=True)
class SetAnswer:
    """Records, their measures and their selection."""

    flatfile: "Flatfile"
    chosen: "Selection | None"
    left_out: tuple[tuple[str, str | RockingError], ...]
    acceleration: str

    def draw(self) -> Any:
        from rocking.plots import selection_picture, spectra_picture

        return spectra_picture(self.flatfile) if self.chosen is None else selection_picture(self.chosen)

    def answer(self) -> Answer:
        """Return the measures of each record, and the selection."""
        table, spectra = self.flatfile.table, self.flatfile.spectra
        rows = [dict(zip(table.columns, row, strict=True)) for row in table.rows]
        for k, row in enumerate(rows):
            row["spectra"] = {name: values[k] for name, values in spectra.items()}
        facts: dict[str, Any] = {"damping_ratio": self.flatfile.damping, "period": self.flatfile.periods}
        if (chosen := self.chosen) is not None:
            selection = {"scale": chosen.factors, "misfit": chosen.misfits, "period": chosen.periods}
            selection |= {"mean": chosen.mean, "target_spectrum": chosen.target(chosen.periods)}
            facts["selection"] = {
                "target": chosen.target.name, **selection, "misfit_of_mean": chosen.misfit, "least_ratio": chosen.least,
                "sentence": chosen.sentence,
            }  # fmt: skip
        left_out = [{"file": name, **_reason(reason)} for name, reason in self.left_out]
        measured = {
            name: Quantity(name, column.unit, column.meaning) for name, column in table.columns.items() if column.unit
        }
        accelerations = ("spectra", "mean", "target_spectrum")
        measured |= {name: Quantity(name, "m/s2", "spectral pseudo-acceleration") for name in accelerations}
        return Answer({**facts, "records": rows, "left_out": left_out}, measured)

    def show(self, page: Page) -> None:
        columns, answer, rows = self.flatfile.table.columns, self.answer(), []
        for k, row in enumerate(answer["records"]):
            axes = [axis for axis in "xyz" if row[f"pga_{axis}"] == row[f"pga_{axis}"]]
            axis_of_largest_peak = max(axes, key=lambda axis: (axis != "z", row[f"pga_{axis}"]))
            shown = {"record": row["record"], "components": " ".join(axes)}
            shown |= {name: row[f"{name}_{axis_of_largest_peak}"] for name in _SHOWN}
            if self.chosen is not None and len(self.chosen.factors) == len(self.flatfile.table):
                shown |= {"scale": self.chosen.factors[k], "misfit": self.chosen.misfits[k]}
            rows.append(shown)
        from rocking.motions.intensity import MEASURES

        own = {
            name: Quantity(name, columns[f"{name}_x"].unit, "", label=MEASURES[name].symbol)
            for name in _SHOWN
            if name not in QUANTITIES
        }
        page.rows(rows, (), Display(acceleration=beside_g(self.acceleration), own=own), most=len(rows))
        page.line()
        page.line(f"{len(rows)} records; values of the component with the largest peak, files contain all components.")
        if self.chosen is not None:
            page.line(self.chosen.sentence)
        page.warn(f"left out: {name}: {reason}" for name, reason in self.left_out)


def _reason(reason: str | RockingError) -> dict[str, str]:
    """Return the reason for the exclusion of a file, with a hint if the error has one."""
    if isinstance(reason, str):
        return {"reason": reason}
    option = reason.hint.facts.get("option") if isinstance(reason.hint, Message) else None
    return {
        "reason": reason.cause,
        "hint": str(reason.hint),
        "to_state": option.path if isinstance(option, Option) else "",
    }
