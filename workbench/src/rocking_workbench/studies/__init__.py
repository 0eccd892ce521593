"""Studies of the web application, which run as campaigns: launch, progress, cancel, resume, results and export."""
