"""Do the calibrated intervals cover measurements that they have not seen? Exactly, from one grid."""

from dataclasses import dataclass

from rocking.conventions import FloatArray
from rocking.evidence.calibration import LEVEL, PosteriorGrid, normalised, posterior_grid
from rocking.evidence.measurements import DataSet, all_measurements


@dataclass(frozen=True, slots=True)
class Coverage:
    """How many left-out measurements fall into their intervals."""

    rows: int  # number of measurements
    one_by_one: int  # those inside the interval of a calibration without them
    # data set to the number inside, and of all, for a calibration without the whole set
    by_group: dict[str, tuple[int, int]]

    @property
    def sentence(self) -> str:
        """The counts in words."""
        groups = ", ".join(
            f"{inside} of {count} of {'Table 1' if name == 'table1' else 'group ' + name}"
            for name, (inside, count) in self.by_group.items()
        )
        return (
            f"Left out one by one, {self.one_by_one} of the {self.rows} measurements fall into their "
            f"{100.0 * LEVEL:.0f} % intervals; with a whole data set left out, {groups} do: for a new laboratory or "
            "interface the interval is too narrow where these counts fall short."
        )


def coverage(data: DataSet | None = None) -> Coverage:
    """Return the coverage of measurements that a calibration has not seen.

    The posterior without some rows is the posterior over their likelihood, so that one grid serves them all.
    """
    data = all_measurements() if data is None else data
    grid = posterior_grid(data)
    whole = grid.log_prior + grid.terms.sum(axis=-1)
    alone = sum(_inside(data, grid, i, normalised(whole - grid.terms[..., i])) for i in range(len(data)))
    groups = {}
    for name in dict.fromkeys(data.group):
        rows = [i for i, group in enumerate(data.group) if group == name]
        weight = normalised(whole - grid.terms[..., rows].sum(axis=-1))
        groups[name] = sum(_inside(data, grid, i, weight) for i in rows), len(rows)
    return Coverage(len(data), alone, groups)


def _inside(data: DataSet, grid: PosteriorGrid, row: int, weight: FloatArray) -> bool:
    from scipy.special import ndtr

    below = ndtr((data.coefficient[row] - grid.mean[..., row]) / grid.sd[..., row])
    share = float((weight * below).sum())
    return bool(0.5 * (1.0 - LEVEL) <= share <= 0.5 * (1.0 + LEVEL))
