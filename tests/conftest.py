"""Fixtures and settings of the library's tests."""

from fixtures import *  # noqa: F403

# programs that tests start as processes of their own
collect_ignore_glob = ["verification/durability/*", "regression/[cdg]*.py"]
