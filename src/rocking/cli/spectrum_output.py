"""What `rocking spectrum` computes, prints, writes and draws.

Keys of the JSON
----------------
- ``motions`` (names), ``restitution``, ``scale``, ``linear``, ``gravity_m_s2``.
- ``slenderness_angle_rad``, ``period_s`` (2 pi / p), ``semi_diagonal_m`` (along the periods).
- ``mode``, ``peak_ratio``: by motion, slenderness, period; null where there is no number.
- ``curves``: motion, slenderness_angle_rad, counts ``not_lifted``, ``rocked``, ``overturned``, ``failed``,
  ``largest_peak_ratio`` (of those that stay standing), ``largest_overturned_period_s``; null where there is none.
"""

import json
import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking.cli import output
from rocking.cli.inputs import motion_from
from rocking.cli.output import plain, write_csv
from rocking.cli.simulate_question import restitution_from
from rocking.conventions import FloatArray
from rocking.dynamics.response import Motion
from rocking.errors import InvalidValueError
from rocking.tables import to_netcdf

if TYPE_CHECKING:
    import xarray as xr

_MOST = 10_000_000
"""Histories; more are a campaign."""


def motions_from(words: Sequence[str], told: dict[str, Any]) -> list[Motion]:
    """Return the motions that a command was given."""
    if not words:
        raise InvalidValueError(
            "what moves the ground? Give record files, or a pulse such as sine:amplitude=3,period=0.8"
        )
    return [motion_from(word, **told) for word in words]


def angles_from(word: str) -> FloatArray:
    """Return slenderness angles.

    Returns alpha, between 0 and pi/2 [rad].

    >>> angles_from("1,2").round(6).tolist(), angles_from("45deg").round(6).tolist()
    ([0.785398, 0.463648], [0.785398])
    """
    import numpy as np

    values, unit = output.row("--slenderness", word, "rad")
    highest, allowed = (0.5 * math.pi, "in (0, 90) deg") if unit else (1e9, "h/b, above 0")
    bad = values[~((values > 0.0) & (values < highest))]
    if bad.size:
        raise InvalidValueError(f"--slenderness must be {allowed}, got {bad[0]:g}{' rad' if unit else ''}; wrong unit?")
    return values if unit else np.arctan(1.0 / values)


def periods_from(word: str) -> FloatArray:
    """Return periods of blocks.

    Returns 2 pi / p, increasing [s].
    """
    import numpy as np

    values, _ = output.row("--periods", word, "s", "log")
    if np.any(values <= 0.0) or np.any(np.diff(values) <= 0.0):
        raise InvalidValueError(f"--periods must be above 0 s and increase, got {word!r:.60}")
    return values


def answer(
    motions: list[Motion],
    angles: FloatArray,
    periods: FloatArray,
    restitution: str,
    settings: dict[str, Any],
    *,
    quiet: bool = False,
) -> "xr.Dataset":
    """Compute the spectra.

    angles: slenderness angles [rad]; periods: 2 pi / p [s].
    """
    from rocking.studies._rocking_spectrum import rocking_spectrum

    total = len(motions) * angles.size * periods.size
    if total > _MOST:
        raise InvalidValueError(f"spectra must take at most {_MOST} histories, got {total}; rocking campaign does more")
    with output.bar("histories", total, quiet=quiet) as tell:
        return rocking_spectrum(motions, angles, periods, restitution_from(restitution), progress=tell, **settings)


def write(found: "xr.Dataset", picture: Path | None, csv: Path | None, netcdf: Path | None) -> list[Path]:
    """Write what was asked for."""
    if picture is not None:
        from rocking.plots.rocking_spectrum import rocking_spectrum_picture
        from rocking.plots.style import write as write_picture

        write_picture(rocking_spectrum_picture(found), picture)
    if csv is not None:
        table = found.to_dataframe().reset_index()
        write_csv(csv, {str(name): (table[name], found[name].attrs.get("units", "")) for name in table.columns})
    if netcdf is not None:
        to_netcdf(found, netcdf)
    return [path for path in (picture, csv, netcdf) if path is not None]


def as_json(found: "xr.Dataset") -> str:
    """Return everything as JSON."""
    facts = {
        "motions": [str(name) for name in found["motion"].values.tolist()],
        "restitution": found.attrs["restitution"],
        "scale": float(found.attrs["scale"]),
        "linear": bool(found.attrs["setting_linear"]),
        "gravity_m_s2": float(found.attrs["setting_gravity"]),
        "slenderness_angle_rad": found["slenderness_angle"].values.tolist(),
        "period_s": found["period"].values.tolist(),
        "semi_diagonal_m": found["semi_diagonal"].values.tolist(),
        "mode": found["mode"].values.tolist(),
        "peak_ratio": plain(found["peak_ratio"].values),
        "curves": curves(found),
        "contact": found.attrs["contact"],
    }
    return json.dumps(facts, indent=1, allow_nan=False)


def curves(found: "xr.Dataset") -> list[dict[str, Any]]:
    """Return what every curve shows.

    Returns as the key ``curves`` of the JSON.
    """
    made = []
    for i, name in enumerate(found["motion"].values.tolist()):
        for j, alpha in enumerate(found["slenderness_angle"].values.tolist()):
            one = found.isel(motion=i, slenderness_angle=j)
            made.append({"motion": str(name), "slenderness_angle_rad": alpha, **_curve(one)})
    return made


def _curve(one: "xr.Dataset") -> dict[str, Any]:
    mode, period = one["mode"].values, one["period"].values
    peaks, fallen = one["peak_ratio"].values[(mode == -1) | (mode == -2)], period[mode >= 0]
    return {
        "not_lifted": int((mode == -2).sum()),
        "rocked": int((mode == -1).sum()),
        "overturned": int((mode >= 0).sum()),
        "failed": int((mode == -3).sum()),
        "largest_peak_ratio": float(peaks.max()) if peaks.size else None,
        "largest_overturned_period_s": float(fallen.max()) if fallen.size else None,
    }


def show(found: "xr.Dataset") -> None:
    """Print a line for every curve."""
    from rich.console import Console

    from rocking.cli.output import table

    console = Console(highlight=False, soft_wrap=True)
    periods, sizes = found["period"].values, found["semi_diagonal"].values
    console.print(f"restitution:  {found.attrs['restitution']}", markup=False)
    console.print(
        f"blocks:       2 pi / p from {periods[0]:.4g} to {periods[-1]:.4g} s, R from {sizes[0]:.4g} to "
        f"{sizes[-1]:.4g} m, {periods.size} sizes",
        markup=False,
    )
    head = ("h/b", "alpha deg", "not lifted", "rocked", "overturned", "peak/alpha", "falls up to [s]")
    found_curves, each = curves(found), found.sizes["slenderness_angle"]
    for first in range(0, len(found_curves), each):
        console.print(f"\n{found_curves[first]['motion']}", style="bold", markup=False)
        console.print(table(head, [_row(one) for one in found_curves[first : first + each]], left=0))
    console.print(
        "\npeak/alpha is the largest of the blocks that stay standing; the last column is the largest 2 pi / p that "
        "overturns.",
        markup=False,
    )
    failed = sum(one["failed"] for one in found_curves)
    if failed:
        console.print(f"! {failed} histories could not be computed", style="yellow", markup=False)
    if found.attrs["contact"]:
        console.print(f"! {found.attrs['contact']}", style="yellow", markup=False)


def _row(one: dict[str, Any]) -> tuple[str, ...]:
    alpha, peak, last = (one[k] for k in ("slenderness_angle_rad", "largest_peak_ratio", "largest_overturned_period_s"))
    shape = (f"{1.0 / math.tan(alpha):.4g}", f"{math.degrees(alpha):.4g}")
    counts = tuple(str(one[name]) for name in ("not_lifted", "rocked", "overturned"))
    return *shape, *counts, *("-" if v is None else f"{v:.4g}" for v in (peak, last))
