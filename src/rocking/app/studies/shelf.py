"""The folder in which the studies of a server are: what is there, and how much room there is."""

import shutil
from pathlib import Path

from rocking.app.problems import TooLarge
from rocking.app.studies.names import is_id
from rocking.app.studies.study import Study
from rocking.app.studies.study_folder import StudyFolder
from rocking.studies.campaign import disk

_DELETED = ".deleted-"


def studies_in(folder: Path) -> dict[str, Study]:
    """Return the studies of an earlier server; none of them runs.

    Parameters
    ----------
    folder : Path
        Where they are; it is made if it is not there, and cleared of what was being made or deleted.

    Returns
    -------
    dict of str to Study
        By name in addresses.
    """
    disk.make_folder(folder)
    folder.chmod(0o700)
    studies = {}
    for path in list(folder.iterdir()):
        if path.name.startswith(_DELETED):
            shutil.rmtree(path, ignore_errors=True)
        if path.is_symlink() or not is_id(path.name):
            continue
        meta = StudyFolder(path).ended()
        if meta is None:  # killed while it was made: there is nothing in it that anybody would miss
            shutil.rmtree(path, ignore_errors=True)
            continue
        studies[path.name] = Study(StudyFolder(path), meta)
        studies[path.name].look()
    return studies


def remove(study: Study) -> None:
    """Remove a study from the disk; a server that is killed meanwhile does not find half of one.

    Parameters
    ----------
    study : Study
        The study, which nobody computes.
    """
    path = study.folder.path
    aside = path.with_name(f"{_DELETED}{path.name}")
    path.rename(aside)
    shutil.rmtree(aside, ignore_errors=True)


def check_room(folder: Path, wanted: int, limit: int) -> None:
    """Refuse a study for which there is no room.

    Parameters
    ----------
    folder : Path
        Where the studies are.
    wanted : int
        What its results need [byte].
    limit : int
        What all studies together may take [byte].

    Raises
    ------
    TooLarge
        With both numbers.
    """
    used = sum(path.lstat().st_size for path in folder.rglob("*") if path.is_file())
    room = min(shutil.disk_usage(folder).free, limit - used)
    if wanted > room:
        raise TooLarge(
            f"the results need about {wanted / 1e6:.1f} MB, and there is room for {max(room, 0) / 1e6:.1f} MB; "
            "delete studies that are no longer needed"
        )
