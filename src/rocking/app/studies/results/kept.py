"""Results as they are sent, kept beside the study: made once, by the process that computed it."""

from rocking import __version__
from rocking.app.answers import JsonAnswer
from rocking.app.studies.opened import OpenStudy
from rocking.app.studies.results import result_of
from rocking.app.studies.study_folder import StudyFolder
from rocking.studies.campaign import disk

NAME = f"result-{__version__}.json"
"""Another version may tell other things."""


def kept_result(folder: StudyFolder) -> bytes | None:
    """Return the result that was kept."""
    try:
        return (folder.path / NAME).read_bytes()
    except OSError:
        return None


def keep_result(study: OpenStudy) -> bytes:
    """Make the result of a finished study, and keep it."""
    data = bytes(JsonAnswer(result_of(study)).body)
    disk.write_new(study.folder.path / NAME, data)
    return data
