"""The probability that a body rocks, slides or overturns, of which not everything is known; and how good it was."""

from typing import TYPE_CHECKING

from rocking.lazy import exports

if TYPE_CHECKING:
    from rocking.prediction._predict import predict
    from rocking.prediction._score import Validation, score
    from rocking.prediction.forecast import Prediction

__all__ = ["Prediction", "Validation", "predict", "score"]

__getattr__, __dir__ = exports(
    __name__,
    {
        "Prediction": "rocking.prediction.forecast",
        "Validation": "rocking.prediction._score",
        "predict": "rocking.prediction._predict",
        "score": "rocking.prediction._score",
    },
)
