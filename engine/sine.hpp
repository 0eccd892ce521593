// Sine and cosine of a pack, for angles within (-3 pi / 4, 3 pi / 4) and a little beyond: Taylor polynomials after
// reduction to |x| <= pi / 4, where the first term left out is below half a unit in the last place.
#pragma once
#include "pack.hpp"

namespace rocking {
namespace ROCKING_ISA {

template <class Number>
inline void sine_cosine_reduced(Number x, Number& sine, Number& cosine) {
    const Number z = x * x;
    Number s = Number(-1.0 / 1307674368000.0);
    s = fma(s, z, Number(1.0 / 6227020800.0));
    s = fma(s, z, Number(-1.0 / 39916800.0));
    s = fma(s, z, Number(1.0 / 362880.0));
    s = fma(s, z, Number(-1.0 / 5040.0));
    s = fma(s, z, Number(1.0 / 120.0));
    s = fma(s, z, Number(-1.0 / 6.0));
    sine = fma(s * z, x, x);
    Number c = Number(1.0 / 20922789888000.0);
    c = fma(c, z, Number(-1.0 / 87178291200.0));
    c = fma(c, z, Number(1.0 / 479001600.0));
    c = fma(c, z, Number(-1.0 / 3628800.0));
    c = fma(c, z, Number(1.0 / 40320.0));
    c = fma(c, z, Number(-1.0 / 720.0));
    c = fma(c, z, Number(1.0 / 24.0));
    c = fma(c, z, Number(-0.5));
    cosine = fma(c, z, Number(1.0));
}

inline void sine_cosine(Pack x, Pack& sine, Pack& cosine) {
    const Pack magic(6755399441055744.0);  // 1.5 * 2^52: adding and subtracting it rounds to a whole number
    const Pack k = fma(x, Pack(0.63661977236758134308), magic) - magic;
    Pack r = fnma(k, Pack(1.57079632679489655800), x);
    r = fnma(k, Pack(6.12323399573676603587e-17), r);
    Pack s, c;
    sine_cosine_reduced(r, s, c);
    const Mask odd = abs(k) == Pack(1.0), half = abs(k) >= Pack(2.0);
    const Pack zero(0.0);
    const Pack a = select(odd, c, s), b = select(odd, s, c);
    sine = select((k == Pack(-1.0)) | half, zero - a, a);
    cosine = select((k == Pack(1.0)) | half, zero - b, b);
}

inline void sine_cosine(double x, double& sine, double& cosine) {
    const double k = std::nearbyint(x * 0.63661977236758134308);
    double r = fma(-k, 1.57079632679489655800, x), s, c;
    r = fma(-k, 6.12323399573676603587e-17, r);
    sine_cosine_reduced(r, s, c);
    const bool odd = std::fabs(k) == 1.0, half = std::fabs(k) >= 2.0;
    const double a = odd ? c : s, b = odd ? s : c;
    sine = k == -1.0 || half ? -a : a;
    cosine = k == 1.0 || half ? -b : b;
}

}  // namespace ROCKING_ISA
}  // namespace rocking
