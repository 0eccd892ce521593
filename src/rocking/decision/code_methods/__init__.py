"""Code methods: published overturning criteria, compared with histories."""

from rocking.decision.code_methods.comparison import CalledSafe, CodeComparison, compare_code_methods
from rocking.decision.code_methods.methods import CODE_METHODS, LEFT_OUT

__all__ = [
    "CODE_METHODS",
    "LEFT_OUT",
    "CalledSafe",
    "CodeComparison",
    "compare_code_methods",
]
