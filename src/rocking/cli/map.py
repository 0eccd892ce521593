"""`rocking map`: outcome of a body over two parameters of the body and its motion."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rocking.answers import Answer, Display
from rocking.cli import options
from rocking.cli.compared import model_facts, overturned, show_models, with_models
from rocking.cli.exports import DATASET, Exports
from rocking.cli.page import Page, bar, deliver
from rocking.cli.spelling import UsageError
from rocking.messages import Message
from rocking.outcome import mode_shares
from rocking.quantities import Quantity
from rocking.spec.questions.map import MapTable

if TYPE_CHECKING:
    import xarray as xr

    from rocking.cli.arguments import Arguments
    from rocking.spec.study import StudyProblem
    from rocking.studies._overturning_map import MapArrays
    from rocking.studies.axis import Axis

_LINE = 1e-4  # tolerance of the boundary in a figure, smaller than a pixel
_RESTITUTIONS = {
    "first": Quantity("first", "", "restitution model", label="restitution"),
    "second": Quantity("second", "", "compared restitution model", label="compared with"),
}
_OUTCOMES = {"count": Quantity("count", "1", "number of cells", label="cells")}
_CHANGES = {
    "count": Quantity("count", "1", "number of cells with different outcomes", label="different outcomes"),
    "only_second": Quantity("only_second", "1", "cells", label="overturning only with second"),
    "only_first": Quantity("only_first", "1", "cells", label="overturning only with first"),
}
_FLIPS = ("first", "second", "count", "fraction", "only_second", "only_first")
_VARIED = Message("The coefficient of restitution is varied along an axis of the map.")
_LAST = 3  # largest number of impacts with its own row; JSON has all numbers

_AXIS = ": NAME=FIRST:LAST:COUNT or NAME=A,B,C, such as pga=0.1g:1g:50"


@options.takes(options.SIZES)
@options.takes(options.keys(MapTable, "refine"))
@options.takes(
    options.keys(
        MapTable, "x", "y", x=_AXIS, defaults={"x": "frequency_ratio=0.5:10:100", "y": "amplitude_ratio=1:12:100"}
    ),
    before="restitution",
)
def map(
    context: typer.Context,
    body: options.BodyFile = None,
    record: options.Record = None,
    motion: options.Motion = None,
    restitution: options.Restitutions = None,
    sets: options.Set = None,
    friction: options.Friction = None,
    threads: options.Threads = None,
    output: Annotated[list[str] | None, options.output(DATASET)] = None,
    details: options.Details = False,
    as_json: options.AsJson = False,
) -> None:
    """Run `rocking map`."""
    from rocking.cli.arguments import Arguments
    from rocking.cli.study import TABLES, body_and_motion, problem_in

    exports = Exports.of(output, DATASET)
    typed_units: dict[str, str] = {}
    length = None
    if (problem := problem_in(context, body, "map")) is None:
        arguments = Arguments(context, *TABLES, "map")
        length = arguments.length
        table, typed_units = _table(arguments)
        problem = body_and_motion(arguments, "overturning-map", table, restitution)
    with bar("histories", quiet=as_json) as progress:
        picture = "picture" in exports.names
        maps, others = with_models(lambda study: _computed(study, progress, threads, picture=picture), problem)
    arrays, compared = maps
    answer = MapAnswer(problem, arrays, compared, typed_units, length or "m", others, details)
    deliver(answer, exports, as_json=as_json)


def _computed(problem: "StudyProblem", progress: Any, threads: int | None, *, picture: bool) -> "tuple[MapArrays, Any]":
    """Return the map with the first restitution model, and the comparison of several models or None."""
    from rocking.studies._overturning_map import MapArrays

    axes = problem.document.axes
    if picture and min(axis.values.size for axis in axes) < 2:
        raise UsageError("a picture needs at least two values of --x and of --y, got one")
    result = problem.answer(progress, threads)
    if len(problem.restitutions) == 1:
        return result, None
    first = next(iter(result.datasets.values()))
    variables = {str(name): values.to_numpy() for name, values in first.data_vars.items()}
    return MapArrays(axes, variables, first.attrs), result


def _table(arguments: "Arguments") -> tuple[dict[str, Any], dict[str, str]]:
    """Return the table [map], and the given units by name of the axis."""
    axes, typed_units = {}, {}
    for option in ("x", "y"):
        axes[option], unit = _axis(f"--{option}", arguments.options[option])
        if unit:
            typed_units[axes[option]["axis"]] = unit
    if arguments.options["restitution"] and "restitution" in {axes["x"]["axis"], axes["y"]["axis"]}:
        raise UsageError("restitution is an axis of this map: remove --restitution")
    return arguments.table("map", {**arguments.values(MapTable), **axes}), typed_units


def _axis(option: str, text: str) -> tuple[dict[str, Any], str]:
    """Return the table of an axis, and the unit of the given values.

    >>> _axis("--x", "semi_diagonal=40cm,80cm")
    ({'axis': 'semi_diagonal', 'values': [0.4, 0.8]}, 'cm')
    """
    from rocking import checks
    from rocking.cli.numbers import values_table
    from rocking.studies.axis import axes

    name, equals, values = text.partition("=")
    available = axes()
    name = checks.spelling(name.strip(), available)
    if name not in available:
        hint = checks.nearest(name, available)
        raise UsageError(
            "{parameter}: unknown axis {axis!r:.60}; axes: {names}", parameter=option, axis=name,
            names=", ".join(sorted(available)), hint=hint,
        )  # fmt: skip
    if not equals or not values.strip():
        raise UsageError(
            "{parameter} must be {axis}=FIRST:LAST:COUNT or {axis}=A,B,C, got no values", parameter=option, axis=name
        )
    table, unit = values_table(name, values, available[name].unit)
    return {"axis": name, **table}, unit


@dataclass(frozen=True, eq=False)
class MapAnswer:
    """A map with the first restitution model, its safe islands, and its change with the model."""

    problem: "StudyProblem"
    arrays: "MapArrays"  # map with the first restitution model
    compared: Any  # maps with several restitution models, else None
    written: dict[str, str]  # given units by name of the axis
    length: str  # unit of lengths
    others: dict[str, Any]  # maps of the compared models
    details: bool = False

    @property
    def axes(self) -> "tuple[Axis, Axis]":
        return self.arrays.axes

    @property
    def restitution(self) -> str:
        """Label of the first restitution model, or `varied` if the restitution is an axis."""
        is_varied = "restitution" in {axis.name for axis in self.axes}
        return "varied" if is_varied else str(self.arrays.attributes["restitution"])

    @property
    def islands(self) -> Any:
        from rocking.studies.islands import safe_islands

        return safe_islands(self.arrays)

    @property
    def dataset(self) -> "xr.Dataset":
        """The map as a dataset, with dimension ``restitution`` for several models."""
        if self.compared is None:
            return self.arrays.to_xarray()
        from rocking.errors import extra

        xarray = extra("xarray", "a file of several maps")
        maps = self.compared.datasets
        over = xarray.DataArray(list(maps), dims="restitution", name="restitution")
        combined: xr.Dataset = xarray.concat(list(maps.values()), over, combine_attrs="drop_conflicts")
        return combined

    def unit(self, axis: "Axis") -> tuple[str, float]:
        """Return the given unit of an axis, by default its own, and the size of this unit."""
        from rocking.conventions import UNITS

        unit = self.written.get(axis.name, "")
        return (unit, UNITS[axis.unit][unit]) if unit else (axis.unit, 1.0)

    def draw(self) -> Any:
        from rocking.plots.labels import shown_in
        from rocking.plots.overturning_map import overturning_map_picture
        from rocking.studies.boundaries import boundary

        problem = self.problem
        lines = boundary(
            problem.bodies[0], problem.motions[0], *self.axes, problem.restitution,
            levels=problem.document.map.refine or 0, tolerance=_LINE, **problem.stated,
        ) if str(self.arrays.attributes["engine"]).startswith("fast") else []  # fmt: skip
        figure = overturning_map_picture(self.arrays.to_xarray(), lines)
        for which, axis in zip(("x", "y"), self.axes, strict=True):
            if axis.name in self.written:
                shown_in(figure.axes[0], which, *self.unit(axis))
        return figure

    def answer(self) -> Answer:
        """Return every cell, the islands, and the lowest values with overturning."""
        from rocking.cli.study import subject_values

        arrays, problem, islands = self.arrays, self.problem, self.islands
        axes = [{"name": axis.name, "values": axis.values} for axis in self.axes]
        names = ("cells", "area", "x", "y", "modes", "still_rocking")
        axis_of = dict(zip("xy", self.axes, strict=True))
        return Answer({
            **subject_values(problem),
            "restitution": self.restitution,
            "engine": arrays.attributes["engine"],
            "gravity": problem.settings.gravity,
            "linear": problem.settings.linear,
            "x": axes[0],
            "y": axes[1],
            "mode": arrays["mode"],
            "peak_ratio": arrays["peak_ratio"],
            "cells": arrays["mode"].size,
            "modes": mode_shares(arrays["mode"]),
            "refined_points": arrays.points,
            "islands": {
                "definition": islands.definition,
                "count": len(islands),
                "sentences": list(islands.sentences),
                "all": [{name: getattr(island, name) for name in names} for island in islands.islands],
            },
            "overturning": self.extent(),
            "contact": arrays.attributes["contact"],
            "sensitivity": self._sensitivity(),
            **model_facts(
                self.restitution, self.others, lambda maps: overturned(maps[0]["mode"]), problem.bodies[0]
            ),
            **({"headline": _VARIED} if self.restitution == "varied" else {}),
        }, {which: Quantity(which, axis.unit, axis.meaning, label=axis.name) for which, axis in axis_of.items()}
        | _RESTITUTIONS)  # fmt: skip

    def _sensitivity(self) -> dict[str, Any] | None:
        if self.compared is None:
            return None
        names = (
            "only_second",
            "only_first",
            "fraction_low",
            "fraction_high",
            "count",
            "compared",
            "unknown",
            "fraction",
        )
        pairs = [
            {"first": a, "second": b, **{name: getattr(flips, name) for name in names}} for a, b, flips in self._pairs()
        ]
        return {"baseline": self.compared.baseline, "pairs": pairs}

    def _pairs(self) -> list[tuple[str, str, Any]]:
        return [(a, b, self.compared.flips_between(a, b)) for a, b in combinations(self.compared.labels, 2)]

    def extent(self) -> dict[str, Any] | None:
        """Return the ranges of x and y with overturning, and the point of lowest y, or None if nothing overturns."""
        import numpy as np

        if self.arrays.points is not None:
            x, y, modes = (self.arrays[f"refined_{name}"] for name in ("x", "y", "mode"))
        else:
            x, y = (grid.ravel() for grid in np.meshgrid(*(axis.values for axis in self.axes)))
            modes = self.arrays["mode"].ravel()
        x, y = x[modes >= 0], y[modes >= 0]
        if not x.size:
            return None
        lowest = np.lexsort((x, y))[0]
        first = {"x": float(x[lowest]), "y": float(y[lowest])}
        return {"x": [float(x.min()), float(x.max())], "y": [float(y.min()), float(y.max())], "first": first}

    def show(self, page: Page) -> None:
        from rocking.cli.study import show_assumed, show_subject

        problem, answer = self.problem, self.answer()
        written = {which: self.written.get(axis.name, "") for which, axis in zip("xy", self.axes, strict=True)}
        display = Display(self.length, own=answer.quantities, units=written)
        varied = "friction" in {axis.name for axis in self.axes}
        show_subject(page, problem, display, self.arrays.attributes["motion"], varied=varied)
        for which in "xy":
            values = answer[which]["values"]
            page.line(f"{which}: {_span(display, which, (values[0], values[-1]))}, {values.size} values")
        page.line(f"Restitution: {answer['restitution']}")
        page.line()
        count = overturned(self.arrays["mode"])["overturned"]
        page.line(f"Overturning in {count} of {answer['cells']} cells.", "bold")
        page.values(_overturning_lines(display, answer))
        page.warn(filter(None, [answer["contact"]]))
        page.line()
        counted = replace(display, own={**answer.quantities, **_OUTCOMES})
        page.rows(_grouped(answer["modes"]), ("mode", "count", "share"), counted)
        if self.compared is not None:
            page.line()
            changed = replace(display, own={**answer.quantities, **_CHANGES})
            page.rows(answer["sensitivity"]["pairs"], _FLIPS, changed)
            page.line(self.compared.verdict)
        show_models(page, answer, display, answer["restitution"], overturned(self.arrays["mode"]))
        show_assumed(page, problem, details=self.details)
        if not self.details:
            page.line("Safe islands and engine: --details    Files: -o map.csv, -o map.png")
            return
        for line in answer["islands"]["sentences"]:
            page.line(line)
        if self.arrays.points is not None and self.problem.document.map.refine:
            page.line(f"Refined along boundaries: {self.arrays.points} points.")
        page.line(f"Engine: {answer['engine']}")


def _grouped(shares: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return one row per outcome; overturning after many impacts is one row."""
    late, rows = [row for row in shares if row["mode"] > _LAST], [row for row in shares if row["mode"] <= _LAST]
    if len(late) > 1:
        total = {name: sum(row[name] for row in late) for name in ("count", "share")}
        late = [{"mode": f"overturns after {_LAST + 1} or more impacts", **total}]
    return [*rows, *late]


def _overturning_lines(display: Display, answer: Answer) -> list[tuple[str, str]]:
    """Return labels and texts of the lowest point, the range and the safe islands of overturning."""
    lines = []
    if (extent := answer["overturning"]) is not None:
        lowest = ", ".join(_span(display, which, (extent["first"][which],) * 2) for which in "yx")
        lines += [("lowest overturning", lowest), ("range of overturning", _ranges(display, extent))]
    islands = answer["islands"]["all"]
    cells = sum(island["cells"] for island in islands)
    counts = f"{len(islands)}, with {cells} of {answer['cells']} cells" if islands else "0"
    lines += [("safe islands", counts)]
    return lines + [("largest safe island", _ranges(display, island)) for island in islands[:1]]


def _ranges(display: Display, area: dict[str, Any]) -> str:
    return ", ".join(_span(display, which, area[which]) for which in "xy")


def _span(display: Display, which: str, ends: Sequence[float]) -> str:
    low, high = (display.cell(which, end) for end in ends)
    entry = display.entry(which)
    return f"{entry.heading} {low if low == high else f'{low} to {high}'} {display.unit(entry)}".rstrip()
