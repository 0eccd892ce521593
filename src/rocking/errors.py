"""One family of errors: everything this package refuses is a `RockingError`."""

import sys
import warnings
from importlib import import_module
from types import ModuleType

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
    "fastapi": "web",
}


class RockingError(Exception):
    """Base of every error that this package raises on purpose."""


class InvalidValueError(RockingError, ValueError):
    """A number or a word is outside its allowed range."""


class GeometryError(InvalidValueError):
    """An outline, a hole, a foot or a set of regions does not describe a body."""


class AsymmetricBodyError(RockingError, AttributeError):
    """A body that is not symmetric was asked for a quantity that depends on the side."""


class UnknownModelError(RockingError, LookupError):
    """No restitution model of that name, or a model was given parameters it does not have."""


class BodyFileError(RockingError):
    """A body file (TOML, WKT, GeoJSON, DXF) cannot be read as a body."""


class RecordError(RockingError):
    """A ground-motion file cannot be read: not recognised, ambiguous, damaged, or at odds with its own header."""


class MeasurementError(RockingError):
    """A file of a measurement cannot be read, is damaged, or what it holds is no free rocking."""


class MissingExtraError(RockingError, ImportError):
    """A feature needs an optional dependency that is not installed."""


class PureRockingWarning(UserWarning):
    """Pure rocking is not credible for a response: the body would slide or fly, see `friction` of `simulate`."""


class PlausibilityWarning(UserWarning):
    """A value can be computed with but was hardly meant: a wrong unit, most likely."""


class SlowEngineWarning(UserWarning):
    """The fast engine was not built, and the reference engine serves in its place."""


def how_to_install(what: str, module: str, error: ImportError) -> str:
    """Say what is missing and how to install it, for a `MissingExtraError`.

    Parameters
    ----------
    what, module : str
        What was asked for, and the optional dependency that it takes.
    error : ImportError
        Why that cannot be imported; it may itself miss another package.

    Returns
    -------
    str
        One sentence.

    Examples
    --------
    >>> how_to_install("reading DXF", "ezdxf", ImportError(name="ezdxf"))
    'reading DXF needs ezdxf: pip install "rocking[dxf]"'
    >>> how_to_install("a table", "xarray", ImportError(name="pandas"))
    'a table needs pandas: pip install pandas'
    """
    package = module.partition(".")[0]
    missing = (error.name or package).partition(".")[0]
    # quoted twice as every shell understands it; brackets alone are a pattern to some
    wanted = f'"rocking[{_EXTRAS[package]}]"' if package in _EXTRAS else missing
    return f"{what} needs {missing}: pip install {wanted}"


def extra(module: str, what: str) -> ModuleType:
    """Return an optional dependency.

    Parameters
    ----------
    module, what : str
        The dependency, and what it is needed for; one that is not installed raises `MissingExtraError`.

    Returns
    -------
    module
        The dependency.
    """
    try:
        return import_module(module)
    except ImportError as error:
        raise MissingExtraError(how_to_install(what, module, error)) from error


def warn(sentence: str, category: type[Warning]) -> None:
    """Warn at the line outside this package that asked.

    Parameters
    ----------
    sentence : str
        What to say.
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
    """Whether warnings of a class are ignored wherever they come from: their sentences need not be computed.

    Parameters
    ----------
    category : type
        Class of the warning.

    Returns
    -------
    bool
        False where a filter depends on the sentence or on the module that warns.

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
