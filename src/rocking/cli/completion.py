"""What a shell offers where a value is typed; where that is nothing, it offers files by itself."""

import os

import typer

_TABLES_OF_ALL = ("motion", "settings")


def words_on_the_line() -> list[str]:
    """Return what follows `rocking` on the line that a shell wants completed; nothing where none does."""
    if "_ROCKING_COMPLETE" not in os.environ:
        return []
    return os.environ.get("COMP_WORDS", os.environ.get("_TYPER_COMPLETE_ARGS", "")).split()[1:]


def models(incomplete: str) -> list[str]:
    """Return the models of the impact whose names begin so."""
    from rocking import restitution

    return [name for name in restitution.models() if name.startswith(incomplete)]


def every_model(incomplete: str) -> list[str]:
    """Return the models, in the plane and in space, whose names begin so."""
    from rocking.restitution.space import spatial_models

    return models(incomplete) + [name for name in spatial_models() if name.startswith(incomplete)]


def examples(incomplete: str) -> list[str]:
    """Return the examples whose names begin so."""
    from rocking.examples import catalogue

    return [name for name in catalogue() if name.startswith(incomplete)]


def pulses(incomplete: str) -> list[str]:
    """Return the pulses whose names begin so, once a letter says that no file is meant."""
    from rocking.motions.pulses import catalogue

    return [f"{name}:" for name in catalogue() if incomplete and name.startswith(incomplete)]


def keys(context: typer.Context, incomplete: str) -> list[str]:
    """Return the keys of the tables of a command's question that begin so."""
    from rocking.spec.reference import keys_of

    command = context.info_name or ""
    tables = {"simulate": ("response", "restitution"), "identify": ("identify", "measurement")}.get(command, (command,))
    if command != "identify":
        tables = (*tables, *_TABLES_OF_ALL)
    every = [f"{table}.{key}=" for table in tables for key in keys_of(table)]
    return [key for key in every if key.startswith(incomplete)]
