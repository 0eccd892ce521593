"""Fixtures and settings of the application's tests."""

from fixtures import *  # noqa: F403
