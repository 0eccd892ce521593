"""Target spectra for the selection and scaling of records: Eurocode 8, ASCE 7, or a table in a file."""

import csv
import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from rocking import checks
from rocking.conventions import ACCELERATION_UNITS, FloatArray
from rocking.errors import InvalidValueError, reason_of

# EN 1998-1:2004, Tables 3.2 and 3.3: S [-], TB, TC, TD [s] by type and ground
GROUNDS = {
    1: {"A": (1.0, 0.15, 0.4, 2.0), "B": (1.2, 0.15, 0.5, 2.0), "C": (1.15, 0.2, 0.6, 2.0),
        "D": (1.35, 0.2, 0.8, 2.0), "E": (1.4, 0.15, 0.5, 2.0)},
    2: {"A": (1.0, 0.05, 0.25, 1.2), "B": (1.35, 0.05, 0.25, 1.2), "C": (1.5, 0.1, 0.25, 1.2),
        "D": (1.8, 0.1, 0.3, 1.2), "E": (1.6, 0.05, 0.25, 1.2)},
}  # fmt: skip
LONGEST = 4.0  # largest period of the elastic spectrum in Eurocode 8 [s]; Annex A is for longer periods

_QUANTITY = re.compile(r"\s*((?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)\s*(\S*)\s*")
_UNIT = re.compile(r"[\[(_ ](m/s2|m/s\^2|m/s/s|cm/s2|cm/s\^2|gal|g)\s*[\])]?\s*$", re.IGNORECASE)
_ALLOWED = "eurocode8:ag=0.25g,ground=C,type=1, asce7:sds=1.0g,sd1=0.6g,tl=8, or a CSV file of period and acceleration"


@dataclass(frozen=True, eq=False)
class TargetSpectrum:
    """A pseudo-acceleration spectrum for comparison with records."""

    name: str
    damping: float  # damping ratio [-]
    longest: float  # largest defined period [s]
    shortest: float  # smallest defined period [s]
    of_periods: Callable[[FloatArray], FloatArray]  # pseudo-acceleration [m/s2] of an array of periods [s]

    def __call__(self, periods: ArrayLike) -> FloatArray:
        """Return the pseudo-spectral acceleration [m/s2] at periods within the defined range [s]."""
        validated = np.atleast_1d(checks.real_array("periods", periods, "s"))
        checks.all_within(f"periods of {self.name}", validated, self.shortest, self.longest, validated)
        return np.asarray(self.of_periods(validated), dtype=np.float64)


def eurocode8(ag: float, ground: str = "A", type: int = 1, damping: float = 0.05) -> TargetSpectrum:
    """Return the horizontal elastic response spectrum of Eurocode 8, EN 1998-1:2004, 3.2.2.2, up to 4 s.

    Parameters
    ----------
    ag : float
        Design acceleration on ground A, with the importance factor; a number with a unit, such as 0.25g [m/s2].
    ground : str
        Ground type, from A to E.
    type : int
        Spectrum type: 2 if earthquakes up to magnitude Ms 5.5 govern, else 1.
    damping : float
        Damping ratio [-].

    >>> eurocode8(2.0, "B")([0.3, 1.0]).round(12).tolist()
    [6.0, 3.0]
    """
    ag = checks.positive("ag", ag, "m/s2")
    kind = int(checks.one_of("type", str(type), ("1", "2")))
    s, b, c, d = GROUNDS[kind][checks.one_of("ground", str(ground).upper(), GROUNDS[1])]
    damping = checks.within("damping", damping, 0.0, 1.0, open_high=True, hint="a ratio, not a percentage")
    eta = max(float(np.sqrt(10.0 / (5.0 + 100.0 * damping))), 0.55)  # Eq. 307

    def spectrum(t: FloatArray) -> FloatArray:
        top = 2.5 * eta
        rising, long = 1.0 + t / b * (top - 1.0), np.maximum(t, c)
        falling = top * c / long * np.minimum(1.0, d / long)
        return np.asarray(ag * s * np.where(t < b, rising, falling), dtype=np.float64)  # Eq. 306

    name = f"Eurocode 8 type {kind}, ground {str(ground).upper()}, ag {ag:g} m/s2"
    return TargetSpectrum(name, damping, LONGEST, 0.0, spectrum)


def asce7(sds: float, sd1: float, tl: float) -> TargetSpectrum:
    """Return the design response spectrum of ASCE/SEI 7-16, 11.4.6, for 5 % damping.

    Parameters
    ----------
    sds : float
        Design acceleration at short periods; a number with a unit, such as 1g [m/s2].
    sd1 : float
        Design acceleration at 1 s; a number with a unit, such as 0.6g [m/s2].
    tl : float
        Long-period transition period [s].

    >>> asce7(10.0, 6.0, 8.0)([0.0, 0.3, 2.0, 16.0]).round(12).tolist()
    [4.0, 10.0, 3.0, 0.1875]
    """
    sds, sd1 = checks.positive("sds", sds, "m/s2"), checks.positive("sd1", sd1, "m/s2")
    ts, tl = sd1 / sds, checks.positive("tl", tl, "s")
    if not ts < tl:
        raise InvalidValueError(
            "{parameter} must be above sd1 / sds = {corner:.4g} s, got {value} s", parameter="tl", value=tl, corner=ts,
            hint="check the unit",
        )  # fmt: skip

    def spectrum(t: FloatArray) -> FloatArray:
        rising, long = 0.4 + 0.6 * t / (0.2 * ts), np.maximum(t, ts)
        return np.asarray(sds * np.minimum(rising, ts / long * np.minimum(1.0, tl / long)), dtype=np.float64)  # Eq. 308

    return TargetSpectrum(f"ASCE 7, SDS {sds:g}, SD1 {sd1:g} m/s2, TL {tl:g} s", 0.05, np.inf, 0.0, spectrum)


def in_file(path: Path, damping: float = 0.05) -> TargetSpectrum:
    """Return the spectrum of a CSV file with periods and accelerations. The heading contains the unit: ``Sa [g]``."""
    try:
        lines = path.read_text("utf-8-sig").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise InvalidValueError("the file cannot be read ({reason})", reason=reason_of(error)).at(str(path)) from error
    mark = next((mark for mark in ";\t," if mark in "".join(lines[:1])), ",")
    head, *rows = [row for row in csv.reader(lines, delimiter=mark) if any(row)] or [[]]
    unit = _UNIT.search(head[1].strip()) if len(head) > 1 else None
    if unit is None:
        raise InvalidValueError("the first line must contain column names with units, such as T [s], Sa [g]").at(
            path.name
        )
    factor = ACCELERATION_UNITS[re.sub(r"m/s(\^2|/s)", "m/s2", unit[1].lower())]
    try:
        t, a = np.array([[float(cell.replace(",", ".")) for cell in row[:2]] for row in rows], dtype=np.float64).T
    except ValueError as error:
        raise InvalidValueError(
            "every line must contain a period and an acceleration ({reason})", reason=str(error)
        ).at(path.name) from error
    if t.size < 2 or not (np.diff(t) > 0.0).all() or t[0] < 0.0 or not (a > 0.0).all() or not np.isfinite(a).all():
        raise InvalidValueError(
            "periods must be >= 0 and increase, and accelerations must be finite and above zero"
        ).at(path.name)

    def spectrum(periods: FloatArray) -> FloatArray:
        return np.asarray(np.exp(np.interp(periods, t, np.log(factor * a))), dtype=np.float64)

    return TargetSpectrum(path.name, damping, float(t[-1]), float(t[0]), spectrum)


def target_spectrum(text: Any, folder: Path | None = None) -> TargetSpectrum:
    """Return a target spectrum from a text, as on the command line and in input files.

    Parameters
    ----------
    text : str or TargetSpectrum
        ``eurocode8:ag=0.25g,ground=C,type=1``, ``asce7:sds=1.0g,sd1=0.6g,tl=8``, or a CSV file with a heading
        such as ``T [s], Sa [g]``. Accelerations require a unit.
    folder : Path, optional
        Folder of the file.

    Returns
    -------
    TargetSpectrum
        Target spectrum.

    Raises
    ------
    InvalidValueError
        If the spectrum is unknown, or a value is missing or outside its range.

    Examples
    --------
    >>> float(target_spectrum("eurocode8:ag=0.2g,ground=A")([0.2])[0].round(4))
    4.9033
    """
    if isinstance(text, TargetSpectrum):
        return text
    checks.of_kind("target", text, str, "text")
    name, colon, tail = text.partition(":")
    if name not in CODES or not colon:
        if (folder or Path()).joinpath(text).is_file():
            return in_file((folder or Path()) / text)
        raise InvalidValueError(
            "{parameter} must be {allowed}; got {value}", parameter="target", allowed=_ALLOWED, value=text
        )
    values: dict[str, Any] = {}
    for item in filter(None, tail.split(",")):
        key, _, value = (text.strip() for text in item.partition("="))
        values[key] = value if key in {"ground", "type"} else _acceleration(key, value)
    try:
        return CODES[name](**values)
    except TypeError as error:
        raise InvalidValueError(
            "{parameter} must be {allowed}; got {value}", parameter="target", allowed=_ALLOWED, value=text
        ) from error


CODES: dict[str, Callable[..., TargetSpectrum]] = {"eurocode8": eurocode8, "asce7": asce7}


def _acceleration(key: str, text: str) -> float:
    """Return a number. An acceleration is converted to m/s2."""
    match = _QUANTITY.fullmatch(text)
    is_acceleration = key in {"ag", "sds", "sd1"}
    if match is None or match[2] not in (ACCELERATION_UNITS if is_acceleration else {"", "s"}):
        like = "an acceleration with its unit such as 0.25g or 2.5m/s2" if is_acceleration else "a number such as 8"
        raise InvalidValueError(
            "{parameter} of a target must be {allowed}, got {value}", parameter=key, allowed=like, value=text
        )
    return float(match[1]) * (ACCELERATION_UNITS[match[2]] if is_acceleration else 1.0)
