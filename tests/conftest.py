"""Settings that all tests share: property tests draw the same examples on every run."""

from hypothesis import settings

settings.register_profile("rocking", derandomize=True, deadline=None, max_examples=40, database=None)
settings.load_profile("rocking")
