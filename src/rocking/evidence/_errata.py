"""Printed and recomputed values of Mao et al. (2024): Tables 1 to 3, and errata, without correction of the data."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from rocking.conventions import FloatArray
from rocking.evidence.comparison import correlation, relative_error
from rocking.evidence.measurements import DataSet, datasets
from rocking.restitution import Housner, Ked


@dataclass(frozen=True, slots=True)
class Erratum:
    """A printed statement that recomputation does not confirm, or confirms in spite of a doubt."""

    name: str
    statement: str  # result of the recomputation
    evidence: str  # the numbers
    is_confirmed: bool  # True if the data confirm the erratum


def errata(data: dict[str, DataSet] | None = None) -> tuple[Erratum, ...]:
    """Check all errata in the paper's tables.

    Parameters
    ----------
    data : dict of str to DataSet, optional
        The paper's data sets (default), or modified ones for a negative control.

    Returns
    -------
    tuple of Erratum
        Errata in the order of the tables.

    Examples
    --------
    >>> all(erratum.is_confirmed for erratum in errata())
    True
    """
    tables = datasets() if data is None else data
    return tuple(Erratum(name, statement, *check(tables)) for name, statement, check in _CHECKS)


_Check = Callable[[dict[str, DataSet]], tuple[str, bool]]
_CHECKS: list[tuple[str, str, _Check]] = []


def _erratum(name: str, statement: str) -> Callable[[_Check], _Check]:
    def register(check: _Check) -> _Check:
        _CHECKS.append((name, statement, check))
        return check

    return register


@_erratum(
    "Table 1, relative errors",
    "The relative errors are not those of the r_H printed beside them but of the r_H of Table 2.",
)
def _relative_errors_use_other_column(tables: dict[str, DataSet]) -> tuple[str, bool]:
    first, second = tables["table1"], tables["table2"]
    other = dict(zip(second.slenderness.tolist(), second.printed["housner"].tolist(), strict=True))
    by_table_2 = np.array([other[ratio] for ratio in first.slenderness.tolist()])
    printed = first.printed["relative_error"]
    misfit_own = float(np.abs(relative_error(first.printed["housner"], first.coefficient) - printed).max())
    misfit_other = float(np.abs(relative_error(by_table_2, first.coefficient) - printed).max())
    return f"largest difference {misfit_own:.4f} with Table 1's own r_H, {misfit_other:.1e} with Table 2's", (
        misfit_other < 2e-6 < misfit_own
    )


@_erratum("Table 2, r_H", "The printed r_H are square roots of energy ratios rounded to two digits.")
def _rounded_energy_ratios(tables: dict[str, DataSet]) -> tuple[str, bool]:
    printed = tables["table2"].printed["housner"]
    ratios = np.round(printed**2, 2)
    misfit = float(np.abs(np.sqrt(ratios) - printed).max())
    return f"sqrt({', '.join(f'{ratio:.2f}' for ratio in ratios)}) to {misfit:.0e}", (misfit < 1e-6)


@_erratum("Table 2, a wrong r_H", "One r_H is wrong beyond any rounding of energy ratios.")
def _wrong_value(tables: dict[str, DataSet]) -> tuple[str, bool]:
    second = tables["table2"]
    truth = Housner().of_slenderness(second.slenderness)
    # an energy ratio rounded to two digits gives r with an error of up to 0.005 / (2 r)
    beyond = np.abs(second.printed["housner"] - truth) > 0.0051 / (2.0 * truth)
    where = [
        f"h/b = {ratio:g}: printed {p:.6f}, true {t:.6f}"
        for ratio, p, t in zip(
            second.slenderness[beyond], second.printed["housner"][beyond], truth[beyond], strict=True
        )
    ]
    return "; ".join(where) or "none", (len(where) == 1 and second.slenderness[beyond].tolist() == [4.33])


@_erratum(
    "Table 1, r_e",
    "The measured r_e are square roots of energy ratios with two digits: six printed digits, two of them real.",
)
def _experiments_are_rounded_energy_ratios(tables: dict[str, DataSet]) -> tuple[str, bool]:
    first = tables["table1"]
    ratios = np.round(first.coefficient**2, 2)
    misfit = float(np.abs(np.sqrt(ratios) - first.coefficient).max())
    half = 0.5 * (first.high - first.low)
    return f"to {misfit:.0e}; rounding half-width {half.min():.4f} to {half.max():.4f}", (misfit < 1e-6)


@_erratum(
    "Table 1, last relative error",
    "The last relative error is printed as 0 because both numbers were rounded to the same energy ratio.",
)
def _last_error_is_not_zero(tables: dict[str, DataSet]) -> tuple[str, bool]:
    first = tables["table1"]
    true = float(relative_error(Housner().of_slenderness(first.slenderness[-1:]), first.coefficient[-1:])[0])
    printed = float(first.printed["relative_error"][-1])
    return f"printed {printed:g}, {true:.4f} against the true r_H", (printed == 0.0 and true > 0.001)


@_erratum("Table 2, true r_H", "Housner's model gives other values than those printed, in all rows but the first.")
def _true_housner_of_table_2(tables: dict[str, DataSet]) -> tuple[str, bool]:
    second = tables["table2"]
    truth = Housner().of_slenderness(second.slenderness)
    off = int((np.abs(truth - second.printed["housner"]) > 0.5e-6).sum())
    return ", ".join(f"{value:.6f}" for value in truth), (off == len(second) - 1)


@_erratum(
    "Correlation", "The correlation does not distinguish the models: Housner's is equal, and higher in S, M and L."
)
def _housner_correlates_as_well(tables: dict[str, DataSet]) -> tuple[str, bool]:
    pairs = []
    for name in ("table2", "S", "M", "L"):
        data = tables[name]
        pairs.append(
            tuple(correlation(model.of_slenderness(data.slenderness), data.coefficient) for model in (Housner(), Ked()))
        )
    correlations = ", ".join(f"{housner:.4f} / {ked:.4f}" for housner, ked in pairs)
    return f"Housner / KED for Table 2, S, M, L: {correlations}", (
        all(abs(housner - ked) < 0.005 for housner, ked in pairs) and all(h > k for h, k in pairs[1:])
    )


@_erratum("Table 3, number of blocks", "According to section 3.1 each set has 10 blocks; Table 3 lists fewer.")
def _missing_blocks(tables: dict[str, DataSet]) -> tuple[str, bool]:
    counts = [len(tables[name]) for name in ("S", "M", "L")]
    return f"{counts} rows in S, M, L", (counts == [9, 9, 9])


@_erratum(
    "Table 3, M7",
    "The text of the article runs mass and slenderness of M7 together (16346.75); 1634 g and 6.75 are meant.",
)
def _run_together(tables: dict[str, DataSet]) -> tuple[str, bool]:
    group = tables["M"]
    row = group.labels.index("M7")
    # masses of a group are proportional to slenderness, which gives the number of digits of the mass
    others = np.arange(len(group)) != row
    per_ratio = float(np.median(group.mass[others] / group.slenderness[others]))
    expected = per_ratio * float(group.slenderness[row])
    return (
        f"mass {1e3 * group.mass[row]:.0f} g, {1e3 * expected:.0f} g by proportion to the other blocks of the group",
        (abs(float(group.mass[row]) / expected - 1.0) < 0.01),
    )


@_erratum(
    "Agreement with experiment",
    "KED is closer to the experiment than Housner in about half of the rows, and in none above slenderness 6.",
)
def _closer_in_half(tables: dict[str, DataSet]) -> tuple[str, bool]:
    sets = [tables[name] for name in ("table1", "S", "M", "L")]
    won, slender = [np.array(closer_rows(data)) for data in sets], [data.slenderness > 6.0 for data in sets]
    total, of_table_3 = (sum(int(data.sum()) for data in wins) for wins in (won, won[1:]))
    count, of = (sum(map(len, subset)) for subset in (sets, sets[1:]))
    above = sum(int((closer & tall).sum()) for closer, tall in zip(won, slender, strict=True))
    rows_above = sum(int(tall.sum()) for tall in slender)
    return f"{total} of {count} rows, {of_table_3} of {of} in Table 3, {above} of {rows_above} above 6", (
        total == 21 and count == 39 and of_table_3 == 13 and above == 0
    )


def closer_rows(data: DataSet) -> list[bool]:
    """Return one flag per row: True if KED is closer to the measurement than Housner's model."""
    ked = np.abs(Ked().of_slenderness(data.slenderness) - data.coefficient)
    housner = np.abs(Housner().of_slenderness(data.slenderness) - data.coefficient)
    return [bool(closer) for closer in ked < housner]


@dataclass(frozen=True, slots=True)
class Entry:
    """A printed number and its recomputed value."""

    printed: float  # printed value
    recomputed: float  # recomputed value
    digits: int  # number of printed decimals

    @property
    def difference(self) -> float:
        """Printed minus recomputed."""
        return self.printed - self.recomputed

    @property
    def agrees(self) -> bool:
        """True if the recomputed value rounds to the printed digits."""
        return abs(self.difference) <= 0.5000001 * 10.0**-self.digits


@dataclass(frozen=True, slots=True)
class TableRow:
    """One row of a table of the paper."""

    label: str  # block or interface
    slenderness: float  # h/b [-]
    measured: float  # r_e, as printed [-]
    # ``measured``, ``housner``, ``ked``, ``relative_error``: printed values that can be recomputed
    entries: dict[str, Entry]


def agreement(rows: Sequence[TableRow]) -> str:
    """Return the number of printed values that agree, and the number that cannot be recomputed, as text."""
    entries = [entry for row in rows for entry in row.entries.values()]
    agreeing = f"{sum(entry.agrees for entry in entries)} of {len(entries)} printed values agree in all digits"
    missing = sum("measured" not in row.entries for row in rows)
    return f"{agreeing}; {missing} measured r_e cannot be recomputed" if missing else agreeing


def _roots() -> FloatArray:
    """Return the r_e of Table 1 as roots of energy ratios with two digits [-]."""
    return np.asarray(np.sqrt(np.round(datasets()["table1"].coefficient ** 2, 2)))


def _means() -> FloatArray:
    """Return the r_e of Table 2 as means of Table 1 at equal slenderness [-]."""
    first, second = datasets()["table1"], datasets()["table2"]
    return np.array([first.coefficient[first.slenderness == ratio].mean() for ratio in second.slenderness])


_MEASURED: dict[str, Callable[[], FloatArray]] = {"table1": _roots, "table2": _means}
"""Functions that recompute measured values; values of Table 3 are data, and tests compare them with the article."""


def recomputed(name: str) -> tuple[TableRow, ...]:
    """Return a data set of the paper with its printed columns recomputed."""
    data = datasets()[name]
    truth = {
        "housner": Housner().of_slenderness(data.slenderness),
        "ked": Ked().of_slenderness(data.slenderness),
    }
    digits = {"measured": 6, "relative_error": 6} | ({"ked": 8, "housner": 6} if name == "table2" else {})
    truth["relative_error"] = relative_error(truth["housner"], data.coefficient)
    printed = dict(data.printed)
    if name in _MEASURED:
        truth["measured"], printed = _MEASURED[name](), {"measured": data.coefficient, **printed}
    return tuple(
        TableRow(
            data.labels[i],
            float(data.slenderness[i]),
            float(data.coefficient[i]),
            {key: Entry(float(column[i]), float(truth[key][i]), digits.get(key, 3)) for key, column in printed.items()},
        )
        for i in range(len(data))
    )
