"""The process of a study: `python -m rocking_workbench.studies.child FOLDER WORKERS`.

The process ends with the server, because its standard input is a pipe from the server. Exit codes: 0 done, 2 refused,
3 stopped (finished histories are stored).
"""

import json
import sys
import threading
import time
from pathlib import Path

from rocking_workbench.runs.process import STOPPED, end_with_the_server

DONE, REFUSED = 0, 2  # exit codes
_PATIENCE = 3.0


def main(arguments: list[str]) -> int:
    """Start or continue the campaign of a study."""
    threading.Thread(target=end_with_the_server, daemon=True).start()
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
    # the fast engine has its own threads; the reference engine needs processes for more than one core
    alone = workers == 1 or fast_engine.chosen(histories.engine, histories.law) == "fast"
    deadline = time.monotonic() + _PATIENCE
    while True:
        try:
            folder.run("serial" if alone else "processes", workers=workers)
        except CampaignBusyError:
            # the process of a killed server releases the campaign within a second
            if time.monotonic() > deadline:
                raise
            time.sleep(0.1)
        else:
            break
    keep_result(OpenStudy(study.name, StudyFolder(study), folder))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
