"""How well predictions agree with measurements: one measure a function."""

import numpy as np

from rocking.conventions import FloatArray


def rmse(model: FloatArray, measured: FloatArray) -> float:
    """Root mean square error of r.

    model, measured: coefficients [-]. Returns sqrt(mean((model - measured)^2)) [-].
    """
    return float(np.sqrt(np.mean((model - measured) ** 2)))


def bias(model: FloatArray, measured: FloatArray) -> float:
    """Mean of model minus experiment.

    model, measured: coefficients [-]. Returns positive where the model is too elastic [-].
    """
    return float(np.mean(model - measured))


def correlation(model: FloatArray, measured: FloatArray) -> float:
    """Pearson's correlation coefficient: blind to bias and scale.

    model, measured: coefficients [-]. Returns between -1 and 1; NaN if the model is constant.
    """
    dm, de = model - model.mean(), measured - measured.mean()
    scale = float(np.sqrt((dm @ dm) * (de @ de)))
    return float(dm @ de) / scale if scale > 0.0 else float("nan")


def concordance(model: FloatArray, measured: FloatArray) -> float:
    """Lin's concordance (Biometrics 45, 1989): correlation that also pays for bias and scale.

    model, measured: coefficients [-]. Returns 2 cov / (var + var + (difference of means)^2), between -1 and 1.
    """
    covariance = float(np.mean((model - model.mean()) * (measured - measured.mean())))
    return 2.0 * covariance / float(model.var() + measured.var() + (model.mean() - measured.mean()) ** 2)


def loss_rmse(model: FloatArray, measured: FloatArray) -> float:
    """Root mean square error of the energy loss 1 - r^2.

    model, measured: coefficients [-]. Returns of the share of kinetic energy [-].
    """
    return rmse(model**2, measured**2)


def log_loss_rmse(model: FloatArray, measured: FloatArray) -> float:
    """Root mean square of ln((1 - r_model^2) / (1 - r_measured^2)): relative error of the energy loss.

    model, measured: coefficients below 1 [-]. Returns 0.1 is about 10 %; infinite for a model without loss [-].
    """
    with np.errstate(divide="ignore"):
        return rmse(np.log1p(-(model**2)), np.log1p(-(measured**2)))


def relative_error(model: FloatArray, measured: FloatArray) -> FloatArray:
    """Relative error as the paper defines it, |measured - model| / measured.

    model, measured: coefficients [-]. Returns of the same shape [-].
    """
    return np.asarray(np.abs(measured - model) / measured)


def zone(error: FloatArray) -> list[str]:
    """Sort relative errors into the paper's zones.

    error: relative errors [-]. Returns ``"I"`` below 1 %, ``"II"`` to 5 %, ``"III"`` above.

    >>> zone(np.array([0.005, 0.03, 0.2]))
    ['I', 'II', 'III']
    """
    return ["I" if e < 0.01 else "II" if e < 0.05 else "III" for e in error.tolist()]
