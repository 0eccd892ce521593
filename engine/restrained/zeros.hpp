// The first position on [0, 1] at which a polynomial becomes negative.
#pragma once
#include <algorithm>
#include <cmath>

namespace rocking::restrained {

constexpr int kTop = 33;
constexpr double kRounding = 1e-9, kNone_ = 2.0;

inline double value_at(const double* c, int n, double x) {
    double total = 0.0;
    for (int k = n; k-- > 0;) total = total * x + c[k];
    return total;
}

// Zero between two points of opposite signs, by Newton's method with bisection.
inline double zero_between(const double* c, const double* d, int n, double low, double high) {
    const bool rises = value_at(c, n, low) < 0.0;
    double x = 0.5 * (low + high);
    for (int round = 0; round < 80; ++round) {
        const double y = value_at(c, n, x), rate = value_at(d, n - 1, x);
        ((y < 0.0) == rises ? low : high) = x;
        double to = rate != 0.0 ? x - y / rate : low;
        if (!(low < to && to < high)) to = 0.5 * (low + high);
        if (std::fabs(to - x) <= 2e-16 * std::fabs(x)) break;
        x = to;
    }
    return x;
}

// Changes of sign on [0, 1 + 1e-9]; at most one lies between two zeros of the slope (Rolle).
inline int zeros(const double* c, int n, double* x) {
    while (n > 1 && c[0] == 0.0) ++c, --n;
    double low = c[0], high = c[0];
    for (int k = 1; k < n; ++k) (c[k] < 0.0 ? low : high) += c[k];
    if (n < 2 || low > 0.0 || high < 0.0) return 0;
    double d[kTop], stops[kTop];
    for (int k = 1; k < n; ++k) d[k - 1] = k * c[k];
    stops[0] = 0.0;
    int count = 1 + zeros(d, n - 1, stops + 1), total = 0;
    stops[count++] = 1.0 + 1e-9;
    bool below = value_at(c, n, 0.0) < 0.0;
    for (int k = 1; k < count; ++k) {
        const bool next = value_at(c, n, stops[k]) < 0.0;
        if (next != below) x[total++] = zero_between(c, d, n, stops[k - 1], stops[k]);
        below = next;
    }
    return total;
}

// A zero at the start is a touch; after a release a negative value there can only be a rounding error. 2 if there is no
// zero.
inline double first_fall(const double* c, int n) {
    if (!(c[0] > 0.0)) {
        ++c, --n;
        for (; n > 1; ++c, --n) {
            double most = 0.0;
            for (int k = 1; k < n; ++k) most = std::max(most, std::fabs(c[k]));
            if (!(c[0] <= 0.0 && c[0] >= -kRounding * most)) break;
        }
        if (n < 1 || (n == 1 && c[0] == 0.0)) return kNone_;
        if (c[0] < 0.0) return 0.0;
    }
    double low = c[0], falls = 0.0;
    for (int k = 1; k < n; ++k) low += std::min(c[k], 0.0), falls += std::max(c[k], 0.0);
    if (low > 0.0 || n < 2) return kNone_;
    if (c[1] < 0.0 && falls == 0.0) {  // the polynomial decreases everywhere: at most one zero
        double d[kTop];
        for (int k = 1; k < n; ++k) d[k - 1] = k * c[k];
        return value_at(c, n, 1.0) < 0.0 ? zero_between(c, d, n, 0.0, 1.0) : kNone_;
    }
    double x[kTop];
    const int count = zeros(c, n, x);
    for (int k = 0; k < count; ++k) {
        double rate = 0.0;
        for (int j = n - 1; j > 0; --j) rate = rate * x[k] + j * c[j];
        if (x[k] > 0.0 && x[k] <= 1.0 && rate < 0.0) return x[k];
    }
    return kNone_;
}

}  // namespace rocking::restrained
