"""Minimum overturning accelerations."""

from rocking.spec.fields import JobTable, Positive, key


class MinimumTable(JobTable):
    """Where and how closely to look for the accelerations at which a body begins or ceases to overturn."""

    lowest: Positive | None = key("where to begin; what lifts the body if not given [m/s2]")
    highest: Positive | None = key("where to end; 50 times what lifts the body if not given [m/s2]")
    points: int = key("first samples, in equal ratios", 400, ge=2, le=1_000_000)
    levels: int = key("how often suspicious intervals are halved, 0 to 12", 4, ge=0, le=12)
    tolerance: float = key("width of the last brackets over the acceleration [-]", 1e-12, ge=0.0, le=0.1)
