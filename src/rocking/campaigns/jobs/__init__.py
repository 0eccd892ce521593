"""Jobs: a TOML file describes a campaign; its results become files with their provenance."""

from rocking.campaigns.forecast import job_forecast as forecast
from rocking.campaigns.jobs.exporting import export
from rocking.campaigns.jobs.findings import analyses, answer, assessment, comparison, measure_comparison
from rocking.campaigns.jobs.folder import JobFolder, status_of, verified
from rocking.campaigns.jobs.job import Job

__all__ = [
    "Job",
    "JobFolder",
    "analyses",
    "answer",
    "assessment",
    "comparison",
    "export",
    "forecast",
    "measure_comparison",
    "status_of",
    "verified",
]
