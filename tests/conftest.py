"""Settings that all tests share: property tests draw the same examples on every run."""

from hypothesis import settings

# programs that tests start as processes of their own
collect_ignore_glob = ["verification/durability/*"]

settings.register_profile("rocking", derandomize=True, deadline=None, max_examples=40, database=None)
settings.load_profile("rocking")
