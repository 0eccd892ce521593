"""Names of the record formats; a new one is one file and one line here."""

from rocking.motions.formats.record_format import RecordFormat

_HOMES: dict[str, tuple[str, str]] = {}


def formats() -> dict[str, RecordFormat]:
    """Return every record format by name.

    Returns
    -------
    dict of str to RecordFormat
        In the order in which they are tried.
    """
    from importlib import import_module

    return {name: getattr(import_module(f"rocking.motions.formats.{module}"), kind)() for name, (module, kind) in _HOMES.items()}
