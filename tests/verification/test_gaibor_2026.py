"""`rocking reproduce gaibor-2026` against the shares and bifurcations of an independent program."""

import json
from dataclasses import replace

import numpy as np
import pytest

from rocking.evidence import gaibor_2026
from rocking.evidence.claims_of_errors import FAILS, HOLDS
from rocking.evidence.gaibor_2026 import (
    FULL,
    HIGHEST,
    MODELS,
    SLENDERNESS,
    ComparisonEffort,
    GaiborReproduction,
    HarmonicCase,
    case,
    first_overturning,
    main_branch,
)
from rocking.plots.gaibor_2026 import gaibor_figures
from rocking.studies.longrun import HarmonicRocking
from rocking.studies.longrun.system import OVERTURNED, over_periods

pytest.importorskip("rocking.dynamics._longrun", reason="the compiled engine is missing")
pytestmark = pytest.mark.verifies(room="rocking in the plane")

SHARES = {
    # slenderness, model, frequency: sticking, periodic, chaotic, overturned of the amplitudes from rest; the first that
    # overturns; overturned, one-period, multi-period, chaotic of 64 starts; amplitudes with several periods or chaos
    (2, "ked", 5): ((0.0172, 0.6833, 0, 0.1618), (3.87, 3.87), (0.5254, 0.4292, 0.0204, 0), 0.385),
    (4, "housner", 2): ((0.0086, 0.0293, 0, 0.8244), (1.05, 1.05), (0.9279, 0.0465, 0.0004, 0), 0.017),
    (4, "ked", 2): ((0.0052, 0.0103, 0, 0.8468), (1.03, 1.03), (0.9398, 0.0363, 0.0001, 0), 0.009),
    (8, "ked", 2): ((0.0017, 0.0017, 0, 0.8589), (1.01, 1.03), (0.9589, 0.0218, 0.0013, 0), 0.034),
}
ONE = {"from rest": 1.05 / 581, "with starts": 1.05 / 117}  # one amplitude, and the digits of the table


def differences(found, expected):
    """Return the differences of the shares, in counting noise."""
    from_rest, first, shares, is_complex = expected
    kinds, numbers = ("sticking", "periodic", "irregular", "overturned"), found.numbers
    starts = [numbers[f"{name}_starts"] for name in ("overturned", "one_period", "multi_period", "chaotic")]
    return np.array([
        *(np.subtract([found.from_rest[kind] for kind in kinds], from_rest) / ONE["from rest"]),
        (numbers["first_overturning"] - np.clip(numbers["first_overturning"], *first)) / 0.0105,
        *(np.subtract(starts, shares) / 0.0015),
        (numbers["complex_amplitudes"] - is_complex) / ONE["with starts"],
    ])  # fmt: skip


@pytest.fixture(scope="module")
def cases():
    """The cases of the table, by name."""
    return {name: case(*name[:2], float(name[2]), replace(FULL, cascade=20)) for name in SHARES}


@pytest.mark.slow
@pytest.mark.verifies("computed anew", "an independent program in 80-bit Taylor series", within="one amplitude")
@pytest.mark.parametrize("name", SHARES)
def test_shares_of_attractors(cases, name):
    """Every share agrees within one amplitude; those of starts within .0015."""
    assert np.abs(differences(cases[name], SHARES[name])).max() <= 1.0


FIRST_OVERTURNING = {2: (3.82, 3.86, 3.87), 8: (1.73, 1.82, 1.83)}


@pytest.mark.slow
@pytest.mark.verifies("computed anew", "programs in Taylor series of 80 and 300 bits", within="one amplitude")
@pytest.mark.parametrize("slenderness", FIRST_OVERTURNING)
def test_the_first_overturning_does_not_depend_on_rounding(slenderness):
    """KED, frequency 5: after long chaotic motion relative changes of 1e-13 of the amplitude decide the outcome.

    At the first of three amplitudes some histories overturn, at the second none, at the third all, after 20 impacts.
    """
    system = gaibor_2026._system(slenderness, "ked", 5.0)
    changes = 1.0 + 1e-13 * np.arange(-50, 51)
    fractions = []
    for amplitude in FIRST_OVERTURNING[slenderness]:
        systems = [system.changed("amplitude", value) for value in (amplitude * changes).tolist()]
        result = over_periods(systems, np.zeros((len(changes), 3)), kept=500)
        fractions.append((result.ending == OVERTURNED).mean())
    assert 0.0 < fractions[0] < 1.0
    assert fractions[1:] == [0.0, 1.0]
    assert set(result.impacts.tolist()) == {16 if slenderness == 2 else 20}
    below, first = FIRST_OVERTURNING[slenderness][1:]
    assert first_overturning(system, np.array([below, first])) == first
    assert np.isnan(first_overturning(system, np.array([below])))


@pytest.mark.slow
@pytest.mark.verifies("negative control", "the shares of another restitution model")
def test_the_shares_distinguish_the_models(cases):
    """Negative control: the shares with KED are not those with Housner."""
    assert np.abs(differences(cases[4, "ked", 2], SHARES[4, "housner", 2])).max() > 5.0


@pytest.mark.slow
@pytest.mark.verifies(
    "computed anew", "an independent program in 80-bit Taylor series and DOP853", within="half a digit"
)
def test_the_difference_fades_with_slenderness():
    """Loss of symmetry with KED against Housner's at frequency 2, and the ratio of the folds towards 2/3."""
    ratios = []
    for slenderness, percent in {2: 4.7, 3: 0.96, 4: 0.30, 6: 0.056, 8: 0.017, 10: 0.0070}.items():
        housner, ked = (main_branch(gaibor_2026._system(slenderness, model, 2.0)) for model in ("housner", "ked"))
        gap = 100.0 * (ked[1].value / housner[1].value - 1.0)
        assert gap == pytest.approx(percent, rel=0.03)
        ratios.append(ked[0].value / housner[0].value)
    assert np.all(np.diff(ratios) > 0.0)
    assert 0.62 < ratios[-1] < 2.0 / 3.0


TINY = ComparisonEffort((2.0,), 0.2, 0.2, 2, 40, 10)


@pytest.mark.slow
@pytest.mark.verifies("behaviour")
def test_statements_and_files(run, tmp_path, monkeypatch):
    """The command prints each statement with verdicts in all senses, and writes report, tables and figures."""
    monkeypatch.setattr(gaibor_2026, "FAST", TINY)
    code, out, err = run("reproduce", "gaibor-2026", "-o", tmp_path)
    assert (code, "note" in err) == (0, False)
    assert "The parameters of the paper are not known" in out
    results = json.loads((tmp_path / "results.json").read_text("utf-8"))
    verdicts = {claim["sense"]: claim["verdict"] for claim in results["claims"]}
    assert {claim["statement"] for claim in results["claims"]} == {
        gaibor_2026._ONSET, gaibor_2026._PREVALENCE, gaibor_2026._CONVERGENCE,
    }  # fmt: skip
    assert verdicts["the symmetric orbit begins (fold)"] == HOLDS
    assert verdicts["the symmetric orbit loses symmetry"] == FAILS
    assert verdicts["width of the amplitudes with chaos after the period doublings"] == FAILS
    assert verdicts["amplitudes of the loss of symmetry"] == HOLDS
    assert all(claim["sense"] in out for claim in results["claims"])
    assert len(results["cases"]) == 18
    assert results["units"]["largest_exponent"] == "1"
    (first,) = [row for row in results["cases"] if (row["slenderness_ratio"], row["model"]) == (2, "ked")]
    assert first["pitchfork"] == pytest.approx(2.500336996, abs=1e-9)
    assert (tmp_path / "report.pdf").read_bytes().startswith(b"%PDF")
    assert len(list((tmp_path / "figures").glob("*.png"))) == 6
    names = {"claims.csv", "bifurcations.csv", "attractors.csv", "basins.csv"}
    assert {path.name for path in (tmp_path / "tables").iterdir()} == names


@pytest.mark.slow
@pytest.mark.verifies("damage")
def test_figures_of_cases_without_attractors():
    """Panels end at the largest amplitude with attractors, or at the largest of all if all starts overturn."""

    def limits(attractors):
        numbers = {"restitution": 0.9, "fold": 1.0, "pitchfork": 2.0}
        empty = np.empty((0, 2))
        cases = [
            HarmonicCase(slenderness, model, 2.0, numbers, {}, (), (), empty, empty, empty)
            for slenderness in SLENDERNESS
            for model in MODELS
        ]
        cases[0] = replace(cases[0], attractors=attractors)
        figure = gaibor_figures(GaiborReproduction(TINY, tuple(cases), {}))["bifurcations_2"]()
        return figure.axes[0].get_xlim()

    assert limits(np.empty((0, 2))) == pytest.approx((0.0, 1.02 * HIGHEST))
    assert limits(np.array([[3.0, 0.1]])) == pytest.approx((0.0, 1.02 * 3.0))


@pytest.mark.verifies("damage")
def test_full_belongs_to_this_paper(refuses):
    """The option of one paper is refused for the other."""
    refuses(("reproduce", "--full"), "gaibor-2026")


@pytest.mark.slow
@pytest.mark.verifies("computed anew", "an independent program in 80-bit Taylor series", within="3 amplitudes")
def test_the_largest_exponent_of_the_cascade():
    """Slenderness 2, Housner, frequency 2: chaos from 3.0013 to 3.0217, with .11552(40) at 3.0166."""
    system: HarmonicRocking = gaibor_2026._system(2, "housner", 2.0)
    points, numbers = gaibor_2026._cascade(main_branch(system), 100)
    assert numbers["chaos_width"] == pytest.approx(3.0217 - 3.0013, abs=3.0 * numbers["chaos_step"])
    near = points[np.abs(points[:, 0] - 3.0166).argmin(), 2]
    assert near == pytest.approx(0.1155, abs=0.02)
    assert numbers["largest_exponent"] > 0.115
    assert numbers["largest_exponent_error"] < 0.003
