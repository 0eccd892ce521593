"""Does it stand? Histories with every model, margins, a probability, code methods, and what to do, in one answer."""

from rocking.assessment._assess import assess
from rocking.assessment.answer import BodyAssessment, ModelMargin

__all__ = ["BodyAssessment", "ModelMargin", "assess"]
