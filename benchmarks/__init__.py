"""Speed against what a user would otherwise take, as ratios in one run."""
