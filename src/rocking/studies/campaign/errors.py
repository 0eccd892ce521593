"""What a campaign refuses, and what stops it; in every case what is finished stays finished."""

from rocking.errors import RockingError


class CampaignError(RockingError):
    """Base of what a campaign refuses on purpose."""


class CampaignMismatchError(CampaignError):
    """The folder holds another campaign than the one that was asked for, or none."""


class CampaignBusyError(CampaignError):
    """Another process runs the same campaign."""


class CampaignStorageError(CampaignError):
    """The folder cannot be written: the disk is full, the folder is read-only, the device fails."""


class CampaignDamagedError(CampaignError):
    """A file of the campaign is not what was written."""


class CampaignIncompleteError(CampaignError):
    """Results were asked for before all histories are computed."""


class CampaignWorkerError(CampaignError):
    """Workers cannot compute a chunk: they die of it again and again, or refuse it."""


class CampaignInterrupted(KeyboardInterrupt):
    """The campaign was asked to stop, by Ctrl-C or SIGTERM, and has stopped; what is finished is safe.

    It is a `KeyboardInterrupt`, so that nothing that goes on after errors goes on after it.
    """
