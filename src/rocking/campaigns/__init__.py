"""Campaigns: large numbers of histories, computed once in chunks despite interruptions."""

from rocking.campaigns.campaign import Campaign
from rocking.campaigns.dask_cluster import DaskExecutor
from rocking.campaigns.disk import (
    CampaignBusyError,
    CampaignDamagedError,
    CampaignError,
    CampaignIncompleteError,
    CampaignInterrupted,
    CampaignMismatchError,
    CampaignStorageError,
    CampaignWorkerError,
)
from rocking.campaigns.executors import Executor, Serial
from rocking.campaigns.status import Estimate, Progress

__all__ = [
    "Campaign",
    "CampaignBusyError",
    "CampaignDamagedError",
    "CampaignError",
    "CampaignIncompleteError",
    "CampaignInterrupted",
    "CampaignMismatchError",
    "CampaignStorageError",
    "CampaignWorkerError",
    "DaskExecutor",
    "Estimate",
    "Executor",
    "Progress",
    "Serial",
]
