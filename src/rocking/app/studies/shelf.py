"""The folder in which the studies of a server are: what is there, and how much room there is."""

import os
import shutil
from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path

from rocking.app.problems import TooLarge
from rocking.app.studies.names import is_id
from rocking.app.studies.study import Study
from rocking.app.studies.study_folder import CAMPAIGN, FAILED, META, Meta, StudyFolder
from rocking.studies.campaign import disk

_DELETED = ".deleted-"
_UNREADABLE = f"its {META} cannot be read; nothing was changed: mend it and start the server again, or delete the study"


def studies_in(folder: Path) -> dict[str, Study]:
    """Return the studies of an earlier server; none of them runs."""
    disk.make_folder(folder)
    folder.chmod(0o700)
    studies = {}
    for path in list(folder.iterdir()):
        if path.name.startswith(_DELETED):
            shutil.rmtree(path, ignore_errors=True)
        if path.is_symlink() or not path.is_dir() or not is_id(path.name):
            continue
        meta = StudyFolder(path).ended()
        if meta is None and _half_made(path):
            shutil.rmtree(path, ignore_errors=True)
            continue
        studies[path.name] = Study(StudyFolder(path), meta or _unknown(path), unreadable=meta is None)
        studies[path.name].look()
    return studies


def _half_made(path: Path) -> bool:
    """Return whether its server was killed while it was made: there is nothing in it that anybody would miss."""
    try:
        return not {META, CAMPAIGN} & {each.name for each in path.iterdir()}
    except OSError:
        return False


def _unknown(path: Path) -> Meta:
    """Return what can be said of a study that is not understood, perhaps of a later version, and is left as it is."""
    created = datetime.fromtimestamp(path.lstat().st_mtime, UTC).isoformat(timespec="microseconds")
    return Meta(f"study {path.name}", "unknown", created.replace("+00:00", "Z"), 0, FAILED, _UNREADABLE)


def remove(study: Study) -> None:
    """Remove a study from the disk; a server that is killed meanwhile does not find half of one."""
    path = study.folder.path
    aside = path.with_name(f"{_DELETED}{path.name}")
    with suppress(FileNotFoundError):  # somebody was quicker
        path.rename(aside)
    shutil.rmtree(aside, ignore_errors=True)


def check_room(folder: Path, wanted: int, limit: int) -> None:
    """Refuse a study for which there is no room.

    wanted: what its results need [byte]; limit: what all studies together may take [byte].
    """
    used = _size(folder)
    room = min(shutil.disk_usage(folder).free, limit - used)
    if wanted > room:
        raise TooLarge(
            f"the results need about {wanted / 1e6:.1f} MB, and there is room for {max(room, 0) / 1e6:.1f} MB; "
            "delete studies that are no longer needed"
        )


def _size(folder: Path) -> int:
    """Return what the files in a folder take; others are deleted meanwhile, and are not missed."""
    total = 0
    for where, _, names in os.walk(folder):
        for name in names:
            with suppress(OSError):
                total += Path(where, name).lstat().st_size
    return total
