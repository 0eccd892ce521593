"""The probability that a body rocks, slides or overturns, of which not everything is known."""

from typing import TYPE_CHECKING

from rocking.lazy import exports

if TYPE_CHECKING:
    from rocking.prediction._predict import predict
    from rocking.prediction.forecast import Prediction

__all__ = ["Prediction", "predict"]

__getattr__, __dir__ = exports(
    __name__, {"Prediction": "rocking.prediction.forecast", "predict": "rocking.prediction._predict"}
)
