"""Campaign that resumes
=====================

A campaign from a job file: stopped in the middle, resumed, and the same bytes as one that nobody disturbed.
"""

import hashlib
from pathlib import Path
from tempfile import TemporaryDirectory

import xarray

from rocking import examples
from rocking.campaigns import CampaignInterrupted
from rocking.campaigns.jobs import Job, JobFolder, export, forecast
from rocking.plots import overturning_map_picture, write

job = Job.read(examples.path("overturning-map"))
print(f"{job.document.campaign.name}: {dict(job.study.dims)}")
ahead = forecast(job)
print(f"{ahead.histories} histories, {ahead.chunks} chunk(s), {ahead.disk / 1e6:.1f} MB")


def stop(progress):
    """Stand in for Ctrl-C: the second chunk is the last for now."""
    if progress.chunks_done == 2:
        raise CampaignInterrupted("stopped on purpose")


with TemporaryDirectory() as home:
    small = Job.of_text(
        job.text.replace("[campaign]", "[campaign]\nchunk = 4000").replace("count = 60", "count = 180"),
        "job.toml",
        job.folder,
    )
    folder = JobFolder.create(Path(home, "stopped"), small)
    try:
        folder.campaign.run(progress=stop)
    except CampaignInterrupted as pause:
        print(f"{pause}: {folder.campaign.status().chunks_done} of {folder.campaign.plan.chunks} chunks are safe")
    summary = JobFolder.open(Path(home, "stopped")).campaign.run()
    print(f"resumed: {summary.computed} chunks computed, {summary.resumed} were there")

    whole = JobFolder.create(Path(home, "whole"), small)
    whole.campaign.run()
    files = [export(each, Path(home, f"{each.path.name}.csv")) for each in (folder, whole)]
    first, second = (hashlib.sha256(path.read_bytes()).hexdigest() for path in files)
    print(f"SHA-256 of the results {first[:16]}, undisturbed {second[:16]}")
    assert first == second

    # what is exported is a map like any other
    with xarray.open_dataset(export(folder, Path(home, "map.nc")), engine="h5netcdf") as found:
        picture = overturning_map_picture(found.assign_attrs(restitution="ked"))
output = Path("gallery-output")
output.mkdir(exist_ok=True)
write(picture, output / "campaign_that_resumes.png")
