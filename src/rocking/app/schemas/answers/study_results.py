"""What finished studies found: maps, spectra, counts and tables."""

from typing import Annotated, Literal

from pydantic import Field

from rocking.app.schemas.answers.answer import Answer
from rocking.app.schemas.answers.coordinate import Coordinate, Number, Result
from rocking.app.schemas.answers.fragility import FragilityResult

Grid = list[list[list[int]]]
"""By restitution, then rows along y."""


class Column(Answer):
    """A column of a table."""

    name: str
    unit: str
    words: str
    values: list[float | int | bool | str | None] = Field(description="in `unit`")


class Share(Answer):
    """How many histories end in one way."""

    mode: int = Field(description="-3 not computed, -2 not lifted, -1 stands, n >= 0 overturns after n impacts")
    meaning: str
    count: int
    share: float = Field(description="[-]")


class MapResult(Result):
    """An overturning map."""

    kind: Literal["overturning-map"]
    x: Coordinate
    y: Coordinate
    outcome: Grid = Field(description="0 not lifted, 1 stands, 2 overturned, 3 not computed")
    mode: Grid = Field(description="-3 not computed, -2 not lifted, -1 stands, n >= 0 overturns after n impacts")
    mode_words: dict[str, str]
    peak: list[list[list[Number]]] = Field(description="peak rotation over alpha [-]; null if it was not computed")
    impacts: Grid
    shares: list[list[Share]]
    contours: list[list[list[tuple[float, float]]]] = Field(description="lines x, y around what overturns, in units")
    body: str
    motion: str
    tables: dict[str, list[Column]] = Field(description="points and boundary of a refined map; else empty")


class SpectrumCurve(Answer):
    """One curve of a rocking spectrum; entries along `x`."""

    restitution: str
    angle: float = Field(description="slenderness angle [rad]")
    low: list[Number] = Field(description="16 % of the motions: peak over alpha [-]; null where they overturn")
    median: list[Number] = Field(description="peak rotation over alpha [-]; null where half of the motions overturn")
    high: list[Number] = Field(description="84 % of the motions: peak over alpha [-]; null where they overturn")
    overturned: list[float | None] = Field(description="share that overturns of the motions with a result [-]")
    coefficient: list[Number] = Field(description="of restitution [-]")


class SpectrumResult(Result):
    """Rocking spectra."""

    kind: Literal["rocking-spectrum"]
    x: Coordinate = Field(description="periods 2 pi / p")
    angles: Coordinate
    motions: Coordinate
    semi_diagonals: Coordinate
    curves: list[SpectrumCurve]
    shares: list[list[Share]]


Counted = list[list[list[int]]]


class Cells(Answer):
    """Counts by restitution, body and scale."""

    computed: Counted
    lifted: Counted
    overturned: Counted
    median_peak: list[list[list[Number]]] = Field(description="of those that stand: peak rotation over alpha [-]")


class HistoriesResult(Result):
    """Plain histories."""

    kind: Literal["histories"]
    motions: Coordinate
    bodies: Coordinate
    scales: Coordinate
    slenderness_angles: Coordinate
    shares: list[list[Share]]
    cells: Cells
    mode: list[list[list[list[int]]]] | None = Field(None, description="of each, where there are at most 20,000")
    peak: list[list[list[list[Number]]]] | None = Field(None, description="peak rotation over alpha of each [-]")


class MinimumResult(Result):
    """Minimum overturning accelerations."""

    kind: Literal["minimum-acceleration"]
    motions: Coordinate
    bodies: Coordinate
    tables: dict[str, list[Column]]


StudyResult = Annotated[
    MapResult | SpectrumResult | FragilityResult | HistoriesResult | MinimumResult, Field(discriminator="kind")
]
"""What a study found, by its kind."""
