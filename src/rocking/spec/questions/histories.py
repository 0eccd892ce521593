"""Every motion with every body, scale factor and restitution."""

from pydantic import Field

from rocking.spec.fields import JobTable, Numbers, Values


class HistoriesTable(JobTable):
    """What the histories of a campaign are made with, beside bodies, motions and restitutions."""

    scales: Numbers = Field(default_factory=lambda: Values(values=[1.0]), description="factors on the motions [-]")
