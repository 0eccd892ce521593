"""Errors and warnings of this package; all errors are subclasses of `RockingError`."""

import math
import reprlib
import sys
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict, replace
from importlib import import_module
from os import PathLike, sep
from pathlib import PurePath
from types import ModuleType
from typing import Any, Literal, Self, TypeVar

from rocking.messages import Amount, Message, Parameter, Place, Range, Spelling, as_message

_EXTRAS = {
    "jinja2": "report",
    "typst": "report",
    "ezdxf": "dxf",
    "h5netcdf": "netcdf",
    "h5py": "netcdf",
    "obspy": "obspy",
    "soundfile": "sound",
    "cv2": "video",
    "openpyxl": "excel",
    "pyarrow": "parquet",
    "distributed": "dask",
}


Family = TypeVar("Family", bound="RockingError")
_SHORT = reprlib.Repr()
_LONGEST = 500  # largest number of characters of a value in `data`


class RockingError(Exception):
    """Base class of all errors of this package.

    Parameters
    ----------
    text : str
        Error text in English; the default is "`parameter` must be `allowed`". With a parameter or facts, the text is a
        template with their names in braces.
    parameter : str
        Name of the refused parameter.
    value : object
        The refused value.
    allowed : Range or str
        The allowed values.
    hint : str or Message
        Remedy or likely cause.
    **facts : object
        Facts of the text by name.

    Attributes
    ----------
    places : tuple of Place
        Locations of the refused value: tables and files, the outermost first.
    more : int
        Number of further errors in the same input.

    Examples
    --------
    >>> str(InvalidValueError(parameter="friction", allowed="a number", value="low", hint="0.3 to 0.8"))
    "friction must be a number, got 'low'; 0.3 to 0.8"
    """

    def __init__(
        self,
        text: str = "",
        *,
        parameter: str = "",
        value: Any = None,
        allowed: Any = "",
        hint: str | Message = "",
        **facts: Any,
    ) -> None:
        if isinstance(text, Message):
            facts = {**text.facts, **facts}
            text = text.text
        super().__init__(text)
        self.text, self.facts, self.hint = text, facts, hint
        self._name, self.value, self.allowed = parameter, value, allowed
        self.places: tuple[Place, ...] = ()
        self.more = 0

    @property
    def parameter(self) -> str:
        """Path of the refused parameter in the input, such as body.block.width; empty if unknown."""
        tables = [location.name for location in self.places if location.kind in {"table", "key"}]
        return ".".join([*tables, *([self._name] if self._name else [])])

    @property
    def unit(self) -> str:
        """Unit of the allowed values; empty if the values have no unit."""
        allowed = self.allowed
        unit = allowed.facts.get("unit") if isinstance(allowed, Message) else getattr(allowed, "unit", None)
        return "" if unit in {None, "-", "1"} else str(unit)

    @property
    def cause(self) -> str:
        """Sentence without the hint."""
        return ": ".join([*map(str, self.places), str(self.message)])

    @property
    def message(self) -> Message:
        """Message without location and hint."""
        if not self._name:
            return Message(self.text, self.facts)
        parameter = Parameter(self.parameter, self._name)
        text = self.text or "{parameter} must be {allowed}, got {value}"
        refused = {"allowed": self.allowed, "value": _shown(self.value)}
        stated = {name: fact for name, fact in refused.items() if f"{{{name}}}" in text}
        return Message(text, {"parameter": parameter, **stated, **self.facts})

    @property
    def sentence(self) -> Message:
        """Location, error and hint as one message."""
        return self._sentence(self.places)

    def _sentence(self, places: Sequence[Place]) -> Message:
        sentence = self.message
        if isinstance(self.value, float) and self._name:  # for the decimal mark of the reader
            sentence = Message(sentence.text, {**sentence.facts, "value": Amount(self.value)} | self.facts)
        for location in reversed(places):
            sentence = Message("{location}: {fault}", {"location": str(location), "fault": sentence})
        if self.hint:
            sentence = Message("{fault}; {hint}", {"fault": sentence.clause(), "hint": as_message(self.hint)})
        return Message("{fault} (and {count} more)", {"fault": sentence, "count": self.more}) if self.more else sentence

    def data(self) -> dict[str, Any]:
        """Return the error as plain values.

        Returns
        -------
        dict
            `message` (the sentence), `parameter`, `value`, `allowed` (None, or its `sentence` and the ends of a range),
            `unit`, `text` with its `facts`, `hint`, `places`, `more`.
        """
        return {
            "message": str(self),
            "parameter": self.parameter,
            "value": _plain(self.value),
            "allowed": {"sentence": str(self.allowed), **_ends(self.allowed)} if self.allowed else None,
            "unit": self.unit,
            **self.message.data(),
            "hint": as_message(self.hint).data(),
            "places": [asdict(location) for location in self.places],
            "more": self.more,
        }

    def spelt(self, spelling: Spelling = str, *, within: bool = True) -> str:
        """Return the error as a sentence.

        Parameters
        ----------
        spelling : callable
            Function from a fact of `rocking.messages` to text; the default is the spelling of Python.
        within : bool
            True to include tables outside files.

        Returns
        -------
        str
            Places, error and hint.
        """
        places = list(self.places)
        while places and not within and places[0].kind == "table":
            places.pop(0)
        return self._sentence(places).spelt(spelling)

    def __str__(self) -> str:
        return self.spelt()

    def copied(self, kind: type[Family]) -> Family:
        """Return the error as an error of another class.

        Parameters
        ----------
        kind : type
            Class of the new error.

        Returns
        -------
        RockingError
            New error.
        """
        new = kind(
            self.text, parameter=self._name, value=self.value, allowed=self.allowed, hint=self.hint, **self.facts
        )
        new.places, new.more = self.places, self.more
        return new

    def add_hint(self, hint: str) -> None:
        """Add a hint to the existing hints.

        Parameters
        ----------
        hint : str
            Remedy.
        """
        if self.hint:
            hint = Message("{first}; {second}", {"first": as_message(self.hint).clause(), "second": hint})
        self.hint = hint

    def at(self, name: str, line: int = 0) -> Self:
        """Add a file as the outermost location of the error.

        Parameters
        ----------
        name : str
            Name of the file.
        line : int
            Line of the file, from 1; 0 for the entire file.

        Returns
        -------
        RockingError
            The error itself.
        """
        self.places = (Place(name, "file", line), *self.places)
        return self

    def without_file(self, name: str) -> Self:
        """Remove the name of a file from the locations of the error, but keep its line.

        Parameters
        ----------
        name : str
            Name of the file.

        Returns
        -------
        RockingError
            The error itself.
        """
        kept = (
            replace(location, name="") if (location.name, location.kind) == (name, "file") else location
            for location in self.places
        )
        self.places = tuple(location for location in kept if str(location))
        return self

    def without_folder(self, folder: str | PathLike[str], name: str = "") -> Self:
        """Remove a folder from the paths in the error.

        Parameters
        ----------
        folder : path
            Folder to remove.
        name : str
            Replacement for the folder itself.

        Returns
        -------
        RockingError
            The error itself.
        """

        def bare(text: Any) -> Any:
            text = str(text) if isinstance(text, PurePath) else text
            return text.replace(f"{folder}{sep}", "").replace(str(folder), name) if isinstance(text, str) else text

        self.text, self.hint, self.value = bare(self.text), bare(self.hint), bare(self.value)
        self.facts = {key: bare(fact) for key, fact in self.facts.items()}
        self.places = tuple(replace(location, name=bare(location.name)) for location in self.places)
        return self


def _plain(value: Any) -> Any:
    """Return a value for JSON: a number, text, true, false or None. Other values become their Python representation."""
    value = value.value if isinstance(value, Amount) else value
    value = _scalar(value)
    if value is None or isinstance(value, int) or (isinstance(value, float) and math.isfinite(value)):
        return value
    return value[:_LONGEST] if isinstance(value, str) else _SHORT.repr(value)[:_LONGEST]


def _scalar(value: Any) -> Any:
    """Return a number of numpy as a Python number, other values unchanged."""
    return value.item() if hasattr(value, "dtype") and not value.ndim else value


def _ends(allowed: Any) -> dict[str, Any]:
    """Return the limits of a range; None for infinite limits."""
    if not isinstance(allowed, Range):
        return {}
    low, high = (end if math.isfinite(end) else None for end in (allowed.low, allowed.high))
    return {"low": low, "high": high, "low_open": allowed.low_open, "high_open": allowed.high_open}


def _shown(value: Any) -> str:
    """Return the Python representation of a refused value, shortened."""
    value = _scalar(value)
    if isinstance(value, float):
        return f"{value:g}"
    text = _SHORT.repr(value) if isinstance(value, (list, tuple, dict, set)) else repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


@contextmanager
def located(name: str, kind: Literal["table", "file", "step"] = "table", number: int = 0) -> Iterator[None]:
    """Add a table, a file or a step to the locations (`places`) of errors that the ``with`` block raises.

    Parameters
    ----------
    name : str
        Name of the table, path of the file, or name of the step.
    kind : {"table", "file", "step"}
        Kind of the place.
    number : int
        Number of the step, from 1.

    Yields
    ------
    None
        Nothing.

    Examples
    --------
    >>> with located("pier.toml", "file"), located("block"):
    ...     raise InvalidValueError(parameter="width", allowed="a number", value="wide")
    Traceback (most recent call last):
    rocking.errors.InvalidValueError: pier.toml: block: width must be a number, got 'wide'
    """
    try:
        yield
    except MissingExtraError:
        raise
    except RockingError as error:
        inner = error.places[0] if error.places else None
        if inner is not None and inner.kind == kind == "file" and PurePath(name).name == inner.name:
            error.places = (Place(name, kind, inner.number), *error.places[1:])  # the same file with its folder
        elif inner is None or (inner.name, inner.kind) != (name, kind):
            error.places = (Place(name, kind, number), *error.places)
        raise


def reason_of(error: Exception) -> str:
    """Return the reason of an error of the operating system.

    Parameters
    ----------
    error : Exception
        The error.

    Returns
    -------
    str
        The reason; the wording for a missing file is that of all readers.

    Examples
    --------
    >>> (
    ...     reason_of(FileNotFoundError(2, "No such file or directory")),
    ...     reason_of(PermissionError(13, "Permission denied")),
    ... )
    ('no such file', 'Permission denied')
    """
    return "no such file" if isinstance(error, FileNotFoundError) else str(getattr(error, "strerror", None) or error)


class InvalidValueError(RockingError, ValueError):
    """A number or a word is outside its allowed range."""


class GeometryError(InvalidValueError):
    """An outline, a hole, a foot or a set of regions is no valid body."""


class AsymmetricBodyError(RockingError, AttributeError):
    """A quantity of an asymmetric body depends on the side."""


class UnknownModelError(RockingError, LookupError):
    """A restitution model, or one of its parameters, is unknown."""


class BodyFileError(RockingError):
    """A body file (TOML, WKT, GeoJSON, DXF) is not readable as a body."""


class RecordError(RockingError):
    """A ground-motion file is of unknown or ambiguous format, damaged, or contradicts its header."""


class MeasurementError(RockingError):
    """A measurement file is unreadable or damaged, or contains no free rocking."""


class MissingExtraError(RockingError, ImportError):
    """A feature needs an optional dependency that is not installed."""


class PureRockingWarning(UserWarning):
    """Pure rocking is not credible for a response: the body slides or flies, see `friction` of `simulate`."""


class PlausibilityWarning(UserWarning):
    """A value is allowed but implausible, for example because of a wrong unit."""


class SlowEngineWarning(UserWarning):
    """The fast engine is not built; the reference engine is used."""


def how_to_install(feature: str, module: str, error: ImportError) -> str:
    """Return the text of a `MissingExtraError`: the missing package and the command to install it.

    Parameters
    ----------
    feature, module : str
        Feature, and its optional dependency.
    error : ImportError
        Error of the import; another package may be missing.

    Returns
    -------
    str
        Sentence with the command for the installation.

    Examples
    --------
    >>> how_to_install("reading DXF", "ezdxf", ImportError(name="ezdxf"))
    'reading DXF needs ezdxf: pip install "rocking[dxf]"'
    >>> how_to_install("a table", "xarray", ImportError(name="pandas"))
    'a table needs pandas: pip install pandas'
    """
    package = module.partition(".")[0]
    missing = (error.name or package).partition(".")[0]
    # double quotes work in all shells; without quotes, some shells read brackets as a pattern
    package_name = f'"rocking[{_EXTRAS[package]}]"' if package in _EXTRAS else missing
    return f"{feature} needs {missing}: pip install {package_name}"


def extra(module: str, feature: str) -> ModuleType:
    """Return an optional dependency.

    Parameters
    ----------
    module, feature : str
        Dependency and feature; a missing dependency raises `MissingExtraError`.

    Returns
    -------
    module
        Imported module.
    """
    try:
        return import_module(module)
    except ImportError as error:
        raise MissingExtraError(how_to_install(feature, module, error)) from error


def warn(sentence: str, category: type[Warning]) -> None:
    """Warn at the calling line outside this package.

    Parameters
    ----------
    sentence : str
        Text of the warning.
    category : type
        Class of the warning.
    """
    level, frame = 1, sys._getframe(0)
    # constructors are called by `dataclasses.replace` too
    while frame.f_back is not None and frame.f_globals.get("__name__", "").partition(".")[0] in {
        "rocking",
        "dataclasses",
    }:
        level, frame = level + 1, frame.f_back
    warnings.warn(sentence, category, stacklevel=level)


def silenced(category: type[Warning]) -> bool:
    """Return True if warnings of a class are always ignored. Their texts need not be computed then.

    Parameters
    ----------
    category : type
        Class of the warning.

    Returns
    -------
    bool
        False if a filter depends on the text of the warning or on the module.

    Examples
    --------
    >>> with warnings.catch_warnings():
    ...     warnings.simplefilter("ignore", PureRockingWarning)
    ...     silenced(PureRockingWarning), silenced(PlausibilityWarning)
    (True, False)
    """
    for action, message, about, module, line in warnings.filters:
        if issubclass(category, about):
            return action == "ignore" and message is None and module is None and not line
    return False
