"""What a batch in space hands back: arrays over body, motion, scale, restitution and start."""

import json
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.conventions import FloatArray, IntArray
from rocking.dynamics.exportable import Exportable
from rocking.errors import extra
from rocking.outcome import of_results, overturned
from rocking.quantities import attributes
from rocking.tables import Column, Table
from rocking.version import SOFTWARE

if TYPE_CHECKING:
    import xarray as xr

DIMENSIONS = ("body", "motion", "scale", "restitution", "start")
"""Axes of the arrays of a batch, in order."""

FLOATS = (
    "peak_tilt", "peak_time", "peak_spin", "overturning_time", "direction", "first_uplift", "end_time", "held", "lost",
)  # fmt: skip
WHOLES = ("outcome", "status", "over_contact", "over_number", "impacts", "uplifts", "events", "steps", "still_rocking")


@dataclass(frozen=True, eq=False)
class SpatialBatch(Exportable):
    """The results of a batch; every array has the shape (body, motion, scale, restitution, start).

    Parameters
    ----------
    shape : tuple of int
        Numbers of bodies, motions, scales, restitutions and starts.
    values : dict of str to ndarray
        The results by name, one after another; `rocking.quantities` has their meanings.
    engine : str
        Which engine ran, and how.
    labels : dict of str to list
        Names of motions and restitutions, and the scales.
    refused : dict of int to str
        Why a body was refused, by its number.
    provenance : dict of str to Any
        Bodies, starts and settings as plain values.

    Examples
    --------
    >>> batch = SpatialBatch((1, 1, 1, 1, 1), {"outcome": np.array([2]), "status": np.array([0])}, "none")
    >>> batch.overturned.item()
    1.0
    """

    shape: tuple[int, int, int, int, int]
    values: dict[str, np.ndarray] = field(repr=False)
    engine: str
    labels: dict[str, list[object]] = field(default_factory=dict, repr=False)
    refused: dict[int, str] = field(default_factory=dict)
    provenance: dict[str, Any] = field(default_factory=dict, repr=False)

    def __getitem__(self, name: str) -> np.ndarray:
        """Return an array by name, as the engine gives it: in `results` flags are NaN without a result."""
        return self.values[name].reshape(self.shape)

    def __len__(self) -> int:
        """Return the number of histories."""
        return int(np.prod(self.shape))

    @property
    def outcome(self) -> IntArray:
        """Codes of `Outcome`."""
        return self["outcome"]

    @property
    def status(self) -> IntArray:
        """Codes of `Status`."""
        return self["status"]

    @property
    def overturned(self) -> FloatArray:
        """1 where it overturned, 0 where it did not, NaN where there is no result."""
        return overturned(self.outcome)

    @property
    def still_rocking(self) -> FloatArray:
        """1 where it stands, but does not yet rest when its history ends, 0 where not, NaN where there is no result."""
        return of_results(self.outcome, self["still_rocking"])

    @property
    def results(self) -> dict[str, np.ndarray]:
        """All results by name, one after another; of flags, no result is neither 1 nor 0."""
        flags = {"overturned": self.overturned, "still_rocking": self.still_rocking}
        return self.values | {name: flag.ravel() for name, flag in flags.items()}

    @property
    def peak_tilt(self) -> FloatArray:
        """Largest tilt; a quarter turn if it overturned, NaN without result [rad]."""
        return self["peak_tilt"]

    @property
    def direction(self) -> FloatArray:
        """Direction in which it lies, from x towards y; NaN if it does not [rad]."""
        return self["direction"]

    @property
    def _stated(self) -> dict[str, Any]:
        refused = json.dumps({str(number): reason for number, reason in self.refused.items()})
        return {"software": SOFTWARE, "engine": self.engine, "refused": refused, **self.provenance}

    def exported(self) -> Table:
        """Return what the tables and files of this batch hold.

        Returns
        -------
        Table
            One row a history, with units and provenance.
        """
        places = dict(zip(DIMENSIONS, np.unravel_index(np.arange(len(self)), self.shape), strict=True))
        rows = {name: Column(places[name], "1", f"number of the {name}") for name in ("body", "motion", "start")}
        for name in ("motion", "restitution"):
            words = np.array([str(label) for label in self.labels[name]])
            key = "motion_name" if name == "motion" else name
            rows[key] = Column(words[places[name]], "", f"name of the {name}")
        rows["scale"] = Column(np.array(self.labels["scale"], dtype=np.float64)[places["scale"]], "1", "factor")
        rows |= {name: Column.of(name, values) for name, values in self.results.items()}
        return Table("history", rows, self._stated, no_unit="-")

    def to_xarray(self) -> "xr.Dataset":
        """Return the results as a labelled dataset with units and provenance.

        Returns
        -------
        xarray.Dataset
            Over body, motion, scale, restitution and start.
        """
        xarray = extra("xarray", "a labelled dataset")
        data = {
            name: (DIMENSIONS, values.reshape(self.shape), attributes(name)) for name, values in self.results.items()
        }
        made: xr.Dataset = xarray.Dataset(
            data, coords={name: (name, row) for name, row in self.labels.items()}, attrs=self._stated
        )
        return made
