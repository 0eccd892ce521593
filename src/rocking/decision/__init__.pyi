from .assessment import assess as assess
from .code_methods import compare_code_methods as compare_code_methods
from .prediction import Prediction as Prediction
from .prediction import Validation as Validation
from .prediction import predict as predict
from .prediction import score as score
