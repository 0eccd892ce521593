"""KED for a million slendernesses against the appendix's program, dblquad, and bare arctangents."""

import numpy as np

from benchmarks.timing import Comparison, compare
from rocking.restitution import Ked

COUNT = 10**6


def appendix_program(slenderness: float) -> float:
    """The paper's Appendix A (symbolic integration), line by line, in sympy instead of MATLAB."""
    import sympy

    x, y = sympy.symbols("x y")
    B = 1
    H = sympy.Rational(str(slenderness)) * B
    s1 = y**4 / (y**2 + (B - x) ** 2)
    s12 = sympy.integrate(sympy.integrate(s1, (x, 0, B)), (y, 0, H))
    s2 = y**2 + (B - x) ** 2
    s22 = sympy.integrate(sympy.integrate(s2, (x, 0, B)), (y, 0, H))
    return float(sympy.re(sympy.sqrt(s12 / s22).evalf(17)))


def double_quadrature(slenderness: float, tolerance: float = 1.49e-8) -> float:
    """Eq. 17 by dblquad of SciPy, with its default tolerance."""
    from scipy.integrate import dblquad

    upper, _ = dblquad(
        lambda x, y: y**4 / (y**2 + (1.0 - x) ** 2), 0.0, slenderness, 0.0, 1.0, epsabs=tolerance, epsrel=tolerance
    )
    lower, _ = dblquad(
        lambda x, y: y**2 + (1.0 - x) ** 2, 0.0, slenderness, 0.0, 1.0, epsabs=tolerance, epsrel=tolerance
    )
    return float(np.sqrt(upper / lower))


def comparisons() -> list[Comparison]:
    """Run them all; the values are checked against each other first."""
    from scipy.integrate import dblquad  # noqa: F401 - imported before the clock starts

    model, rng = Ked(), np.random.default_rng(1)
    ratios = rng.uniform(0.5, 20.0, COUNT)
    wide = 10.0 ** rng.uniform(-3.0, 3.0, COUNT)
    few = [2.0, 2.85, 4.33]
    for ratio in few:
        assert abs(appendix_program(ratio) - model.of_slenderness(ratio)) < 1e-12
        assert abs(double_quadrature(ratio) - model.of_slenderness(ratio)) < 1e-9
    subject = f"KED, {COUNT:,} values"

    def ours() -> object:
        return model.of_slenderness(ratios)

    sample = ratios[:40].tolist()
    return [
        compare(
            subject,
            "appendix program (sympy)",
            ours,
            lambda: [appendix_program(r) for r in few],
            goal=1e5,
            counts=(COUNT, len(few)),
            repeats=5,
        ),
        compare(
            subject,
            "scipy dblquad, default tolerance",
            ours,
            lambda: [double_quadrature(r) for r in sample],
            goal=1e5,
            counts=(COUNT, len(sample)),
            repeats=9,
        ),
        compare(
            subject,
            "scipy dblquad, tolerance 1e-13 as ours",
            ours,
            lambda: [double_quadrature(r, 1e-13) for r in sample],
            goal=1e5,
            counts=(COUNT, len(sample)),
            repeats=9,
        ),
        compare(
            subject + ", h/b 0.5 to 20",
            "numpy arctan, one a value",
            ours,
            lambda: np.arctan(ratios),
            goal=1 / 5,
            counts=(COUNT, COUNT),
        ),
        compare(
            subject + ", h/b 1e-3 to 1e3",
            "numpy arctan, one a value",
            lambda: model.of_slenderness(wide),
            lambda: np.arctan(wide),
            goal=None,
            counts=(COUNT, COUNT),
        ),
    ]
