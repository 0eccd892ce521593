"""Long runs: each run is a command of the command line in its own process."""
