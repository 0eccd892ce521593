"""What the browser is told of a finished study, by its kind."""

from collections.abc import Callable
from typing import Any

import numpy as np

from rocking.app.studies.opened import OpenStudy
from rocking.app.studies.results.fragility import fragility_result
from rocking.app.studies.results.maps import map_result
from rocking.app.studies.results.products import product_result
from rocking.app.studies.results.spectra import spectrum_result
from rocking.app.studies.results.tables import minimum_result
from rocking.dynamics.lost_contact import contact_words, lost_contact

_BY_KIND: dict[str, Callable[[OpenStudy], dict[str, Any]]] = {
    "overturning-map": map_result,
    "minimum-acceleration": minimum_result,
    "rocking-spectrum": spectrum_result,
    "stripes": fragility_result,
    "incremental": fragility_result,
    "cloud": fragility_result,
    "histories": product_result,
}


def result_of(study: OpenStudy) -> dict[str, Any]:
    """Return the result of a finished study.

    Returns plain values and arrays, with None where there is no number.
    """
    document = study.job.job.document
    kind = str(document.campaign.kind)
    head = {"id": study.id, "kind": kind, "name": str(document.campaign.name), "contact": _contact(study, kind)}
    return {**head, "restitutions": list(study.job.job.parts.choices), **_BY_KIND[kind](study)}


def _contact(study: OpenStudy, kind: str) -> str:
    """In how many histories the ground would have to pull; empty if in none."""
    if kind != "minimum-acceleration":
        return contact_words(lost_contact(study.raw))
    searches = [found.lost_contact for found in study.answer.value if found is not None]
    return contact_words(np.concatenate(searches or [np.empty(0)]))
