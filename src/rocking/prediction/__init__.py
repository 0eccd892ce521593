"""The probability that a body rocks, slides or overturns, of which not everything is known."""

from typing import TYPE_CHECKING

from rocking.lazy import exports

if TYPE_CHECKING:
    from rocking.prediction._predict import predict
    from rocking.prediction.forecast import Chance, EndsOfRange, Growth, Prediction

__all__ = ["Chance", "EndsOfRange", "Growth", "Prediction", "predict"]

__getattr__, __dir__ = exports(
    __name__,
    {
        "Chance": "rocking.prediction.forecast",
        "EndsOfRange": "rocking.prediction.forecast",
        "Growth": "rocking.prediction.forecast",
        "Prediction": "rocking.prediction.forecast",
        "predict": "rocking.prediction._predict",
    },
)
