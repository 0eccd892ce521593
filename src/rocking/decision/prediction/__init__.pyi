from ._predict import predict as predict
from ._score import Validation as Validation
from ._score import score as score
from .forecast import Prediction as Prediction
