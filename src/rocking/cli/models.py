"""`rocking models`: every restitution model with its source, assumptions, domain and defects."""

import json
import textwrap
from collections.abc import Sequence
from typing import Annotated

import typer


def models(
    name: Annotated[str | None, typer.Argument(help="One model, or my_file.py:MyModel; all if left out.")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """List the restitution models, in the plane and in space: reference, assumptions, domain, known defects."""
    from rocking import checks
    from rocking.restitution import RestitutionModel
    from rocking.restitution import models as registered
    from rocking.restitution.from_file import file_of, model_in_file
    from rocking.restitution.space import SpatialModel, spatial_models

    found: dict[str, type[RestitutionModel] | type[SpatialModel]] = {**registered(), **spatial_models()}
    if name is not None and file_of(name):
        found[name] = type(model_in_file(name))
    name = checks.spelling(name, found)
    if name is not None and name not in found:
        from rocking.errors import UnknownModelError

        near = checks.nearest(name, found)
        raise UnknownModelError(f"no restitution model named {name!r}; there are {', '.join(found)}{near}")
    chosen = {key: kind for key, kind in found.items() if name in (None, key)}
    facts = {
        key: {
            "title": kind.title,
            "reference": kind.reference,
            "assumptions": list(kind.assumptions),
            "domain": kind.domain,
            "known_defects": list(kind.known_defects),
        }
        for key, kind in chosen.items()
    }
    if as_json:
        print(json.dumps(facts, indent=2))
        return
    for key, entry in facts.items():
        print(f"{key}: {entry['title']}")
        for word in ("reference", "assumptions", "domain", "known_defects"):
            _print_fact(word.replace("_", " "), entry[word])
        print()


def _print_fact(word: str, value: Sequence[str]) -> None:
    for i, line in enumerate([value] if isinstance(value, str) else value):
        first = f"  {word + ':' if i == 0 else '':<15}"
        print(textwrap.fill(line, width=100, initial_indent=first, subsequent_indent=" " * 17))
