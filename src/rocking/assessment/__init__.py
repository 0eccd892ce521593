"""Does it stand? Histories with every model, margins, a probability, code methods, and what to do, in one answer."""

from rocking.assessment._assess import assess
from rocking.assessment.answer import Assessment, ModelMargin
from rocking.assessment.remedies import Change, Remedies

__all__ = ["Assessment", "Change", "ModelMargin", "Remedies", "assess"]
