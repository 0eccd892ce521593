"""Campaigns: very many histories in chunks that are computed once, whatever dies on the way."""

from rocking.studies.campaign.campaign import Campaign
from rocking.studies.campaign.dask_cluster import DaskExecutor
from rocking.studies.campaign.errors import (
    CampaignBusyError,
    CampaignDamagedError,
    CampaignError,
    CampaignIncompleteError,
    CampaignInterrupted,
    CampaignMismatchError,
    CampaignStorageError,
    CampaignWorkerError,
)
from rocking.studies.campaign.estimate import Estimate
from rocking.studies.campaign.executors import Executor
from rocking.studies.campaign.forecast import Forecast
from rocking.studies.campaign.reading import Piece, Verification
from rocking.studies.campaign.serial import Serial
from rocking.studies.campaign.status import Progress, Status, Summary

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
    "Forecast",
    "Piece",
    "Progress",
    "Serial",
    "Status",
    "Summary",
    "Verification",
]
