"""`rocking measurements`: own and published measurements, and the calibration of the models."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rocking.cli.page import Page, deliver

if TYPE_CHECKING:
    from rocking.answers import Answer
    from rocking.evidence import DataSet
    from rocking.evidence._league import LeagueRow
    from rocking.evidence.hierarchy import HierarchicalCalibration, LeftOut

Selection = Annotated[
    list[str] | None,
    typer.Argument(help="Measurements: published, own, table1, S, M, L, or files (.toml, .csv)."),
]
MEASUREMENT = ("set", "block", "interface", "slenderness_ratio", "mass", "coefficient")
"""Columns of `rocking measurements list --details`."""
AsJson = Annotated[bool, typer.Option("--json", help="Result as JSON.")]

measurements = typer.Typer(
    name="measurements",
    help="Add and list measured coefficients; calibrate the models.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    add_completion=False,
)


@measurements.command()
def add(
    file: Annotated[Path, typer.Argument(help="File of measurements: TOML or CSV.")],
    as_json: AsJson = False,
) -> None:
    """Check a file of measurements; copy it to the own data."""
    from rocking.evidence import store

    deliver(AddedAnswer(*store.add(file)), as_json=as_json)


@measurements.command(name="list")
def list_(
    details: Annotated[bool, typer.Option("--details", help="All measurements.")] = False, as_json: AsJson = False
) -> None:
    """List the published and own measurements."""
    from rocking.evidence import store
    from rocking.evidence.measurements import GROUPS, datasets

    sets = [(name, datasets()[name]) for name in GROUPS]
    sets += [(str(path), data) for path, data in store.own_sets()]
    deliver(ListAnswer(sets, details), as_json=as_json)


@measurements.command()
def calibrate(which: Selection = None, as_json: AsJson = False) -> None:
    """Calibrate the models; compare them with measurements."""
    from rocking.evidence import league, store
    from rocking.evidence.hierarchy import calibrate_hierarchy, left_out_groups

    data = store.selected(which or ())
    standings = league(measurements=data)
    deliver(CalibrationAnswer(data, standings, calibrate_hierarchy(data), left_out_groups(data)), as_json=as_json)


@dataclass(frozen=True)
class AddedAnswer:
    """A file that was added."""

    path: Path
    data: "DataSet"
    new: bool

    def answer(self) -> "Answer":
        """Return the file with the measurements, and their number."""
        from rocking.answers import Answer

        return Answer({"file": str(self.path), "measurements": len(self.data), "new": self.new})

    def show(self, page: Page) -> None:
        status = "added to the own measurements" if self.new else "already in the own measurements"
        page.line(f"{self.data!r}: {status}", "bold")
        page.facts([("file", str(self.path)), ("next", "rocking measurements calibrate")])


@dataclass(frozen=True)
class ListAnswer:
    """Sets of measurements with their names."""

    sets: "list[tuple[str, DataSet]]"
    details: bool = False

    @property
    def _rows(self) -> "list[dict[str, Any]]":
        """Each measurement of all sets."""
        return [row for _, data in self.sets for row in _measurements(data)]

    def answer(self) -> "Answer":
        """Return each set, its size and its ranges; with details, also each measurement."""
        from rocking.answers import Answer

        return Answer(({"values": self._rows} if self.details else {}) | {"sets": [
            {
                "name": name, "measurements": len(data), "laboratories": _different(data.laboratory),
                "interfaces": _different(data.interface),
                "slenderness_ratio": [data.slenderness.min(), data.slenderness.max()],
                "coefficient": [data.coefficient.min(), data.coefficient.max()], "source": data.source,
            }
            for name, data in self.sets
        ]})  # fmt: skip

    def show(self, page: Page) -> None:
        from rocking.answers import Display

        if self.details:
            page.rows(self._rows, MEASUREMENT, most=len(self._rows))
            page.line()
        sets = self.answer()["sets"]
        ranged = ("slenderness_ratio", "coefficient")
        summaries = [{**entry, "set": Path(entry["name"]).name, "laboratories": ", ".join(entry["laboratories"]),
                 **{name: " - ".join(Display().cell(name, end) for end in entry[name]) for name in ranged}}
                for entry in sets]  # fmt: skip
        page.rows(summaries, ("set", "measurements", *ranged, "laboratories"), most=len(summaries))
        page.line()
        page.facts(dict.fromkeys(("source", data.source) for _, data in self.sets))
        page.facts(dict.fromkeys(("own files", str(Path(name).parent)) for name, _ in self.sets if Path(name).suffix))


@dataclass(frozen=True)
class CalibrationAnswer:
    """Calibration of the models with measurements."""

    data: "DataSet"
    league: "tuple[LeagueRow, ...]"
    calibration: "HierarchicalCalibration"
    left_out: "tuple[LeftOut, ...]"

    def answer(self) -> "Answer":
        """Return the calibration and the league."""
        from rocking.evidence.hierarchy import hierarchy_answer

        league = [row.answer() for row in self.league]
        return hierarchy_answer(self.calibration, self.left_out) | {"measurements": len(self.data), "league": league}

    def show(self, page: Page) -> None:
        from rocking.evidence import verdict
        from rocking.evidence.hierarchy import sentence_of

        page.line(f"{self.data!r}: {self.calibration.model().label}", "bold")
        head = ("", "mean", "sd", "2.5 %", "97.5 %")
        rows = [
            (name, *(f"{value:.4f}" for value in facts.values())) for name, facts in self.calibration.summary.items()
        ]
        page.table(head, rows, ("",))
        page.line(sentence_of(self.calibration, self.left_out))
        names = ("name", "measurements", "inside", "interval_width", "within")
        page.rows((group.answer().values for group in self.left_out), names, most=len(self.left_out))
        show_league(page, self.league, len(self.data))
        page.line()
        for sentence in verdict(self.league, self.data):
            page.line(sentence)


def _measurements(data: "DataSet") -> "list[dict[str, Any]]":
    """Return the rows of a set for an answer."""
    columns = {name: data.exported().columns[name].values.tolist() for name in MEASUREMENT}
    return [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]


def _different(names: tuple[str, ...]) -> list[str]:
    return [name for name in dict.fromkeys(names) if name]


def show_league(page: Page, league: "Sequence[LeagueRow]", count: int) -> None:
    """Print the errors of all models."""
    from rocking.answers import Display
    from rocking.quantities import QUANTITIES

    page.line(f"\nLeague: RMSE of r over {count} measurements, in bands of h/b; log error of the energy loss", "bold")
    bands = {band: replace(QUANTITIES["by_band"], name=band) for band in league[0].by_band}
    rows = [{**row.answer().values, "model": row.name, **row.by_band} for row in league]
    bold = {k for k, row in enumerate(league) if row.name in {"ked", "housner"}}
    names = ("model", "rmse", "bias", *bands, "log_loss_rmse", "bic")
    page.rows(rows, names, Display(own=bands), bold=bold, most=len(rows), dense=False)
