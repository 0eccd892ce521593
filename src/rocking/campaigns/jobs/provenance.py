"""Where results come from: version, inputs with their hashes, models, tolerances, seeds, platform."""

import hashlib
import platform
import sys
from importlib.metadata import version
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.campaigns.identity import software
from rocking.dynamics.plane import fast_engine
from rocking.restitution import RestitutionModel

if TYPE_CHECKING:
    from rocking.campaigns.jobs.job import Job


def provenance(job: "Job") -> dict[str, Any]:
    """Return where the results of a job come from; no time and no folder is in it.

    Returns plain values: the same for the same job, files, version and machine.
    """
    histories, document = job.study.histories, job.document
    return {
        "software": f"rocking {software()}",
        "campaign": document.campaign.name,
        "kind": document.campaign.kind,
        "note": document.campaign.note or "",
        "job": job.text,
        "job_sha256": hashlib.sha256(job.text.encode()).hexdigest(),
        "inputs": job.inputs,
        "histories": histories.count,
        "histories_key": histories.key(),
        "restitution": [_model(label, choice) for label, choice in job.problem.restitutions.items()],
        "settings": job.problem.settings.stated,
        "engine": _engine(job),
        "seeds": _seeds(job),
        "motions": _motions(job),
        "platform": {
            "system": platform.system(),
            "machine": platform.machine(),
            "byteorder": sys.byteorder,
            "python": platform.python_version(),
            "numpy": np.__version__,
            "scipy": version("scipy"),
        },
    }


def _model(label: str, choice: Any) -> dict[str, str]:
    told = {"label": label}
    return (
        told | {"title": choice.title, "reference": choice.reference} if isinstance(choice, RestitutionModel) else told
    )


def _engine(job: "Job") -> str:
    histories = job.study.histories
    chosen = fast_engine.chosen(histories.engine, histories.law)
    return f"{chosen} ({fast_engine.instruction_set()})" if chosen == "fast" else chosen


def _seeds(job: "Job") -> dict[str, Any]:
    motions = [table.seed or 0 for table in job.document.motions if table.synthetic is not None]
    draws = [choice.seed for choice in job.problem.restitutions.values() if hasattr(choice, "seed")]
    return {"campaign": job.document.campaign.seed, "motions": motions, "restitution": draws}


def _motions(job: "Job") -> dict[str, Any]:
    told = job.problem.motions.description()
    return {name: value for name, value in told.items() if name != "motions"} | {"count": len(job.problem.motions)}
