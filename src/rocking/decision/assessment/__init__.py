"""Assessment of overturning: histories with all models, margins, a probability, code methods and measures."""

from rocking.decision.assessment._assess import assess
from rocking.decision.assessment.answer import BodyAssessment, ModelMargin

__all__ = ["BodyAssessment", "ModelMargin", "assess"]
