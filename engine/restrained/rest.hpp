// At rest: restoring moments with those of restraints, uplift, and the proof that small impacts decay to rest.
#pragma once
#include <cstdint>

#include "zeros.hpp"

namespace rocking::restrained {

constexpr double kNothing = 1e-9, kLongest = 40.0, kHeights = 0.1;

// A ground motion as polynomials on equal segments.
struct Motion {
    const double *push, *lift;  // lift is null without a vertical part
    std::int64_t count;
    int terms;
    double step;

    double value_of(const double* c, std::int64_t stretch, double tau) const { return value_at(c + stretch * terms, terms, tau); }

    // The polynomial over a part of a segment, times a factor, as a function of y: time = tau + width y.
    void shifted(const double* from, std::int64_t stretch, double tau, double width, double factor, double* c) const {
        const double* a = from + stretch * terms;
        for (int k = 0; k < terms; ++k) c[k] = factor * a[k];
        if (tau != 0.0)
            for (int k = 0; k < terms - 1; ++k)
                for (int j = terms - 2; j >= k; --j) c[j] += tau * c[j + 1];
        double power = 1.0;
        for (int k = 0; k < terms; ++k, power *= width) c[k] *= power;
    }
};

struct Side {
    double alpha, p, inertia, unit, coefficient;  // unit: m g R
};

struct Body {
    Side sides[2];  // right, left
};

struct Extent {
    double low = 0.0, high = 0.0, variation = 0.0;
};

// Restoring moments D = (1 + a_z / g) sin alpha + s (a_x / g) cos alpha + moments of restraints / (m g R).
struct Holding {
    double more[2], sine[2], cosine[2];

    void polynomial(int side, const Motion& m, std::int64_t stretch, double scale, double* d) const {
        const double *a = m.push + stretch * m.terms, *z = m.lift ? m.lift + stretch * m.terms : nullptr;
        const double across = (side ? -scale : scale) * cosine[side];
        for (int k = 0; k < m.terms; ++k) d[k] = across * a[k] + (z ? scale * sine[side] * z[k] : 0.0);
        d[0] += sine[side] + more[side];
    }
    double at(const Body&, int side, const Motion& m, std::int64_t stretch, double tau, std::int64_t last, double scale) const {
        if (stretch >= last) return sine[side] + more[side];
        double d[8];
        polynomial(side, m, stretch, scale, d);
        return value_at(d, m.terms, tau);
    }
    // First instant of a segment at which the restoring moment of a side is not positive; 2 if there is none.
    double release(const Body&, int side, const Motion& m, std::int64_t stretch, double from, double scale) const {
        double d[8];
        polynomial(side, m, stretch, scale, d);
        double spread = 0.0;
        for (int k = 1; k < m.terms; ++k) spread += std::fabs(d[k]);
        if (d[0] > spread) return 2.0;
        if (value_at(d, m.terms, from) < 0.0) return from;
        if (m.terms == 2) {
            if (!(d[0] + d[1] < 0.0)) return 2.0;
            return std::min(std::max(-d[0] / d[1], from), 1.0);
        }
        for (int k = 0; k < m.terms - 1; ++k)
            for (int j = m.terms - 2; j >= k; --j) d[j] += from * d[j + 1];
        double power = 1.0;
        for (int k = 0; k < m.terms; ++k, power *= 1.0 - from) d[k] *= power;
        if (!(d[0] > 0.0)) d[0] = 5e-324;
        const double x = first_fall(d, m.terms);
        return x > 1.0 ? 2.0 : from + x * (1.0 - from);
    }
};

// Minimum, maximum and variation of a motion over several segments, from tau in the first segment; exact for linear
// motions.
inline Extent extent_of(const Motion& m, const double* c, std::int64_t first, std::int64_t stretches, double tau, double scale) {
    Extent e;
    double end = 0.0;
    for (std::int64_t k = 0; k < stretches; ++k) {
        const double* a = c + (first + k) * m.terms;
        double low, high, start = k ? a[0] : m.terms == 2 ? a[0] + a[1] * tau : a[0];
        if (m.terms == 2) {
            const double stop = a[0] + a[1];
            low = std::min(start, stop), high = std::max(start, stop), e.variation += std::fabs(stop - start) + (k ? std::fabs(start - end) : 0.0), end = stop;
        } else {
            low = high = a[0];
            e.variation += k ? std::fabs(a[0] - end) : 0.0, end = a[0];
            for (int j = 1; j < m.terms; ++j) (a[j] < 0.0 ? low : high) += a[j], e.variation += std::fabs(a[j]), end += a[j];
        }
        e.low = k ? std::min(e.low, low) : low, e.high = k ? std::max(e.high, high) : high;
    }
    e.low *= scale, e.high *= scale, e.variation *= std::fabs(scale);
    if (e.low > e.high) std::swap(e.low, e.high);
    return e;
}

// True if the next impacts provably decay to rest before the body can rise again (docs/theory/rest.md).
inline bool comes_to_rest(const Body& b, const Holding& held, const Motion& m, std::int64_t stretch, double tau, std::int64_t count, double scale, int sign,
                          double after, double rest_speed) {
    const int k = sign > 0 ? 0 : 1, o = 1 - k;
    const Side &side = b.sides[k], &other = b.sides[o];
    const double unit = side.p * side.alpha;
    const std::int64_t last = std::min(m.count, count);
    const double down = held.at(b, k, m, stretch, tau, last, scale);
    if (after <= kNothing * unit && down > 0.0) return true;
    if (!(after <= rest_speed * unit && down > 0.0)) return false;
    const double across = held.at(b, o, m, stretch, tau, last, scale);
    if (!(across > 0.0)) return false;
    const double step = m.step, p2 = side.p * side.p * step * step, p2_other = other.p * other.p * step * step;
    const double r = side.coefficient, q = other.coefficient, speed = after * step, lost = 1.0 - r * q;
    const double flights = 2.0 * speed * (p2_other * across + q * p2 * down), rate = p2 * down * (p2_other * across) * lost;  // Eq. 37
    if (!(flights < kLongest * rate)) return false;
    const double remaining = 1.0 - tau, guess = 1.5 * (flights / rate);
    const std::int64_t available = count - stretch;
    const std::int64_t stretches = guess > remaining ? std::min(static_cast<std::int64_t>(guess - remaining) + 2, available) : 1;
    const std::int64_t moving = std::max<std::int64_t>(0, std::min(stretches, last - stretch));
    Extent x, z;
    if (moving) {
        x = extent_of(m, m.push, stretch, moving, tau, scale);
        if (m.lift) z = extent_of(m, m.lift, stretch, moving, tau, scale);
    }
    if (moving < stretches) {  // the ground is at rest after the motion
        const double *a = m.push + (last - 1) * m.terms, *c = m.lift ? m.lift + (last - 1) * m.terms : nullptr;
        if (moving) x.variation += std::fabs(scale * value_at(a, m.terms, 1.0)), z.variation += c ? std::fabs(scale * value_at(c, m.terms, 1.0)) : 0.0;
        x.low = std::min(x.low, 0.0), x.high = std::max(x.high, 0.0), z.low = std::min(z.low, 0.0), z.high = std::max(z.high, 0.0);
    }
    double low[2];
    low[0] = (1.0 + z.low) * held.sine[0] + x.low * held.cosine[0] + held.more[0];
    low[1] = (1.0 + z.low) * held.sine[1] - x.high * held.cosine[1] + held.more[1];
    if (!(low[0] > 0.0 && low[1] > 0.0)) return false;
    const double variation = x.variation * std::max(held.cosine[0] / low[0], held.cosine[1] / low[1]) + z.variation * std::max(held.sine[0] / low[0], held.sine[1] / low[1]);  // Eq. 38
    const double steepness = std::max(std::fabs(1.0 + z.low), std::fabs(1.0 + z.high)) + std::max(std::fabs(x.low), std::fabs(x.high));  // Eq. 39
    const double w = 0.5 * (variation + kHeights), gain = 1.0 + w + w * w;
    const double heights = steepness * (speed * gain) * (speed * gain) / std::min(p2 * low[k] * low[k], p2_other * low[o] * low[o]);  // Eq. 40
    const double rq = r * q;
    if (!(w <= 1.0 && 2.2 * heights * (1.0 + q * q) <= kHeights * (1.0 - rq * rq) && heights <= 0.3)) return false;
    const double total = 2.0 * speed * gain * (1.0 / (p2 * low[k]) + q / (p2_other * low[o])) / (lost * (1.0 - heights));  // Eq. 16
    return total <= remaining + static_cast<double>(stretches - 1);
}

}  // namespace rocking::restrained
