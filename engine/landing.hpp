// Where arcs come down, several side by side: those that fall, or curve down, all the way have one zero, and an
// iteration of third order finds it for all of them at once. Whatever is not that plain is left to roots.hpp.
#pragma once
#include "pack.hpp"

namespace rocking {
namespace ROCKING_ISA {

#define ROCKING_BOTH ROCKING_UNROLL for (int m = 0; m < M; ++m)

// Zeros of y = c0 + c1 x + ... on (0, 1) and the slopes there, for M registers of arcs.
template <int N, int M>  // terms V0 ... VN of the velocity, over which the rotation has degree N + 1
class Landings {
    static constexpr int P = Pack::width;
    Pack c[N + 2][M], d[N + 1][M], e[N][M];  // the arc, its slope, its second derivative
    Pack curve[M], twist[M];                 // bounds on half its second and a sixth of its third derivative
    Mask arch[M], plain[M];

  public:
    Pack zero[M], slope[M];

    // `raw` holds the height above the ground and the terms of the speed towards it. Returns which arcs were plain.
    std::uint64_t solve(const Pack (*raw)[M]) {
        take(raw);
        std::uint64_t found = 0;
        ROCKING_BOTH found |= static_cast<std::uint64_t>(plain[m].bits()) << (m * P);
        if (found) iterate();
        return found;
    }

  private:
    void take(const Pack (*raw)[M]) {
        const Pack none(0.0);
        Pack fall[M], bend[M], end[M];
        ROCKING_BOTH {
            fall[m] = bend[m] = none;
            c[0][m] = raw[0][m];
        }
        ROCKING_UNROLL
        for (int k = 0; k <= N; ++k) ROCKING_BOTH c[k + 1][m] = k > 0 ? raw[k + 1][m] * Pack(-1.0 / (k + 1)) : none - raw[1][m];
        // one that starts on the ground is divided by that known zero
        ROCKING_BOTH arch[m] = (c[0][m] == none) & (c[1][m] > none);
        ROCKING_UNROLL
        for (int k = 0; k <= N; ++k) ROCKING_BOTH c[k][m] = select(arch[m], c[k + 1][m], c[k][m]);
        ROCKING_BOTH {
            c[N + 1][m] = select(arch[m], none, c[N + 1][m]);
            end[m] = c[N + 1][m];
        }
        ROCKING_UNROLL
        for (int k = N; k >= 0; --k) ROCKING_BOTH end[m] = end[m] + c[k][m];
        ROCKING_UNROLL
        for (int k = 1; k <= N + 1; ++k) ROCKING_BOTH {
            d[k - 1][m] = k > 1 ? Pack(k) * c[k][m] : c[1][m];
            if (k > 1) fall[m] = fall[m] + abs(d[k - 1][m]);
            if (k > 1) e[k - 2][m] = k > 2 ? Pack(k - 1) * d[k - 1][m] : d[1][m];
            if (k > 2) bend[m] = bend[m] + abs(e[k - 2][m]);
        }
        ROCKING_BOTH {
            curve[m] = fma(Pack(0.5), bend[m], abs(c[2][m]));
            twist[m] = Pack((N - 1) / 6.0) * bend[m];
            const Mask falls = none - d[0][m] > fall[m], curves = none - e[0][m] > bend[m];
            plain[m] = (abs(d[0][m]) + fall[m] < Pack(1e100)) & (c[0][m] > none) & (end[m] < none) & (falls | curves);
        }
    }

    // Halley's iteration, bracketed, from the zero of the parabola. A lane that has settled no longer moves, whatever
    // the others do.
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
            value<N + 1>(c, x, y);
            value<N>(d, x, s);
            value<N - 1>(e, x, b);
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
        value<N>(d, x, s);
        ROCKING_BOTH {
            zero[m] = x[m];
            slope[m] = select(arch[m], x[m] * s[m], s[m]);
        }
    }

    template <int degree>
    static void value(const Pack (*a)[M], const Pack* x, Pack* y) {
        Pack z[M], even[M], odd[M];
        ROCKING_BOTH {
            z[m] = x[m] * x[m];
            even[m] = a[degree][m];
            odd[m] = a[degree - 1][m];
        }
        ROCKING_UNROLL
        for (int k = degree - 2; k >= 0; k -= 2) ROCKING_BOTH {
            even[m] = fma(even[m], z[m], a[k][m]);
            if (k > 0) odd[m] = fma(odd[m], z[m], a[k - 1][m]);
        }
        ROCKING_BOTH y[m] = degree % 2 ? fma(even[m], x[m], odd[m]) : fma(odd[m], x[m], even[m]);
    }
};

#undef ROCKING_BOTH

}  // namespace ROCKING_ISA
}  // namespace rocking
