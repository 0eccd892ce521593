"""What `rocking map` computes, writes and draws."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking import checks
from rocking.bodies import Body
from rocking.cli import study_output as shared
from rocking.cli.files_output import write_csv
from rocking.cli.simulate_question import restitution_from
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


@dataclass(frozen=True)
class MapQuestion:
    """A map that has been asked for."""

    body: Body
    motion: Motion
    x: Axis  # x, y: the axes
    y: Axis
    choices: dict[str, Any]  # by the word that was given; the first is the map that is printed
    refine: int | None  # levels of refinement
    settings: dict[str, Any]  # as of `rocking.cli.study_output.settings_from`
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
        return (word, shared.UNITS[axis.unit][word]) if word else (axis.unit, 1.0)

    def answered(self, *, quiet: bool = False) -> "MapAnswer":
        """Compute the map, with every restitution."""
        from rocking.studies._overturning_map import overturning_map
        from rocking.studies.islands import safe_islands
        from rocking.studies.sensitivity import map_sensitivity

        first, several = next(iter(self.choices)), len(self.choices) > 1
        total = None if self.refine else self.x.values.size * self.y.values.size * len(self.choices)
        compared = None
        with shared.bar("histories", total, quiet=quiet) as tell:
            options = {**self.settings, "progress": tell}
            given = (self.body, self.motion, self.x, self.y)
            if several:
                compared = map_sensitivity(*given, self.choices, **options)
                found = compared.datasets[first]
            else:
                found = overturning_map(*given, self.choices[first], refine=self.refine, **options)
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
    from rocking.studies._axes import axes

    name, equals, values = word.partition("=")
    known = axes()
    name = checks.spelling(name.strip(), known)
    if name not in known:
        near = checks.nearest(name, known)
        raise InvalidValueError(f"{option}: no axis named {name!r:.60}; there are {', '.join(sorted(known))}{near}")
    if not equals or not values.strip():
        raise InvalidValueError(f"{option} must be {name}=FIRST:LAST:COUNT or {name}=A,B,C, got no values")
    kind = known[name]
    row, written = shared.row(kind.name, values, kind.unit)
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
    from rocking.plots.overturning_map import overturning_map_picture
    from rocking.plots.study_words import shown_in
    from rocking.plots.style import write as write_picture
    from rocking.studies._boundary import boundary

    asked = answer.question
    lines = boundary(
        asked.body, asked.motion, asked.x, asked.y, next(iter(asked.choices.values())),
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
