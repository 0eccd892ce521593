// First time in a step at which a series becomes negative.
#pragma once
#include "../roots.hpp"
#include "flow.hpp"

namespace rocking::spatial {
namespace ROCKING_ISA {

constexpr double kNone = 2.0, kNothing = 1e-13, kSlowOpening = 1e-9;

inline double value_of(const double* c, int order, double at) {
    double total = c[order];
    for (int k = order - 1; k >= 0; --k) total = total * at + c[k];
    return total;
}

inline double slope_of(const double* c, int order, double at) {
    double total = 0.0;
    for (int k = order; k > 0; --k) total = total * at + k * c[k];
    return total;
}

// First change to negative values in (0, 1] of a polynomial with a positive start; kNone if there is none.
inline double first_fall(const double* c, int order) {
    double residual = c[0], padded[kMostOrder + 1] = {};
    for (int k = 1; k <= order; ++k) residual += lesser(c[k], 0.0);
    if (residual > 0.0) return kNone;
    for (int k = 0; k <= order; ++k) padded[k] = c[k];
    if (order <= 4) return rocking::ROCKING_ISA::first_zero<4>(padded);
    if (order <= 8) return rocking::ROCKING_ISA::first_zero<8>(padded);
    return rocking::ROCKING_ISA::first_zero<kMostOrder>(padded);
}

// `started`: true if the gap has just opened; its initial zero is ignored. Coefficients up to `floor` count as 0.
inline double first_zero(const double* c, int order, bool started, double floor) {
    double most = 0.0;
    for (int k = 0; k <= order; ++k) most = greater(most, std::fabs(c[k]));
    if (!std::isfinite(most)) return kNone;
    int first = 0;
    if (started) {
        const double small = kNothing * most;
        first = 1;
        while (first <= order && !(std::fabs(c[first]) > (first < 3 ? greater(floor, small) : small))) ++first;
        if (first > order) return kNone;
    } else if (c[0] == 0.0 && order > 0) {
        first = 1;
    }
    if (c[first] < 0.0) return 0.0;
    double terms[kMostOrder + 1];
    for (int k = first; k <= order; ++k) terms[k - first] = c[k];
    if (terms[0] == 0.0) terms[0] = 5e-324;
    return first_fall(terms, order - first);
}

}  // namespace ROCKING_ISA
}  // namespace rocking::spatial
