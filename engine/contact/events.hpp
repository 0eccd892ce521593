// Functions that are positive as long as a mode is valid, their sign just after the start, and their first zero.
#pragma once
#include "series.hpp"

namespace rocking::contact {

enum class End { none, landing, loss_of_contact, slipping, sticking, lying };

struct Function {
    End kind;
    int exact;     // number of leading coefficients without rounding errors
    double scale;  // scale of the rounding errors of the other coefficients
    double c[kTerms];
};

struct Functions {
    int count = 0, n = 0;
    Function all[8];
    double* add(End kind, int exact, double scale) {
        Function& f = all[count++];
        f.kind = kind, f.exact = exact, f.scale = scale;
        return f.c;
    }
};

inline void functions_of(const Base& b, Mode m, const Series& c, double mu, double weight, Functions& f) {
    const int n = f.n = c.n;
    f.count = 0;
    double* to;
    for (int foot : {kLeft, kRight}) {
        if (m.feet & foot) {
            to = f.add(End::loss_of_contact, 0, weight);
            std::copy(c.normal[foot], c.normal[foot] + n, to);
        } else {
            to = f.add(End::landing, 2, weight * c.unit * c.unit / (m.feet ? b.size : 1.0));
            std::copy(c.gap[foot], c.gap[foot] + n, to);
        }
    }
    if (m.slip) {
        to = f.add(End::sticking, 1, weight * c.unit);
        for (int k = 0; k < n; ++k) to[k] = m.slip * c.sliding[k];
    } else if (m.feet) {
        double* less = f.add(End::slipping, 0, weight * (1.0 + mu));
        double* more = f.add(End::slipping, 0, weight * (1.0 + mu));
        for (int k = 0; k < n; ++k) {
            const double most = mu * ((m.feet & kLeft ? c.normal[kLeft][k] : 0.0) + (m.feet & kRight ? c.normal[kRight][k] : 0.0));
            less[k] = most - c.tangential[k], more[k] = most + c.tangential[k];  // Eq. 69
        }
    }
    if (m.feet == kBoth) return;
    double* right = f.add(End::lying, 2, HUGE_VAL);
    double* left = f.add(End::lying, 2, HUGE_VAL);
    for (int k = 0; k < n; ++k) right[k] = -c.rotation[k], left[k] = c.rotation[k];
    right[0] += kHalfPi, left[0] += kHalfPi;
}

// Index of the coefficient that determines the sign of a function just after the start; -1 if all coefficients are
// zero.
inline int leading(const Function& f, int n, double stretch, double tolerance) {
    double bound = tolerance * f.scale;
    for (int k = 0; k < std::min(n, 7); ++k) {
        if (k < f.exact) {
            if (f.c[k] != 0.0) return k;
            continue;
        }
        if (std::fabs(f.c[k]) > bound) return k;
        bound *= stretch;
    }
    return -1;
}

inline bool consistent(const Functions& f, double stretch, double tolerance) {
    for (int i = 0; i < f.count; ++i) {
        const int k = leading(f.all[i], f.n, stretch, tolerance);
        if (k >= 0 && !(f.all[i].c[k] > 0.0)) return false;
    }
    return true;
}

// Newton's method between two points with different signs.
inline double zero_between(const double* c, int n, double low, double high) {
    const bool rises = value(c, n, low) < 0.0;
    double x = 0.5 * (low + high);
    for (int round = 0; round < 80; ++round) {
        const double height = value(c, n, x), rate = slope(c, n, x);
        ((height < 0.0) == rises ? low : high) = x;
        double after = rate != 0.0 ? x - height / rate : low;  // Eq. 56
        if (!(low < after && after < high)) after = 0.5 * (low + high);
        if (std::fabs(after - x) <= 2e-16 * std::fabs(x)) break;
        x = after;
    }
    return x;
}

// Sign changes on [0, 1] and slightly beyond; at most one sign change lies between two zeros of the slope.
inline int zeros(const double* c, int n, double* out) {
    while (n > 1 && c[0] == 0.0) ++c, --n;
    double low = c[0], high = c[0];
    for (int k = 1; k < n; ++k) low += std::min(c[k], 0.0), high += std::max(c[k], 0.0);
    if (n < 2 || low > 0.0 || high < 0.0) return 0;
    double d[kTerms], stops[kTerms + 2];
    for (int k = 1; k < n; ++k) d[k - 1] = k * c[k];
    const int inner = zeros(d, n - 1, stops + 1);
    stops[0] = 0.0, stops[inner + 1] = 1.0 + 1e-9;
    int count = 0;
    bool below = value(c, n, 0.0) < 0.0;
    for (int i = 0; i <= inner; ++i) {
        const bool after = value(c, n, stops[i + 1]) < 0.0;
        if (after != below) out[count++] = zero_between(c, n, stops[i], stops[i + 1]);
        below = after;
    }
    return count;
}

// True if bounds of the series exclude every event, for one foot in contact.
inline bool uneventful(Mode m, const Series& c, double mu) {
    if (m.feet != kLeft && m.feet != kRight) return false;
    const double *normal = c.normal[m.feet], *gap = c.gap[kBoth - m.feet];
    double push = normal[0], open = gap[0], high = gap[0], grip = mu * normal[0] - std::fabs(c.tangential[0]), slide = m.slip * c.sliding[0];
    for (int k = 1; k < c.n; ++k) {
        push -= std::fabs(normal[k]), open += std::min(gap[k], 0.0), high += std::fabs(gap[k]);
        grip -= std::fabs(mu * normal[k]) + std::fabs(c.tangential[k]), slide -= std::fabs(c.sliding[k]);
    }
    return push > 1e-6 * std::fabs(normal[0]) && open > 1e-6 * high && high < kHalfPi && (m.slip ? slide > 1e-6 * std::fabs(c.sliding[0]) : grip > 1e-6 * mu * normal[0]);
}

// First position in (0, 1] where a polynomial with a positive start becomes negative (a touch is ignored); 2 if there
// is none.
inline double first_fall(const double* c, int n) {
    double low = c[0];
    for (int k = 1; k < n; ++k) low += std::min(c[k], 0.0);
    if (low > 0.0) return 2.0;
    while (n > 1 && c[n - 1] == 0.0) --n;
    double times[kTerms + 1];
    const int count = zeros(c, n, times);
    for (int i = 0; i < count; ++i)
        if (times[i] > 0.0 && times[i] <= 1.0 && slope(c, n, times[i]) < 0.0) return times[i];
    return 2.0;
}

// Time of the first zero of an event function, and its event.
inline double first_end(const Functions& f, double stretch, double tolerance, End& kind) {
    double first = 2.0;
    kind = End::none;
    for (int i = 0; i < f.count; ++i) {
        const int k = leading(f.all[i], f.n, stretch, tolerance);
        if (k < 0) continue;
        const double at = first_fall(f.all[i].c + k, f.n - k);
        if (at < first) first = at, kind = f.all[i].kind;
    }
    return first;
}

// Returns the contact mode after a state. The first valid mode is used: modes with more feet before modes with fewer
// feet, and sticking before sliding.
inline bool choose(const Base& b, const State& s, const Ground& g, double mu, Mode& mode, double& tolerance) {
    Mode tried[10];
    int count = 0;
    for (int feet : {kBoth, kLeft, kRight}) {
        if ((s.touching & feet) != feet) continue;
        bool rests = true;
        for (int foot : {kLeft, kRight}) rests &= !(feet & foot) || away(b, s, foot) == 0.0;
        if (!rests) continue;
        const double speed = along(b, s, feet == kBoth ? kLeft : feet);
        if (speed == 0.0) tried[count++] = {feet, 0};
        for (int slip : {1, -1})
            if (slip * speed >= 0.0) tried[count++] = {feet, slip};
    }
    tried[count++] = kFlight;
    Series c;
    Functions f[10];
    bool possible[10];
    for (int i = 0; i < count; ++i) {
        series_of(b, s, tried[i], g, mu, 8, c);
        possible[i] = c.stiff > 0.0;
        if (possible[i]) functions_of(b, tried[i], c, mu, g.weight(), f[i]);
    }
    for (double bound : {1e-12, 1e-10, 1e-8})
        for (int i = 0; i < count; ++i)
            if (possible[i] && consistent(f[i], 1.0, bound)) {
                mode = tried[i], tolerance = bound;
                return true;
            }
    return false;
}

}  // namespace rocking::contact
