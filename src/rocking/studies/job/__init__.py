"""Jobs: a TOML file says what a campaign computes; its results become files with their provenance."""

from rocking.studies.job.comparison import comparison
from rocking.studies.job.exporting import export, exports_of
from rocking.studies.job.findings import analyses, answer, assessment
from rocking.studies.job.folder import JobFolder, JobStatus, status_of, verified
from rocking.studies.job.forecasting import Forecast, forecast
from rocking.studies.job.job import Job
from rocking.studies.job.measures import measure_comparison

__all__ = [
    "Forecast",
    "Job",
    "JobFolder",
    "JobStatus",
    "analyses",
    "answer",
    "assessment",
    "comparison",
    "export",
    "exports_of",
    "forecast",
    "measure_comparison",
    "status_of",
    "verified",
]
