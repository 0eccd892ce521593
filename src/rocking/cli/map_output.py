"""What `rocking map` computes, writes and draws."""

import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks
from rocking.bodies import Body
from rocking.cli import output
from rocking.cli.output import body_lines, motion_facts, plain, table, write_csv
from rocking.cli.simulate_question import restitution_from
from rocking.conventions import FloatArray, IntArray, percent
from rocking.dynamics.response import Motion
from rocking.errors import InvalidValueError
from rocking.studies.axis import Axis
from rocking.tables import to_netcdf

if TYPE_CHECKING:
    import xarray as xr

    from rocking.studies.islands import Islands
    from rocking.studies.sensitivity import Sensitivity

MOST_CELLS = 10_000_000
"""A larger map is a campaign."""

_LINE = 1e-4
"""How closely the boundary of a picture is bisected: finer than a pixel."""

_LAST = 3
"""Overturning after more impacts than that is printed together; JSON parts it."""

_MEANINGS = {-3: "not computed", -2: "not lifted", -1: "rocks, stays standing", 0: "overturns without impact"}


@dataclass(frozen=True)
class MapQuestion:
    """A map that has been asked for."""

    body: Body
    motion: Motion
    x: Axis  # x, y: the axes
    y: Axis
    restitutions: dict[str, Any]  # by the word that was given; the first is the map that is printed
    refine: int | None  # levels of refinement
    settings: dict[str, Any]  # as of `rocking.cli.output.settings_from`
    # units that axes were written in, by axis, in which they are printed and drawn
    written: dict[str, str] = field(default_factory=dict)

    @classmethod
    def of(
        cls,
        body: Body,
        motion: Motion,
        axes: tuple[str, str],
        restitution: Sequence[str] | None,
        refine: int | None,
        settings: dict[str, Any],
        *,
        drawn: bool = False,
    ) -> "MapQuestion":
        """Put the question together.

        Returns checked as far as the study does not check it.
        """
        (x, in_x), (y, in_y) = (axis_from(name, word) for name, word in zip(("--x", "--y"), axes, strict=True))
        written = {axis.name: unit for axis, unit in ((x, in_x), (y, in_y)) if unit}
        _check_size(x, y, drawn=drawn)
        words = list(restitution or ["ked"])
        twice = next((word for word in words if words.count(word) > 1), None)
        if twice is not None:
            raise InvalidValueError(f"--restitution {twice[:60]} is given twice")
        if restitution and "restitution" in {x.name, y.name}:
            raise InvalidValueError("--restitution is an axis of this map: leave the option out")
        if refine is not None and not 1 <= refine <= 12:
            raise InvalidValueError(f"--refine must be in [1, 12], got {refine}")
        if refine is not None and len(words) > 1:
            raise InvalidValueError("--refine is for one --restitution: several are compared cell by cell")
        return cls(body, motion, x, y, {word: restitution_from(word) for word in words}, refine, settings, written)

    def unit(self, axis: Axis) -> tuple[str, float]:
        """Return the unit that an axis was written in, its own if in none, and its size."""
        word = self.written.get(axis.name, "")
        return (word, output.UNITS[axis.unit][word]) if word else (axis.unit, 1.0)

    def answered(self, *, quiet: bool = False) -> "MapAnswer":
        """Compute the map, with every restitution."""
        from rocking.studies._overturning_map import overturning_map
        from rocking.studies.islands import safe_islands
        from rocking.studies.sensitivity import map_sensitivity

        first, several = next(iter(self.restitutions)), len(self.restitutions) > 1
        total = None if self.refine else self.x.values.size * self.y.values.size * len(self.restitutions)
        compared = None
        with output.bar("histories", total, quiet=quiet) as tell:
            options = {**self.settings, "progress": tell}
            given = (self.body, self.motion, self.x, self.y)
            if several:
                compared = map_sensitivity(*given, self.restitutions, **options)
                found = compared.datasets[first]
            else:
                found = overturning_map(*given, self.restitutions[first], refine=self.refine, **options)
        return MapAnswer(self, found, safe_islands(found), compared)


@dataclass(frozen=True, eq=False)
class MapAnswer:
    """A map, its islands, and how the restitution changes it."""

    question: MapQuestion  # what was asked
    found: "xr.Dataset"  # the map with the first restitution, as of `overturning_map`
    islands: "Islands"  # its safe islands
    compared: "Sensitivity | None"  # maps with all restitutions, where there are several

    @property
    def whole(self) -> "xr.Dataset":
        """Everything as one dataset, over ``restitution`` too where there are several."""
        if self.compared is None:
            return self.found
        from rocking.errors import extra

        xarray = extra("xarray", "a file of several maps")
        maps = self.compared.datasets
        over = xarray.DataArray(list(maps), dims="restitution", name="restitution")
        made: xr.Dataset = xarray.concat(list(maps.values()), over, combine_attrs="drop_conflicts")
        return made


def axis_from(option: str, word: str) -> tuple[Axis, str]:
    """Return an axis from one word.

    Returns written: unit that its values were written in, empty if none.

    >>> axis, unit = axis_from("--x", "semi_diagonal=40cm,80cm")
    >>> axis.values.tolist(), unit
    ([0.4, 0.8], 'cm')
    """
    from rocking.studies.axis import axes

    name, equals, values = word.partition("=")
    known = axes()
    name = checks.spelling(name.strip(), known)
    if name not in known:
        near = checks.nearest(name, known)
        raise InvalidValueError(f"{option}: no axis named {name!r:.60}; there are {', '.join(sorted(known))}{near}")
    if not equals or not values.strip():
        raise InvalidValueError(f"{option} must be {name}=FIRST:LAST:COUNT or {name}=A,B,C, got no values")
    kind = known[name]
    row, written = output.row(kind.name, values, kind.unit)
    return kind(row), written


def _check_size(x: Axis, y: Axis, *, drawn: bool) -> None:
    if x.values.size * y.values.size > MOST_CELLS:
        raise InvalidValueError(
            f"a map must have at most {MOST_CELLS} cells, got {x.values.size} x {y.values.size}; "
            "rocking campaign computes more"
        )
    if drawn and min(x.values.size, y.values.size) < 2:
        raise InvalidValueError("a picture needs at least two values along --x and along --y, got one")


def write(answer: MapAnswer, picture: Path | None, csv: Path | None, netcdf: Path | None) -> list[Path]:
    """Write what was asked for."""
    if picture is not None:
        _draw(answer, picture)
    if csv is not None:
        _write_csv(answer.whole, csv)
    if netcdf is not None:
        to_netcdf(answer.whole, netcdf)
    return [path for path in (picture, csv, netcdf) if path is not None]


def _draw(answer: MapAnswer, path: Path) -> None:
    from rocking.plots.labels import shown_in
    from rocking.plots.overturning_map import overturning_map_picture
    from rocking.plots.style import write as write_picture
    from rocking.studies.boundaries import boundary

    asked = answer.question
    lines = boundary(
        asked.body, asked.motion, asked.x, asked.y, next(iter(asked.restitutions.values())),
        levels=asked.refine or 0, tolerance=_LINE, **asked.settings,
    ) if str(answer.found.attrs["engine"]).startswith("fast") else []  # fmt: skip
    figure = overturning_map_picture(answer.found, lines)
    for which, axis in (("x", asked.x), ("y", asked.y)):
        if axis.name in asked.written:
            shown_in(figure.axes[0], which, *asked.unit(axis))
    write_picture(figure, path)


def _write_csv(found: "xr.Dataset", path: Path) -> None:
    import numpy as np

    cells = found.drop_dims("point", errors="ignore")
    dims = cells["mode"].dims
    grids = np.meshgrid(*(np.asarray(cells[name].values) for name in dims), indexing="ij")
    columns = dict(zip(dims, grids, strict=True))
    columns |= {name: np.asarray(cells[name].transpose(*dims).values) for name in cells.data_vars}
    # names of restitutions have no unit
    write_csv(path, {str(n): (values.ravel(), cells[n].attrs.get("units", "")) for n, values in columns.items()})


def as_json(answer: MapAnswer) -> str:
    """Return everything as JSON."""
    asked, found = answer.question, answer.found
    facts = {
        "body": repr(asked.body),
        "assumed": list(asked.body.assumed),
        "motion": motion_facts(asked.motion),
        "restitution": found.attrs["restitution"],
        "engine": found.attrs["engine"],
        "gravity_m_s2": asked.settings["gravity"],
        "linear": asked.settings["linear"],
        "x": {"name": asked.x.name, "unit": asked.x.unit, "values": asked.x.values.tolist()},
        "y": {"name": asked.y.name, "unit": asked.y.unit, "values": asked.y.values.tolist()},
        "mode": found["mode"].values.tolist(),
        "peak_ratio": plain(found["peak_ratio"].values),
        "cells": found["mode"].size,
        "modes": shares(answer),
        "refined_points": found.sizes.get("point"),
        "islands": {"count": len(answer.islands), "all": [_island(one) for one in answer.islands.islands]},
        "overturning": extent(answer),
        "contact": found.attrs["contact"],
        "sensitivity": _sensitivity(answer),
    }
    return json.dumps(facts, indent=1, allow_nan=False)


def show(answer: MapAnswer, length: str = "m") -> None:
    """Print the map in words."""
    from rich.console import Console

    console = Console(highlight=False, soft_wrap=True)
    asked, found = answer.question, answer.found
    for name, words in body_lines(asked.body, asked.settings["gravity"], length):
        console.print(f"{name + ':':13} {words}", markup=False)
    console.print(f"motion:       {asked.motion.name}", markup=False)
    console.print(f"restitution:  {found.attrs['restitution']};  engine: {found.attrs['engine']}", markup=False)
    for name, axis in (("x", asked.x), ("y", asked.y)):
        span = _span(answer, axis, (axis.values[0], axis.values[-1]))
        console.print(f"{name}:            {span.replace(' ', ', ', 1)}, {axis.values.size} values", markup=False)
    console.print()
    console.print(table(("how it ends", "cells", "share"), _share_rows(shares(answer))))
    console.print()
    for sentence in (_begins(answer), _islands_words(answer)):
        console.print(sentence, markup=False)
    if found.attrs["contact"]:
        console.print(f"! {found.attrs['contact']}", style="yellow", markup=False)
    if "point" in found.sizes:
        console.print(f"Refined along boundaries: {found.sizes['point']} points.", markup=False)
    if answer.compared is not None:
        console.print()
        console.print(table(*_flip_rows(answer), left=2))
        console.print(answer.compared.verdict, markup=False)


def shares(answer: MapAnswer) -> list[dict[str, Any]]:
    """Return how many cells end in which way.

    Returns mode, meaning, count, share [-], by mode.
    """
    modes, counts = np.unique(answer.found["mode"].values, return_counts=True)
    return [
        {"mode": mode, "meaning": meaning(mode), "count": count, "share": count / answer.found["mode"].size}
        for mode, count in zip(modes.tolist(), counts.tolist(), strict=True)
    ]


def meaning(mode: int) -> str:
    """Return a mode in words.

    >>> meaning(-1), meaning(2)
    ('rocks, stays standing', 'overturns after 2 impacts')
    """
    return _MEANINGS.get(mode) or f"overturns after {mode} impact{'s' if mode != 1 else ''}"


def extent(answer: MapAnswer) -> dict[str, Any] | None:
    """Return where overturning lies, of all points that were computed.

    Returns ``x`` and ``y``, least and greatest, and ``first``, the lowest point along y; None if nothing overturns.
    """
    x, y, modes = _points(answer)
    x, y = x[modes >= 0], y[modes >= 0]
    if not x.size:
        return None
    lowest = np.lexsort((x, y))[0]
    first = {"x": float(x[lowest]), "y": float(y[lowest])}
    return {"x": [float(x.min()), float(x.max())], "y": [float(y.min()), float(y.max())], "first": first}


def _points(answer: MapAnswer) -> tuple[FloatArray, FloatArray, IntArray]:
    found = answer.found
    if "point" in found.sizes:
        return found["refined_x"].values, found["refined_y"].values, found["refined_mode"].values
    x, y = np.meshgrid(answer.question.x.values, answer.question.y.values)
    return x.ravel(), y.ravel(), found["mode"].values.ravel()


def _begins(answer: MapAnswer) -> str:
    found, x, y = extent(answer), answer.question.x, answer.question.y
    if found is None:
        return "Nothing on this map overturns."
    first = found["first"]
    spans = f"{_span(answer, x, found['x'])}, {_span(answer, y, found['y'])}"
    return (
        f"Overturning begins at {y.name} = {_in_unit(answer, y, first['y'])}, where {x.name} = "
        f"{_in_unit(answer, x, first['x'])}; it lies within {spans}."
    )


def _islands_words(answer: MapAnswer) -> str:
    count = len(answer.islands)
    if not count:
        return "No safe islands: no survival on this map is surrounded by overturning."
    one, x, y = answer.islands[0], answer.question.x, answer.question.y
    spans = f"{_span(answer, x, one.x)}, {_span(answer, y, one.y)}"
    cells = f"{one.cells} cell{'s' if one.cells != 1 else ''}"
    return f"Safe islands: {count}; the largest has {cells}: {spans}."


def _island(island: Any) -> dict[str, Any]:
    return {"cells": island.cells, "area": island.area, "x": list(island.x), "y": list(island.y)}


def _sensitivity(answer: MapAnswer) -> dict[str, Any] | None:
    if answer.compared is None:
        return None
    names = ("count", "gained", "lost", "compared", "unknown", "share", "low", "high")
    pairs = [
        {"first": a, "second": b, **{n: plain(getattr(flips, n)) for n in names}} for a, b, flips in _pairs(answer)
    ]
    return {"baseline": answer.compared.baseline, "pairs": pairs}


def _pairs(answer: MapAnswer) -> list[tuple[str, str, Any]]:
    from itertools import combinations

    compared = answer.compared
    if compared is None:
        return []
    return [(a, b, compared.flips_between(a, b)) for a, b in combinations(compared.labels, 2)]


def _flip_rows(answer: MapAnswer) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
    head = ("restitution", "against", "flips", "share", "only with the second", "only with the first")
    rows: list[tuple[str, ...]] = [
        (a, b, str(f.count), percent(f.share), str(f.gained), str(f.lost)) for a, b, f in _pairs(answer)
    ]
    return head, rows


def _share_rows(told: list[dict[str, Any]]) -> list[tuple[str, ...]]:
    """Return a line for each way to end; under long records the many late ones are one line."""
    late = [one for one in told if one["mode"] > _LAST]
    rows = [one for one in told if one["mode"] <= _LAST]
    if len(late) > 1:
        words = f"overturns after {_LAST + 1} or more impacts"
        late = [{"meaning": words, "count": sum(one["count"] for one in late), "share": sum(o["share"] for o in late)}]
    return [(one["meaning"], str(one["count"]), f"{100.0 * one['share']:.2f} %") for one in [*rows, *late]]


def _span(answer: MapAnswer, axis: Axis, ends: Sequence[float]) -> str:
    unit, size = answer.question.unit(axis)
    low, high = (f"{end / size:.4g}" for end in ends)
    return f"{axis.name} {low if low == high else f'{low} to {high}'}{'' if unit == '1' else f' {unit}'}"


def _in_unit(answer: MapAnswer, axis: Axis, value: float) -> str:
    unit, size = answer.question.unit(axis)
    return f"{value / size:.4g}{'' if unit == '1' else f' {unit}'}"
