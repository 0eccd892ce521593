// Where arcs come down, several side by side: those that fall, or curve down, all the way have one zero, and Newton's
// method finds it for all of them at once. Whatever is not that plain is left to roots.hpp.
#pragma once
#include "pack.hpp"

namespace rocking {
namespace ROCKING_ISA {

// Zeros of y = c0 + c1 x + ... on (0, 1) and the slopes there, as bits of the arcs that were plain.
template <int N>  // terms V0 ... VN of the velocity, over which the rotation has degree N + 1
class Landings {
    static constexpr int P = Pack::width;
    Pack c[N + 2], d[N + 1], curve;  // the arc, its slope, a bound on half its second derivative
    Mask arch, plain;

  public:
    alignas(64) double zero[P], slope[P];

    // `raw` holds the height above the ground and the terms of the speed towards it.
    unsigned solve(const Pack* raw) {
        take(raw);
        const unsigned found = plain.bits();
        if (found) newton();
        return found;
    }

  private:
    void take(const Pack* raw) {
        const Pack none(0.0);
        Pack sum(0.0);
        c[0] = raw[0];
        ROCKING_UNROLL
        for (int k = 0; k <= N; ++k) {
            const Pack term = raw[k + 1];
            sum = sum + abs(term);
            c[k + 1] = term * Pack(-1.0 / (k + 1));
        }
        arch = (c[0] == none) & (c[1] > none);  // one that starts on the ground is divided by that known zero
        ROCKING_UNROLL
        for (int k = 0; k <= N; ++k) c[k] = select(arch, c[k + 1], c[k]);
        c[N + 1] = select(arch, none, c[N + 1]);
        Pack fall(0.0), bend(0.0), end = c[N + 1];
        ROCKING_UNROLL
        for (int k = N; k >= 0; --k) end = end + c[k];
        ROCKING_UNROLL
        for (int k = 1; k <= N + 1; ++k) {
            d[k - 1] = Pack(k) * c[k];
            if (k > 1) fall = fall + abs(d[k - 1]);
            if (k > 2) bend = fma(Pack(k - 1), abs(d[k - 1]), bend);
        }
        curve = fma(Pack(0.5), bend, abs(c[2]));
        const Mask falls = none - d[0] > fall, curves = none - Pack(2.0) * c[2] > bend;
        plain = (sum < Pack(1e100)) & (c[0] > none) & (end < none) & (falls | curves);
    }

    // Bracketed, from the zero of the parabola; a lane that has settled no longer moves, whatever the others do.
    void newton() {
        const Pack none(0.0), half(0.5), one(1.0);
        const Pack root = sqrt(max(fnma(Pack(4.0) * c[0], c[2], c[1] * c[1]), none));
        const Pack down = (c[0] + c[0]) / (root - c[1]), over = (root + c[1]) / (none - c[2] - c[2]);
        Pack x = select(c[1] > none, over, down), low(0.0), high(1.0);
        x = select((x > none) & (x < one), x, half);
        Mask open = plain;
        for (int round = 0; round < 200 && open.bits(); ++round) {
            const Pack y = value<N + 1>(c, x), fall = value<N>(d, x);
            const Mask above = y > none, hit = y == none;
            low = select(above, x, low);
            high = select(above, high, x);
            Pack to = x - y / fall;
            to = select((to >= low) & (high >= to), to, half * (low + high));
            const Pack move = abs(to - x);  // Newton's next error is at most move^2 curve / |slope|
            const Mask settled =
                hit | (Pack(4.5e-16) * x >= move) | (Pack(1e-17) * abs(fall) * x >= move * move * curve);
            x = select(open & !hit, to, x);
            open = open & !settled;
        }
        const Pack fall = value<N>(d, x);
        x.store(zero);
        select(arch, x * fall, fall).store(slope);
    }

    template <int degree>
    static Pack value(const Pack* a, Pack x) {
        const Pack z = x * x;
        Pack even = a[degree], odd = a[degree - 1];
        ROCKING_UNROLL
        for (int k = degree - 2; k >= 0; k -= 2) {
            even = fma(even, z, a[k]);
            if (k > 0) odd = fma(odd, z, a[k - 1]);
        }
        return degree % 2 ? fma(even, x, odd) : fma(odd, x, even);
    }
};

}  // namespace ROCKING_ISA
}  // namespace rocking
