"""The probability that a body rocks, slides or overturns, of which not everything is known; and how good it was."""

from typing import TYPE_CHECKING

from rocking.lazy import exports

if TYPE_CHECKING:
    from rocking.prediction._predict import predict as predict
    from rocking.prediction._score import Validation as Validation
    from rocking.prediction._score import score as score
    from rocking.prediction.forecast import Prediction as Prediction
else:
    __all__, __getattr__, __dir__ = exports(__name__)
