"""Shell completion of values; without a candidate the shell offers files."""

import os

import typer

_TABLES_OF_ALL = ("motion", "settings")


def words_on_the_line() -> list[str]:
    """Return the arguments after `rocking` during shell completion; empty otherwise."""
    if "_ROCKING_COMPLETE" not in os.environ:
        return []
    return os.environ.get("COMP_WORDS", os.environ.get("_TYPER_COMPLETE_ARGS", "")).split()[1:]


def models(incomplete: str) -> list[str]:
    """Return the 2D restitution models whose names begin with the text."""
    from rocking import restitution

    return [name for name in restitution.models() if name.startswith(incomplete)]


def every_model(incomplete: str) -> list[str]:
    """Return the 2D and 3D restitution models whose names begin with the text."""
    from rocking.restitution.space import spatial_models

    return models(incomplete) + [name for name in spatial_models() if name.startswith(incomplete)]


def examples(incomplete: str) -> list[str]:
    """Return the examples whose names begin with the text."""
    from rocking.examples import catalogue

    return [name for name in catalogue() if name.startswith(incomplete)]


def pulses(incomplete: str) -> list[str]:
    """Return the pulses whose names begin with the text. For an empty text, the shell offers files."""
    from rocking.motions.pulses import catalogue

    return [f"{name}:" for name in catalogue() if incomplete and name.startswith(incomplete)]


def keys(context: typer.Context, incomplete: str) -> list[str]:
    """Return the input-file keys of a command that begin with the text."""
    from rocking.spec.reference import keys_of

    command = context.info_name or ""
    tables = {"simulate": ("response", "restitution"), "identify": ("identify", "measurement")}.get(command, (command,))
    if command != "identify":
        tables = (*tables, *_TABLES_OF_ALL)
    all_keys = [f"{table}.{key}=" for table in tables for key in keys_of(table)]
    return [key for key in all_keys if key.startswith(incomplete)]
