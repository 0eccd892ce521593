"""Names of the record formats; a new one is one file and one line here."""

from importlib import import_module

from rocking import checks
from rocking.motions.formats.record_format import RecordFormat

LAST_RESORT = "columns"
"""Numbers without a header say nothing about themselves: tried only where no other format recognises a file."""

_HOMES: dict[str, tuple[str, str]] = {
    "peer": ("peer", "Peer"),
    "esm": ("esm", "Esm"),
    "cosmos": ("cosmos", "Cosmos"),
    "csmip-v1": ("csmip_v1", "CsmipV1"),
    "csmip-v2": ("csmip_v2", "CsmipV2"),
    "smc-usgs": ("smc_usgs", "SmcUsgs"),
    "smc-boore": ("smc_boore", "SmcBoore"),
    "knet": ("knet", "Knet"),
    "cwa": ("cwa", "Cwa"),
    "geonet-v2a": ("geonet", "GeonetV2A"),
    "bhrc": ("bhrc", "Bhrc"),
    "miniseed": ("miniseed", "MiniSeed"),
    "sac": ("sac", "Sac"),
    LAST_RESORT: ("columns", "Columns"),
}


def formats() -> dict[str, RecordFormat]:
    """Return every record format by name.

    Returns
    -------
    dict of str to RecordFormat
        In the order in which they are tried.
    """
    return {name: _load(name) for name in _HOMES}


def format_named(name: str) -> RecordFormat:
    """Return one record format.

    >>> format_named("peer").states_unit
    True
    """
    return _load(checks.one_of("format", name, _HOMES))


def _load(name: str) -> RecordFormat:
    module, kind = _HOMES[name]
    made: RecordFormat = getattr(import_module(f"rocking.motions.formats.{module}"), kind)()
    return made
