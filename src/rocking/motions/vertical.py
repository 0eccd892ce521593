"""Horizontal and vertical motion that come from two files, joined into one."""

import math

from rocking.errors import InvalidValueError
from rocking.motions.motion import GroundMotion


def with_vertical(horizontal: GroundMotion, vertical: GroundMotion) -> GroundMotion:
    """Return a motion with the samples of another one as its vertical part.

    Both are taken to start at the same instant.

    Parameters
    ----------
    horizontal : GroundMotion
        Horizontal motion; its name, metadata and step are kept.
    vertical : GroundMotion
        Motion whose acceleration is the vertical one, positive upwards, of the same step.

    Returns
    -------
    GroundMotion
        Both; if one is longer, both are cut to the shorter, which its provenance says.

    Raises
    ------
    InvalidValueError
        If one of them is no `GroundMotion` or has a vertical part already, or their steps differ.

    Examples
    --------
    >>> along, up = GroundMotion([0.0, 1.0, 2.0], 0.1), GroundMotion([0.0, 0.5], 0.1)
    >>> both = with_vertical(along, up)
    >>> both.acceleration.tolist(), both.vertical.tolist()
    ([0.0, 1.0], [0.0, 0.5])
    """
    _check("horizontal", horizontal)
    _check("vertical", vertical)
    if not math.isclose(horizontal.time_step, vertical.time_step, rel_tol=1e-9):
        raise InvalidValueError(
            f"vertical must have the step of horizontal, {horizontal.time_step:g} s, "
            f"got {vertical.time_step:g} s; resample one first"
        )
    sources = vertical.provenance or (f"samples of {vertical.name!r}",)
    provenance = [*horizontal.provenance, *(f"vertical part: {line}" for line in sources)]
    samples = min(len(horizontal), len(vertical))
    if len(horizontal) != len(vertical):
        provenance.append(f"components of {len(horizontal)} and {len(vertical)} samples, both cut to {samples}")
    return GroundMotion(
        horizontal.acceleration[:samples],
        horizontal.time_step,
        vertical.acceleration[:samples],
        horizontal.name,
        {**horizontal.metadata, **_told(horizontal, vertical)},
        tuple(provenance),
    )


def _check(which: str, motion: object) -> None:
    if not isinstance(motion, GroundMotion):
        raise InvalidValueError(
            f"{which} must be a GroundMotion, got {type(motion).__name__}; a pulse is sampled first"
        )
    if motion.vertical is not None:
        raise InvalidValueError(f"{which} must have no vertical part yet, got {motion!r:.200}; which one is meant?")


def _told(horizontal: GroundMotion, vertical: GroundMotion) -> dict[str, str]:
    name = vertical.metadata.get("component", "vertical")
    if name.casefold() == horizontal.metadata.get("component", "horizontal").casefold():
        # files that do not name their component: two of one name could not be written to one file
        name += " (vertical)"
    header = vertical.metadata.get("header")
    return {"vertical component": name} | ({} if header is None else {"vertical header": header})
