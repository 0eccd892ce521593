"""PELICUN itself computes with exported curves; `make pelicun` installs it in its own environment."""

import math
import warnings

import numpy as np
import pytest

from rocking.statistics.lognormal import lognormal_probability
from rocking.studies.fragility import FragilityCurve, FragilityModel, to_csv
from rocking.studies.fragility.export import table
from rocking.tables import Table

pd = pytest.importorskip("pandas")
assessments = pytest.importorskip("pelicun.assessment", reason="PELICUN is absent: `make pelicun` runs this test")

G, DEMAND, COUNT = 9.80665, 0.6, 20_000
CURVES = FragilityCurve("rotation > 0.5 alpha", 5.5533, 0.39076), FragilityCurve("overturned", 6.4429, 0.38364)


def exported():
    """Two curves that do not cross below 10 g, without counts."""
    return FragilityModel("block", "pga", "m/s2", CURVES, [2.0, 4.0, 8.0], np.array([9, 9, 9]), {})


def shares(path):
    """Share of samples in each damage state at a demand of 0.6 g in direction 1, with all of PELICUN's defaults."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # deprecations inside PELICUN and its libraries
        run = assessments.Assessment({"PrintLog": False, "Seed": 1})
        run.stories = 1
        demand = {"1-PGA-0-1": ["g"] + [DEMAND] * COUNT}
        run.demand.load_sample(pd.DataFrame(demand, index=["Units", *range(COUNT)]))
        with path.open(encoding="utf-8") as file:
            directional = file.read().splitlines()[1].split(",")[5]
        component = {
            "Units": "ea",
            "Location": "0",
            "Direction": directional,
            "Theta_0": "1",
            "Family": None,
            "Blocks": "1",
        }
        marginals = pd.DataFrame([component | {"Family": None}], index=["block"])
        run.asset.load_cmp_model({"marginals": marginals})
        run.asset.generate_cmp_sample(COUNT)
        run.damage.load_model_parameters([str(path)], {"block"})
        run.damage.calculate()
        sample = run.damage.save_sample()
    sample = sample[0] if isinstance(sample, tuple) else sample
    return sample.mean().to_numpy(dtype=float)


@pytest.mark.verifies("other program", "PELICUN", within="four standard errors of its sample", room="studies")
def test_pelicun_computes_the_probability_of_the_curve(tmp_path):
    """At .6 g the worst state has the probability of its curve; Demand-Directional 0 multiplies the demand by 1.2."""
    wanted = float(lognormal_probability(np.array(DEMAND * G), CURVES[1].median, CURVES[1].dispersion))
    error = 4.0 * math.sqrt(wanted * (1.0 - wanted) / COUNT)  # its sample has this standard error, four times
    path = to_csv(exported(), tmp_path / "block.csv", "pelicun")
    assert shares(path)[-1] == pytest.approx(wanted, abs=error)
    made = table(exported(), "pelicun")
    blind = Table.of_rows("pelicun", made.header, [(*made.rows[0][:5], 0, *made.rows[0][6:])])
    wrong = shares(to_csv(exported(), tmp_path / "blind.csv", blind))[-1]
    assert wrong == pytest.approx(
        float(lognormal_probability(np.array(1.2 * DEMAND * G), CURVES[1].median, CURVES[1].dispersion)), abs=error
    )
    assert abs(wrong - wanted) > 10.0 * error
