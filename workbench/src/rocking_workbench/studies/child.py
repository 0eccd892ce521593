"""The process of a study: `python -m rocking_workbench.studies.child FOLDER WORKERS`.

The process ends with the server, because its standard input is a pipe that closes with the server. Exit codes: 0 done,
2 refused, 3 stopped (finished histories are safe).
"""

import contextlib
import json
import os
import signal
import sys
import threading
import time
from pathlib import Path

from rocking_workbench.studies import GRACE

DONE, REFUSED, STOPPED = 0, 2, 3  # exit codes
_PATIENCE = 3.0


def main(arguments: list[str]) -> int:
    """Start or continue the campaign of a study."""
    threading.Thread(target=end_with_the_server, daemon=True).start()
    with contextlib.suppress(OSError, AttributeError):
        os.nice(10)
    from rocking.campaigns import CampaignInterrupted
    from rocking.errors import RockingError
    from rocking.restitution.from_file import register_own
    from rocking_workbench.studies.study_folder import without_paths

    try:
        register_own()
        _compute(Path(arguments[0]), int(arguments[1]))
    except (CampaignInterrupted, KeyboardInterrupt):
        return STOPPED
    except RockingError as error:
        print(json.dumps({"error": without_paths(error, Path(arguments[0])).data()}), file=sys.stderr, flush=True)
        return REFUSED
    return DONE


def _compute(study: Path, workers: int) -> None:
    from rocking.campaigns import CampaignBusyError
    from rocking.campaigns.jobs import Job, JobFolder
    from rocking.dynamics.plane import fast_engine
    from rocking_workbench.studies.finished import OpenStudy
    from rocking_workbench.studies.results import keep_result
    from rocking_workbench.studies.study_folder import CAMPAIGN, JOB, StudyFolder

    campaign = study / CAMPAIGN
    begun = (campaign / JOB).is_file()
    folder = JobFolder.open(campaign, study) if begun else JobFolder.create(campaign, Job.read(study / JOB))
    histories = folder.job.study.histories
    # the fast engine has threads of its own; the reference engine needs processes to be quicker than one core
    alone = workers == 1 or fast_engine.chosen(histories.engine, histories.law) == "fast"
    deadline = time.monotonic() + _PATIENCE
    while True:
        try:
            folder.run("serial" if alone else "processes", workers=workers)
        except CampaignBusyError:
            # the process of a server that was killed lets go within a second
            if time.monotonic() > deadline:
                raise
            time.sleep(0.1)
        else:
            break
    keep_result(OpenStudy(study.name, StudyFolder(study), folder))


def end_with_the_server() -> None:
    """Wait for the end of the server, then end this process group."""
    with contextlib.suppress(OSError):
        while os.read(0, 1):
            pass
    with contextlib.suppress(OSError):
        os.kill(os.getpid(), signal.SIGINT)
    time.sleep(GRACE)
    if sys.platform == "win32":
        os._exit(STOPPED)
    else:
        # the workers too: the group is this process's own
        os.killpg(os.getpgrp(), signal.SIGKILL) if os.getpgrp() == os.getpid() else os._exit(STOPPED)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
