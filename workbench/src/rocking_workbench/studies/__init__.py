"""Studies of the web application as campaigns: launch, progress, cancel, resume, results and export."""
