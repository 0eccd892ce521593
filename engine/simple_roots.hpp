// Zeros at which polynomials decrease, for several polynomials in parallel. A polynomial that decreases, or is concave,
// everywhere has one zero; an iteration of third order finds all such zeros together. roots.hpp handles other
// polynomials.
#pragma once
#include "pack.hpp"

namespace rocking {
namespace ROCKING_ISA {

#define ROCKING_BOTH ROCKING_UNROLL for (int m = 0; m < M; ++m)

// Zeros of y = c0 + c1 x + ... on (0, 1) and the slopes there, for M registers of polynomials.
template <int degree, int M>
class SimpleRoots {
    static constexpr int P = Pack::width;
    Pack c[degree + 1][M], d[degree][M], e[degree - 1][M];  // the polynomial, its slope, its second derivative
    Pack curve[M], twist[M];                 // bounds on half its second and a sixth of its third derivative
    Mask arch[M], plain[M];

  public:
    Pack zero[M], slope[M];

    // Returns flags of the polynomials that this method can handle.
    std::uint64_t solve(const Pack (*terms)[M]) {
        take(terms);
        std::uint64_t mask = 0;
        ROCKING_BOTH mask |= static_cast<std::uint64_t>(plain[m].bits()) << (m * P);
        if (mask) iterate();
        return mask;
    }

  private:
    void take(const Pack (*terms)[M]) {
        const Pack none(0.0);
        Pack fall[M], bend[M], end[M];
        // a polynomial that starts at zero is divided by this known zero
        ROCKING_BOTH {
            fall[m] = bend[m] = none;
            arch[m] = (terms[0][m] == none) & (terms[1][m] > none);
        }
        ROCKING_UNROLL
        for (int k = 0; k < degree; ++k) ROCKING_BOTH c[k][m] = select(arch[m], terms[k + 1][m], terms[k][m]);
        ROCKING_BOTH {
            c[degree][m] = select(arch[m], none, terms[degree][m]);
            end[m] = c[degree][m];
        }
        ROCKING_UNROLL
        for (int k = degree - 1; k >= 0; --k) ROCKING_BOTH end[m] = end[m] + c[k][m];
        ROCKING_UNROLL
        for (int k = 1; k <= degree; ++k) ROCKING_BOTH {
            d[k - 1][m] = k > 1 ? Pack(k) * c[k][m] : c[1][m];
            if (k > 1) fall[m] = fall[m] + abs(d[k - 1][m]);
            if (k > 1) e[k - 2][m] = k > 2 ? Pack(k - 1) * d[k - 1][m] : d[1][m];
            if (k > 2) bend[m] = bend[m] + abs(e[k - 2][m]);
        }
        ROCKING_BOTH {
            curve[m] = fma(Pack(0.5), bend[m], abs(c[2][m]));
            twist[m] = Pack((degree - 2) / 6.0) * bend[m];
            const Mask falls = none - d[0][m] > fall[m], curves = none - e[0][m] > bend[m];
            plain[m] = (abs(d[0][m]) + fall[m] < Pack(1e100)) & (c[0][m] > none) & (end[m] < none) & (falls | curves);
        }
    }

    // Halley's iteration in a bracket, from the zero of the parabola. A converged lane no longer changes, whatever
    // happens in the other lanes.
    void iterate() {
        const Pack none(0.0), half(0.5), one(1.0), two(2.0);
        Pack x[M], low[M], high[M];
        Mask open[M];
        ROCKING_BOTH {
            const Pack root = sqrt(max(fnma(Pack(4.0) * c[0][m], c[2][m], c[1][m] * c[1][m]), none));
            const Mask rises = c[1][m] > none;
            const Pack guess = select(rises, root + c[1][m], c[0][m] + c[0][m]) /
                               select(rises, none - e[0][m], root - c[1][m]);
            x[m] = select((guess > none) & (guess < one), guess, half);
            low[m] = none;
            high[m] = one;
            open[m] = plain[m];
        }
        for (int round = 0; round < 200; ++round) {
            unsigned any = 0;
            Pack y[M], s[M], b[M];
            value<degree>(c, x, y);
            value<degree - 1>(d, x, s);
            value<degree - 2>(e, x, b);
            ROCKING_BOTH {
                const Mask above = y[m] > none, hit = y[m] == none;
                low[m] = select(above, x[m], low[m]);
                high[m] = select(above, high[m], x[m]);
                const Pack fall2 = s[m] * s[m];
                Pack to = x[m] - (y[m] + y[m]) * s[m] / fnma(y[m], b[m], fall2 + fall2);
                to = select((to >= low[m]) & (high[m] >= to), to, half * (low[m] + high[m]));
                // the next error is at most move^3 (curve^2 + twist |slope|) / slope^2
                const Pack move = abs(to - x[m]), wild = fma(twist[m], abs(s[m]), curve[m] * curve[m]);
                const Mask settled = hit | (Pack(4.5e-16) * x[m] >= move) |
                                     (Pack(1e-17) * x[m] * fall2 >= move * move * move * wild);
                x[m] = select(open[m] & !hit, to, x[m]);
                open[m] = open[m] & !settled;
                any |= open[m].bits();
            }
            if (!any) break;
        }
        Pack s[M];
        value<degree - 1>(d, x, s);
        ROCKING_BOTH {
            zero[m] = x[m];
            slope[m] = select(arch[m], x[m] * s[m], s[m]);
        }
    }

    template <int top>
    static void value(const Pack (*a)[M], const Pack* x, Pack* y) {
        Pack z[M], even[M], odd[M];
        ROCKING_BOTH {
            z[m] = x[m] * x[m];
            even[m] = a[top][m];
            odd[m] = a[top - 1][m];
        }
        ROCKING_UNROLL
        for (int k = top - 2; k >= 0; k -= 2) ROCKING_BOTH {
            even[m] = fma(even[m], z[m], a[k][m]);
            if (k > 0) odd[m] = fma(odd[m], z[m], a[k - 1][m]);
        }
        ROCKING_BOTH y[m] = top % 2 ? fma(even[m], x[m], odd[m]) : fma(odd[m], x[m], even[m]);
    }
};

#undef ROCKING_BOTH

}  // namespace ROCKING_ISA
}  // namespace rocking
