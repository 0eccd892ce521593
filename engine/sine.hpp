// Sine and cosine for |x| <= pi / 2 as Taylor polynomials. The truncation error is below half a unit in the last place
// of 1 for |x| up to 1.2, and below 3e-16 up to pi / 2. A body with a larger rotation lies on the ground.
#pragma once
#include "pack.hpp"

namespace rocking {
namespace ROCKING_ISA {

// Terms of the two series, signs included: term[k] = +-1 / k!.
struct Terms {
    double term[21] = {1.0, 1.0};
    constexpr Terms() {
        double factorial = 1.0;
        for (int k = 2; k <= 20; ++k) {
            factorial *= k;
            term[k] = (k % 4 < 2 ? 1.0 : -1.0) / factorial;
        }
    }
};
constexpr Terms kTerms;

template <class Number>
inline void sine_cosine(Number x, Number& sine, Number& cosine) {
    const Number z = x * x;
    Number s(kTerms.term[19]), c(kTerms.term[20]);
    ROCKING_UNROLL
    for (int k = 18; k > 0; k -= 2) {
        c = fma(c, z, Number(kTerms.term[k]));
        if (k > 2) s = fma(s, z, Number(kTerms.term[k - 1]));
    }
    sine = fma(s * z, x, x);
    cosine = fma(c, z, Number(1.0));
}

}  // namespace ROCKING_ISA
}  // namespace rocking
