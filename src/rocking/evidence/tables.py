"""Tables 1, 2 and 3 of Mao et al. (2024), recomputed beside what is printed."""

from dataclasses import dataclass

import numpy as np

from rocking.evidence.agreement import relative_error
from rocking.evidence.measurements import DataSet, datasets
from rocking.restitution import Housner, Ked


@dataclass(frozen=True, slots=True)
class Entry:
    """One printed number beside the recomputed one."""

    printed: float  # as the paper prints it
    recomputed: float  # by this package
    digits: int  # decimals that the paper prints

    @property
    def difference(self) -> float:
        """Printed minus recomputed."""
        return self.printed - self.recomputed

    @property
    def agrees(self) -> bool:
        """Whether the printed digits are those of the recomputed value."""
        return abs(self.difference) <= 0.5000001 * 10.0**-self.digits


@dataclass(frozen=True, slots=True)
class TableRow:
    """One row of a table of the paper."""

    label: str  # block or interface
    slenderness: float  # h/b [-]
    measured: float  # r_e, as printed [-]
    entries: dict[str, Entry]  # ``housner``, ``ked``, ``relative_error``: what the table prints


def recomputed(name: str) -> tuple[TableRow, ...]:
    """Return a data set of the paper with its printed columns recomputed.

    >>> all(row.entries["ked"].agrees for row in recomputed("table2"))
    True
    """
    data = datasets()[name]
    truth = {
        "housner": Housner().of_slenderness(data.slenderness),
        "ked": Ked().of_slenderness(data.slenderness),
    }
    truth["relative_error"] = relative_error(truth["housner"], data.coefficient)
    return tuple(
        TableRow(
            data.labels[i],
            float(data.slenderness[i]),
            float(data.coefficient[i]),
            {
                key: Entry(float(column[i]), float(truth[key][i]), _digits(name, key))
                for key, column in data.printed.items()
            },
        )
        for i in range(len(data))
    )


def mean_rows(data: DataSet) -> dict[float, float]:
    """Return the mean coefficient at each slenderness, as the paper forms Table 2 from Table 1.

    Returns slenderness to mean r [-].
    """
    return {
        float(ratio): float(data.coefficient[data.slenderness == ratio].mean()) for ratio in np.unique(data.slenderness)
    }


def _digits(name: str, key: str) -> int:
    if key == "relative_error":
        return 6
    if name == "table2":
        return 8 if key == "ked" else 6
    return 3
