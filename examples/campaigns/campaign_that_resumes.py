"""Interrupt and resume a campaign
===============================

A long study is interrupted and resumed. Finished chunks are safe, and the final files are the same as without
the interruption. For operators of large studies.
"""

import hashlib
from tempfile import TemporaryDirectory

import xarray

import rocking as rk
from rocking.campaigns import CampaignInterrupted
from rocking.campaigns.jobs import Job, JobFolder, export, forecast
from rocking.plots import overturning_map_picture, write

# %%
# A job is a file. The program estimates its size before the run.

job = Job.read(rk.examples.path("overturning-map"))
print(f"{job.document.campaign.name}: {dict(job.study.dims)}")
ahead = forecast(job)
print(f"{ahead.histories} histories, {ahead.chunks} chunk(s), {ahead.disk / 1e6:.1f} MB")


# %%
# The same job in nine chunks is interrupted after the second chunk, as by Ctrl-C. Then it is resumed, and also run
# without an interruption.


def stop(progress):
    """Stand in for Ctrl-C: the second chunk is the last for now."""
    if progress.chunks_done == 2:
        raise CampaignInterrupted("stopped on purpose")


smaller = job.text.replace("[campaign]", "[campaign]\nchunk = 4000").replace("count = 60", "count = 180")
small = Job.of_text(smaller, "job.toml", job.folder)
with TemporaryDirectory() as home:
    folder = JobFolder.create(f"{home}/stopped", small)
    try:
        folder.campaign.run(progress=stop)
    except CampaignInterrupted as pause:
        print(f"{pause}: {folder.campaign.status().chunks_done} of {folder.campaign.plan.chunks} chunks are safe")
    summary = JobFolder.open(f"{home}/stopped").campaign.run()
    print(f"resumed: {summary.computed} chunks computed, {summary.resumed} were there")

    whole = JobFolder.create(f"{home}/whole", small)
    whole.campaign.run()
    files = [export(each, f"{home}/{each.path.name}.csv") for each in (folder, whole)]
    first, second = (hashlib.sha256(path.read_bytes()).hexdigest() for path in files)
    print(f"SHA-256 of the results {first[:16]}, undisturbed {second[:16]}")
    assert first == second
    export(folder, "map.nc")

# %%
# The exported result is a usual map.

with xarray.open_dataset("map.nc", engine="h5netcdf") as found:
    write(overturning_map_picture(found.assign_attrs(restitution="ked")), "campaign_that_resumes.png")
