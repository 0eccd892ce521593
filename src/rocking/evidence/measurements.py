"""The published measurements, with their sources and intervals of rounding."""

import csv
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from importlib.resources import files
from typing import Any

import numpy as np

from rocking.conventions import FloatArray, IntArray
from rocking.exported import Exported
from rocking.tables import Column, Table
from rocking.tables.table import text_array

GROUPS = ("table1", "S", "M", "L")  # independent data sets, without Table 2, which contains means of Table 1

BANDS = (("h/b <= 3", 0.0, 3.0), ("3 < h/b <= 6", 3.0, 6.0), ("h/b > 6", 6.0, np.inf))
"""Slenderness bands of the league table: name, exclusive lower limit, inclusive upper limit."""

_COLUMNS = ("slenderness", "coefficient", "low", "high", "mass")
_WORDS = ("labels", "group", "interface", "laboratory")


@dataclass(frozen=True, eq=False, repr=False)
class DataSet(Exported):
    """Measured coefficients of restitution of homogeneous rectangular blocks.

    `to_dataframe()` returns one row per measurement, and `to_csv` writes these rows.

    Parameters
    ----------
    name, title, source : str
        Short name, title, and publication with DOI.
    slenderness : ndarray, shape (n,)
        Slenderness ratio h/b [-].
    coefficient : ndarray, shape (n,)
        Measured r, ratio of velocities [-].
    low, high : ndarray, shape (n,)
        Interval of rounding [-].
    mass : ndarray, shape (n,)
        Mass, NaN if not stated [kg].
    labels : tuple of str
        Block, or materials at the interface.
    group : tuple of str
        Data set of each row.
    printed : dict of str to ndarray
        The paper's own columns: ``housner``, ``ked``, ``relative_error``.
    interface : tuple of str
        Materials in contact, in alphabetic order, such as ``granite/granite``; empty if not stated.
    laboratory : tuple of str
        Laboratory; empty if not stated, which counts as a separate laboratory for each group and interface.
    """

    name: str
    title: str
    source: str
    slenderness: FloatArray
    coefficient: FloatArray
    low: FloatArray
    high: FloatArray
    mass: FloatArray
    labels: tuple[str, ...]
    group: tuple[str, ...]
    printed: dict[str, FloatArray]
    interface: tuple[str, ...] = ()
    laboratory: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        """Set missing interfaces and laboratories to empty strings."""
        for name in ("interface", "laboratory"):
            object.__setattr__(self, name, getattr(self, name) or ("",) * len(self.group))

    def __repr__(self) -> str:
        between = f", h/b {self.slenderness.min():g} to {self.slenderness.max():g}" if len(self) else ""
        return f"<DataSet {self.name}: {len(self)} measurements of r{between}>"

    def __len__(self) -> int:
        return len(self.slenderness)

    @cached_property
    def group_number(self) -> IntArray:
        """Index of each row's group in `GROUPS`."""
        return np.array([GROUPS.index(group) for group in self.group])

    def exported(self) -> Table:
        """Return one row per measurement.

        Returns
        -------
        Table
            Data set, block, interface and laboratory; slenderness ratio h/b [-], mass [kg], r [-] and its interval of
            rounding [-].

        Examples
        --------
        >>> table = datasets()["S"].to_dataframe()
        >>> print(*table[["block", "slenderness_ratio", "mass [kg]", "coefficient"]].iloc[0])
        S1 1.5 0.1133 0.69
        """
        texts = {
            "set": (self.group, "data set"),
            "block": (self.labels, "block, or materials at the interface"),
            "interface": (self.interface, "materials in contact"),
            "laboratory": (self.laboratory, "laboratory"),
        }
        columns = {name: Column(text_array(values), "", meaning) for name, (values, meaning) in texts.items()}
        columns["slenderness_ratio"] = Column.of("slenderness_ratio", self.slenderness)
        columns["mass"] = Column.of("mass", self.mass)
        columns["coefficient"] = Column.of("coefficient", self.coefficient)
        columns["low"] = Column(self.low, "1", "lower end of the interval of rounding")
        columns["high"] = Column(self.high, "1", "upper end of the interval of rounding")
        return Table("measurement", columns, provenance={"source": self.source})

    def rows(self, chosen: Sequence[int] | FloatArray) -> "DataSet":
        """Return selected rows, in the stated order.

        Parameters
        ----------
        chosen : sequence of int
            Indices, or a boolean mask of length n.

        Returns
        -------
        DataSet
            Selected rows.
        """
        index = np.arange(len(self))[np.asarray(chosen)]
        chosen_rows: dict[str, Any] = {name: getattr(self, name)[index] for name in _COLUMNS}
        chosen_rows |= {name: tuple(getattr(self, name)[i] for i in index.tolist()) for name in _WORDS}
        return replace(self, **chosen_rows, printed={key: column[index] for key, column in self.printed.items()})


@lru_cache(maxsize=1)
def datasets() -> dict[str, DataSet]:
    """Return the published data sets.

    Returns
    -------
    dict of str to DataSet
        ``table1`` (12 rows), ``table2`` (7 means), ``S``, ``M``, ``L`` (9 rows each).

    Examples
    --------
    >>> {name: len(data) for name, data in datasets().items()}
    {'table1': 12, 'table2': 7, 'S': 9, 'M': 9, 'L': 9}
    """
    first, second, third = (_read(f"mao2024_table{i}.csv") for i in (1, 2, 3))
    sets = {
        "table1": _dataset("table1", "table1", first, [row["block_and_base"] for row in first]),
        "table2": _dataset("table2", "table2", second, [f"h/b = {row['slenderness_ratio']}" for row in second]),
    }
    for name in ("S", "M", "L"):
        rows = [row for row in third if row["block"].startswith(name)]
        sets[name] = _dataset(name, "table3", rows, [row["block"] for row in rows])
    return sets


@lru_cache(maxsize=1)
def all_measurements() -> DataSet:
    """Return all independent measurements: Table 1 and the groups S, M, L.

    Returns
    -------
    DataSet
        39 rows.

    Examples
    --------
    >>> len(all_measurements())
    39
    """
    return joined([datasets()[name] for name in GROUPS], "all", "All 39 measurements")


def joined(sets: Sequence[DataSet], name: str, title: str) -> DataSet:
    """Return the measurements of several sets as one."""
    rows: dict[str, Any] = {column: np.concatenate([getattr(data, column) for data in sets]) for column in _COLUMNS}
    rows |= {text_column: tuple(word for data in sets for word in getattr(data, text_column)) for text_column in _WORDS}
    source = "; ".join(dict.fromkeys(data.source for data in sets))
    return DataSet(name=name, title=title, source=source, **rows, printed={})


def interface_of(text: str) -> str:
    """Return the materials of an interface in alphabetic order, independent of the upper material."""
    return "/".join(sorted(word.strip().lower() for word in text.split("/")))


@lru_cache(maxsize=1)
def blocks() -> DataSet:
    """Return the measurements of single blocks, Table 3: 27 rows, of the groups S, M and L."""
    data = all_measurements()
    return data.rows([k for k, group in enumerate(data.group) if group != "table1"])


def provenance() -> dict[str, object]:
    """Return the sources of the measurements and the interpretation of their rounding.

    >>> provenance()["doi"]
    '10.3390/buildings14072119'
    """
    text = files(__package__).joinpath("data", "provenance.toml").read_text(encoding="utf-8")
    return tomllib.loads(text)


def _read(name: str) -> list[dict[str, str]]:
    with files(__package__).joinpath("data", name).open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


def _dataset(name: str, table: str, rows: list[dict[str, str]], labels: list[str]) -> DataSet:
    facts = provenance()[table]
    assert isinstance(facts, dict)

    def column(key: str) -> FloatArray:
        values = np.array([float(row[key]) for row in rows])
        values.setflags(write=False)
        return values

    printed = {"housner": "r_housner_printed", "ked": "r_ked_printed", "relative_error": "relative_error_printed"}
    mass = 1e-3 * column("mass_g") if "mass_g" in rows[0] else np.full(len(rows), np.nan)
    return DataSet(
        name,
        str(facts["title"]),
        f"{provenance()['source']}, doi:{provenance()['doi']}",
        column("slenderness_ratio"),
        column("r_experiment"),
        column("r_low"),
        column("r_high"),
        mass,
        tuple(labels),
        (name,) * len(rows),
        {key: column(field) for key, field in printed.items() if field in rows[0]},
        tuple(interface_of(str(facts.get("interface", label))) for label in labels),
        (str(facts.get("laboratory", "")),) * len(rows),
    )
