// First zero of a polynomial on (0, 1]: Bernstein coefficients show where there is none, halving isolates it, and
// Newton's method within a bracket locates it to rounding. Grazing without crossing is no zero.
#pragma once
#include "pack.hpp"

namespace rocking {
namespace ROCKING_ISA {

constexpr int kLargestDegree = 10;

inline double value_of(const double* c, int degree, double x) {
    double y = c[degree];
    for (int k = degree; k-- > 0;) y = fma(y, x, c[k]);
    return y;
}

inline double slope_of(const double* c, int degree, double x) {
    double y = degree * c[degree];
    for (int k = degree; k-- > 1;) y = fma(y, x, k * c[k]);
    return y;
}

// Zero between low and high, where the polynomial changes sign from plus to minus; Newton from a guess, bracketed.
// `bend` bounds half the second derivative.
inline double polished(const double* c, int degree, double low, double high, double x, double bend) {
    for (int round = 0; round < 200; ++round) {
        double y = c[degree], slope = 0.0;
        for (int k = degree; k-- > 0;) {
            slope = fma(slope, x, y);
            y = fma(y, x, c[k]);
        }
        if (y == 0.0) return x;
        (y > 0.0 ? low : high) = x;
        double next = x - y / slope;
        if (!(next >= low && next <= high)) next = 0.5 * (low + high);
        const double move = std::fabs(next - x);
        // Newton's next error is at most move^2 * bend / |slope|
        if (move <= 4.5e-16 * x || move * move * bend <= 1e-17 * std::fabs(slope) * x) return next;
        x = next;
    }
    return x;
}

// c[0] > 0 is taken for granted; returns the first zero in (0, 1], or 2 if there is none.
inline double first_zero(const double* c, int degree) {
    double rest = 0.0;
    for (int k = 1; k <= degree; ++k) rest += std::fabs(c[k]);
    if (c[0] > rest) return 2.0;
    // falling all the way: at most one zero, and a parabola is a good guess
    double bend = 0.0;
    for (int k = 2; k <= degree; ++k) bend += k * std::fabs(c[k]);
    double half_curve = 0.0;
    for (int k = 2; k <= degree; ++k) half_curve += 0.5 * k * (k - 1) * std::fabs(c[k]);
    if (-c[1] > bend) {
        const double end = value_of(c, degree, 1.0);
        if (end > 0.0) return 2.0;
        if (end == 0.0) return 1.0;
        const double root = c[1] * c[1] - 4.0 * c[0] * (degree > 1 ? c[2] : 0.0);
        const double guess = root > 0.0 ? 2.0 * c[0] / (std::sqrt(root) - c[1]) : 0.5;
        return polished(c, degree, 0.0, 1.0, guess < 1.0 ? guess : 0.5, half_curve);
    }

    struct Piece {
        double low, high, b[kLargestDegree + 1];
    };
    Piece stack[48];
    int depth = 1;
    stack[0].low = 0.0;
    stack[0].high = 1.0;
    // b_i = sum_j binomial(i, j) / binomial(degree, j) c_j
    double scaled[kLargestDegree + 1];
    double binomial = 1.0;
    for (int k = 0; k <= degree; ++k) {
        scaled[k] = c[k] / binomial;
        binomial = binomial * (degree - k) / (k + 1);
    }
    for (int i = 0; i <= degree; ++i) stack[0].b[i] = scaled[i];
    for (int level = 1; level <= degree; ++level)
        for (int i = degree; i >= level; --i) stack[0].b[i] += stack[0].b[i - 1];

    while (depth > 0) {
        const Piece piece = stack[--depth];
        int changes = 0;
        bool positive = true;
        for (int i = 1; i <= degree; ++i) {
            changes += (piece.b[i] < 0.0) != (piece.b[i - 1] < 0.0);
            positive = positive && piece.b[i] > 0.0;
        }
        if (piece.b[0] > 0.0 && positive) continue;
        if (changes == 0 && piece.b[degree] >= 0.0) {
            if (piece.b[degree] == 0.0 && piece.high == 1.0 && piece.b[degree - 1] > 0.0) return 1.0;
            continue;
        }
        if (changes == 1 && piece.b[0] > 0.0) {
            return polished(c, degree, piece.low, piece.high, 0.5 * (piece.low + piece.high), half_curve);
        }
        const double middle = 0.5 * (piece.low + piece.high);
        if (depth + 2 > 48 || piece.high - piece.low < 1e-14) {
            if (piece.b[degree] < 0.0) return middle;
            continue;
        }
        Piece& right = stack[depth];
        Piece& left = stack[depth + 1];
        double work[kLargestDegree + 1];
        for (int i = 0; i <= degree; ++i) work[i] = piece.b[i];
        for (int level = 0; level <= degree; ++level) {
            left.b[level] = work[0];
            right.b[degree - level] = work[degree - level];
            for (int i = 0; i < degree - level; ++i) work[i] = 0.5 * (work[i] + work[i + 1]);
        }
        left.low = piece.low;
        left.high = right.low = middle;
        right.high = piece.high;
        depth += 2;
    }
    return 2.0;
}

}  // namespace ROCKING_ISA
}  // namespace rocking
