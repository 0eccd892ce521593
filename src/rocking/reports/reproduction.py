"""Everything that `rocking paper` computes, in one object."""

from dataclasses import dataclass

from rocking.evidence._claims import Claim, claims
from rocking.evidence._errata import Erratum, errata
from rocking.evidence._league import LeagueRow, league
from rocking.evidence._verdict import verdict
from rocking.evidence.calibration import Calibration, calibrate
from rocking.evidence.coverage import Coverage, coverage
from rocking.evidence.tables import TableRow, recomputed

TABLES = {
    "Table 1": ("table1",),
    "Table 2": ("table2",),
    "Table 3": ("S", "M", "L"),
}
"""The paper's tables and the data sets they hold."""


@dataclass(frozen=True, eq=False, slots=True)
class Reproduction:
    """The paper, recomputed."""

    tables: dict[str, tuple[TableRow, ...]]  # Table to rows, printed beside recomputed
    claims: tuple[Claim, ...]  # every claim with its verdict
    errata: tuple[Erratum, ...]  # what recomputing found
    league: tuple[LeagueRow, ...]  # every model against every measurement
    calibration: Calibration  # the calibrated default
    coverage: Coverage  # how its intervals cover what they have not seen
    verdict: tuple[str, ...]  # what the evidence says, in words


def reproduce() -> Reproduction:
    """Recompute the paper."""
    standings = league()
    tables = {title: tuple(row for name in names for row in recomputed(name)) for title, names in TABLES.items()}
    return Reproduction(tables, claims(), errata(), standings, calibrate(), coverage(), verdict(standings))
