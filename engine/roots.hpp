// First zero of a polynomial on (0, 1]: Bernstein coefficients exclude intervals, bisection isolates the zero, and
// Newton's method in a bracket locates it to rounding. A touch without a change of sign is not a zero.
#pragma once
#include "pack.hpp"

namespace rocking {
namespace ROCKING_ISA {

// Value from even and odd powers: two short chains of multiply-adds are faster than one long chain.
template <int degree>
inline double value_of(const double* c, double x) {
    const double z = x * x;
    constexpr int even = degree - degree % 2, odd = degree - 1 + degree % 2;
    double a = c[even], b = odd >= 1 ? c[odd >= 1 ? odd : 0] : 0.0;
    ROCKING_UNROLL
    for (int k = even - 2; k >= 0; k -= 2) a = fma(a, z, c[k]);
    ROCKING_UNROLL
    for (int k = odd - 2; k >= 1; k -= 2) b = fma(b, z, c[k]);
    return fma(b, x, a);
}

// Coefficients of the derivative.
template <int degree>
inline void slopes_of(const double* c, double* d) {
    ROCKING_UNROLL
    for (int k = 1; k <= degree; ++k) d[k - 1] = k * c[k];
}

// Zero between low and high, where the polynomial changes from plus to minus: Newton's method in a bracket, from a
// guess. `curve` bounds half the second derivative.
template <int degree>
inline double polished(const double* c, const double* d, double low, double high, double x, double curve) {
    for (int round = 0; round < 200; ++round) {
        const double y = value_of<degree>(c, x), slope = value_of<degree - 1>(d, x);
        if (y == 0.0) return x;
        (y > 0.0 ? low : high) = x;
        double next = x - y / slope;  // Eq. 56
        if (!(next >= low && next <= high)) next = 0.5 * (low + high);
        const double move = std::fabs(next - x);
        // the next error of Newton's method is at most move^2 * curve / |slope|
        if (move <= 4.5e-16 * x || move * move * curve <= 1e-17 * std::fabs(slope) * x) return next;
        x = next;
    }
    return x;
}

template <int degree>
struct Isolation {
    struct Piece {
        double low, high, b[degree + 1];
    };

    static constexpr double binomial(int k) {
        double value = 1.0;
        for (int j = 0; j < k; ++j) value = value * (degree - j) / (j + 1);
        return value;
    }

    // Bernstein coefficients: b_i = sum_j binomial(i, j) / binomial(degree, j) c_j.
    static void convert(const double* c, double* b) {
        ROCKING_UNROLL
        for (int k = 0; k <= degree; ++k) b[k] = c[k] * (1.0 / binomial(k));
        ROCKING_UNROLL
        for (int level = 1; level <= degree; ++level) {
            ROCKING_UNROLL
            for (int i = degree; i >= level; --i) b[i] += b[i - 1];
        }
    }

    static void halve(const Piece& piece, Piece& left, Piece& right) {
        double work[degree + 1];
        for (int i = 0; i <= degree; ++i) work[i] = piece.b[i];
        for (int level = 0; level <= degree; ++level) {
            left.b[level] = work[0];
            right.b[degree - level] = work[degree - level];
            for (int i = 0; i < degree - level; ++i) work[i] = 0.5 * (work[i] + work[i + 1]);
        }
        left.low = piece.low;
        left.high = right.low = 0.5 * (piece.low + piece.high);
        right.high = piece.high;
    }

    // Reports all positions in (0, 1) at which the polynomial changes from plus to minus, in order.
    template <class Report>
    static void each(const double* c, const double* d, double curve, Report report) {
        Piece stack[64];
        stack[0].low = 0.0;
        stack[0].high = 1.0;
        convert(c, stack[0].b);
        for (int depth = 1; depth > 0;) {
            const Piece piece = stack[--depth];
            int changes = 0;
            for (int i = 1; i <= degree; ++i) changes += (piece.b[i] < 0.0) != (piece.b[i - 1] < 0.0);
            const bool narrow = depth + 2 > 64 || piece.high - piece.low < 1e-14;
            if (changes == 0 || (changes == 1 && piece.b[0] < 0.0)) continue;
            int first = 0;  // for a piece that starts at a zero: index of the first nonzero coefficient
            while (piece.b[first] == 0.0) ++first;
            if (narrow || (changes == 1 && piece.b[first] < 0.0)) {
                if (piece.b[degree] < 0.0 && !(piece.b[0] < 0.0) && piece.low > 0.0) report(piece.low);
            } else if (changes == 1) {
                report(polished<degree>(c, d, piece.low, piece.high, 0.5 * (piece.low + piece.high), curve));
            } else {
                halve(piece, stack[depth + 1], stack[depth]);
                depth += 2;
            }
        }
    }

    static double first(const double* c, const double* d, double curve) {
        Piece stack[64];
        stack[0].low = 0.0;
        stack[0].high = 1.0;
        convert(c, stack[0].b);
        for (int depth = 1; depth > 0;) {
            const Piece piece = stack[--depth];
            int changes = 0;
            for (int i = 1; i <= degree; ++i) changes += (piece.b[i] < 0.0) != (piece.b[i - 1] < 0.0);
            if (changes == 0 && !(piece.b[0] < 0.0)) {
                if (piece.b[degree] == 0.0 && piece.high == 1.0 && piece.b[degree - 1] > 0.0) return 1.0;
                continue;
            }
            if (changes == 1 && piece.b[0] > 0.0)
                return polished<degree>(c, d, piece.low, piece.high, 0.5 * (piece.low + piece.high), curve);
            if (depth + 2 > 64 || piece.high - piece.low < 1e-14) {
                if (piece.b[degree] < 0.0) return 0.5 * (piece.low + piece.high);
                continue;
            }
            halve(piece, stack[depth + 1], stack[depth]);
            depth += 2;
        }
        return 2.0;
    }
};

// Zero at which the parabola c0 + c1 x + c2 x^2 decreases, if this zero is in (0, 1); otherwise 1/2.
inline double parabola_zero(double c0, double c1, double c2) {
    const double root = std::sqrt(std::max(c1 * c1 - 4.0 * c0 * c2, 0.0));
    const double x = c1 > 0.0 ? (root + c1) / (-2.0 * c2) : 2.0 * c0 / (root - c1);
    return x > 0.0 && x < 1.0 ? x : 0.5;
}

// Reports all positions in (0, 1) at which a polynomial changes from plus to minus, in order.
template <int degree, class Report>
inline void each_fall(const double* c, Report report) {
    double bend = 0.0, curve = 0.0, d[degree];
    if constexpr (degree > 2) {
        if (c[0] == 0.0) return each_fall<degree - 1>(c + 1, report);  // divided by the known zero
        for (int k = 3; k <= degree; ++k) bend = fma(k * (k - 1.0), std::fabs(c[k]), bend);
    }
    slopes_of<degree>(c, d);
    curve = fma(0.5, bend, std::fabs(c[2]));
    if (2.0 * std::fabs(c[2]) > bend) {  // the curvature has one sign: two zeros at most
        const double end = value_of<degree>(c, 1.0);
        if (c[0] > 0.0 && end < 0.0)
            return report(polished<degree>(c, d, 0.0, 1.0, parabola_zero(c[0], c[1], c[2]), curve));
        if ((c[0] < 0.0 && (end > 0.0 || (end < 0.0 && c[2] > 0.0))) || (c[0] > 0.0 && end > 0.0 && c[2] < 0.0)) return;
    }
    Isolation<degree>::each(c, d, curve, report);
}

// First zero in (0, 1] of a polynomial with a positive start; 2 if there is no zero.
template <int degree>
inline double first_zero(const double* c) {
    double residual = 0.0, bend = 0.0, curve = 0.0;
    ROCKING_UNROLL
    for (int k = 1; k <= degree; ++k) {
        const double size = std::fabs(c[k]);
        residual += size;
        if (k > 1) bend = fma(static_cast<double>(k), size, bend);
        if (k > 1) curve = fma(0.5 * k * (k - 1), size, curve);
    }
    if (c[0] > residual) return 2.0;
    double d[degree];
    slopes_of<degree>(c, d);
    if (-c[1] > bend) {  // the polynomial decreases everywhere: at most one zero, and a parabola gives a good guess
        const double end = value_of<degree>(c, 1.0);
        if (end > 0.0) return 2.0;
        if (end == 0.0) return 1.0;
        return polished<degree>(c, d, 0.0, 1.0, parabola_zero(c[0], c[1], degree > 1 ? c[2] : 0.0), curve);
    }
    return Isolation<degree>::first(c, d, curve);
}

}  // namespace ROCKING_ISA
}  // namespace rocking
