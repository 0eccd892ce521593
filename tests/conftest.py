"""Settings that all tests share: property tests draw the same examples on every run."""

import signal

from hypothesis import settings

# programs that tests start as processes of their own
collect_ignore_glob = ["verification/durability/*"]

# Shells start what runs in their background with Ctrl-C ignored; tests press it, in processes of their own too.
signal.signal(signal.SIGINT, signal.default_int_handler)

settings.register_profile("rocking", derandomize=True, deadline=None, max_examples=40, database=None)
settings.load_profile("rocking")
