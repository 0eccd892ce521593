"""Studies of the web application as campaigns: launch, progress, cancel, resume, results and export."""

GRACE = 0.4  # time that a study has between the wish to stop and its end [s]
