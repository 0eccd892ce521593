"""Speed compared with alternatives of a user, as ratios within one run."""
