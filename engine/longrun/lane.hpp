// One of the histories that are computed in parallel: body, forcing, state, and all events apart from regular steps
// (impacts, rest, uplift).
//
// y = |rotation| about the corner in contact: y'' = -p^2 (sin(alpha - y) + s u cos(alpha - y)), u = ground acceleration / g,
// s = +-1 the side; linear: y'' = -p^2 (alpha - y + s u). An impact turns the velocity v < 0 at y = 0 into r |v| on the other side.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "../pack.hpp"
#include "../roots.hpp"
#include "../sine.hpp"
#include "kernel.hpp"

namespace rocking::ROCKING_ISA::longrun {

using namespace rocking::longrun;

constexpr int kOrder = 18, kTerms = kOrder + 1;
constexpr double kPi = 3.14159265358979323846, kPiLow = 1.2246467991473532e-16;

enum class Event : int { none, impact, rest, overturned, failed };

// An angle minus a multiple of pi; sign: factor of sine and cosine.
inline double reduced(double angle, double& sign) {
    const double halves = std::nearbyint(angle / kPi);
    sign = static_cast<std::int64_t>(halves) & 1 ? -1.0 : 1.0;
    return fma(-halves, kPiLow, fma(-halves, kPi, angle));
}

// A polynomial of a step over 0 <= x <= 1.
struct Column {
    double c[kTerms];
    void derivatives(double x, double& value, double& slope, double& half) const {
        value = c[kOrder];
        slope = half = 0.0;
        for (int k = kOrder - 1; k >= 0; --k) {
            half = fma(half, x, slope);
            slope = fma(slope, x, value);
            value = fma(value, x, c[k]);
        }
    }
    // First zero on (0, 1]; a zero of multiplicity `skip` at the start is ignored. Above 1 if there is no zero.
    double zero(int skip) const {
        if (skip == 0) return first_zero<kOrder>(c);
        if (skip == 1) return first_zero<kOrder - 1>(c + 1);
        if (skip == 2) return first_zero<kOrder - 2>(c + 2);
        return first_zero<kOrder - 3>(c + 3);
    }
    // Largest value of sign * polynomial at zeros of the slope between 0 and `end`; minus infinity if there is no such
    // zero.
    double top(double end, double sign = 1.0) const {
        double slope[kOrder], largest = -INFINITY;
        slopes_of<kOrder>(c, slope);
        for (double& term : slope) term *= sign;
        each_fall<kOrder - 1>(slope, [&](double x) { largest = x < end ? std::max(largest, sign * value_of<kOrder>(c, x)) : largest; });
        return largest;
    }
};

template <int V>
struct Lane {
    Side side[2];
    // ground acceleration / g at uplift; cosine of alpha, or 1 for the linear equations
    double threshold[2], cosine[2];
    const Sine* sines;
    Settings set;
    std::int64_t row = -1, impacts = 0, rests = 0, steps = 0;
    int s = 0;  // side in contact: 0 for a positive rotation
    bool resting = false, lifts = false;
    double t = 0.0, y = 0.0, v = 0.0, until = 0.0, tangent[V > 0 ? V : 1][2] = {};
    // largest y and smallest minimum / alpha; velocity and acceleration before the last impact
    double peak = 0.0, trough = INFINITY, before = 0.0, falling = 0.0;
    std::int64_t cycle = 0, stored = 0, earlier_impacts = 0, earlier_rests = 0;  // used by the driver
    double growth[2] = {};

    void begin(const double* body, const Sine* forcing, const Settings& settings) {
        *this = Lane();
        sines = forcing;
        set = settings;
        for (int k = 0; k < 2; ++k) {
            side[k] = {body[3 * k], body[3 * k + 1], body[3 * k + 2]};
            double sine;
            sine_cosine(side[k].alpha, sine, cosine[k]);
            threshold[k] = set.linear ? side[k].alpha : sine / cosine[k];
            if (set.linear) cosine[k] = 1.0;
        }
    }
    double sign() const { return s == 0 ? 1.0 : -1.0; }

    // Ground acceleration / g and its rate.
    void ground(double& acceleration, double& rate) const {
        acceleration = rate = 0.0;
        for (int i = 0; i < set.sines; ++i) {
            double sine, cosine, flip;
            sine_cosine(reduced(fma(sines[i].omega, t, sines[i].phase), flip), sine, cosine);
            acceleration = fma(flip * sines[i].amplitude, sine, acceleration);
            rate = fma(flip * sines[i].amplitude * sines[i].omega, cosine, rate);
        }
    }
    // Acceleration of y on the side in contact at y = 0.
    double acceleration() const {
        double u, rate;
        ground(u, rate);
        return -side[s].p2 * cosine[s] * fma(sign(), u, threshold[s]);
    }
    // Puts the body at rest, or starts its rise if the ground already causes uplift.
    void settle() {
        double u, rate;
        ground(u, rate);
        y = v = 0.0;
        resting = true;
        for (int k = 0; k < 2; ++k)
            if ((k == 0 ? -u : u) > threshold[k]) {
                s = k;
                resting = false;
            }
    }
    // Waits until the ground acceleration reaches the threshold of a side, with steps that cannot pass this time.
    void wait() {
        double bound = 0.0;  // bound of the second derivative of the ground acceleration
        for (int i = 0; i < set.sines; ++i) bound = fma(std::fabs(sines[i].amplitude) * sines[i].omega, sines[i].omega, bound);
        while (resting && t < until) {
            double u, rate, h = until - t;
            ground(u, rate);
            for (int k = 0; k < 2; ++k) {
                const double from = k == 0 ? -1.0 : 1.0, gap = threshold[k] - from * u, towards = from * rate;
                const double safe = gap > 0.0 ? 2.0 * gap / (towards + std::sqrt(towards * towards + 2.0 * bound * gap)) : 0.0;
                if (safe <= 2e-16 * std::fabs(t) + 1e-300 && towards > 0.0) {
                    s = k;
                    resting = false;
                    lifts = true;
                    return;
                }
                h = std::min(h, std::max(safe, 2e-16 * std::fabs(t)));
            }
            t = h < until - t ? t + h : until;
        }
    }
    // Index of the last point of the speed law at or below a rate; -1 below all points, the last point above all
    // points.
    int interval(double rate) const { return static_cast<int>(std::upper_bound(set.law.at, set.law.at + set.law.points, rate) - set.law.at) - 1; }
    double slope_at(double rate) const {
        const int k = interval(rate);
        if (k < 0 || k + 1 >= set.law.points) return 0.0;
        return (set.law.factors[k + 1] - set.law.factors[k]) / (set.law.at[k + 1] - set.law.at[k]);
    }
    double factor_at(double rate) const {
        if (set.law.points == 0) return 1.0;
        const int k = std::max(interval(rate), 0);
        return fma(slope_at(rate), rate - set.law.at[k], set.law.factors[k]);
    }
    // The impact at y = 0 with a velocity v < 0. Tangent vectors: saltation matrix [[r, 0], [(a+ - r' a-) / v-, r']],
    // r' = d(r v) / dv.
    Event land() {
        const double rate = -v, factor = factor_at(rate), r = side[s].r * factor, derivative = fma(side[s].r * slope_at(rate), rate, r);
        before = v;
        ++impacts;
        s = 1 - s;
        y = 0.0;
        if (!(r * rate > set.rest * side[s].alpha * std::sqrt(side[s].p2))) {
            ++rests;
            for (auto& vector : tangent) vector[0] = vector[1] = 0.0;
            settle();
            return Event::rest;
        }
        v = r * rate;
        if constexpr (V > 0) {
            const double after = acceleration();
            for (auto& vector : tangent) {
                vector[1] = fma(fma(derivative, falling, after) / before, vector[0], -derivative * vector[1]);
                vector[0] *= -r;
            }
            if (set.parameter == Parameter::restitution) tangent[V - 1][1] += rate * factor;
        }
        return Event::impact;
    }
    // At larger speeds beyond the point of no return, no ground motion of this size brings the body back.
    bool is_lost() const {
        if (!set.linear) return y > set.overturned;
        double most = 0.0;
        for (int i = 0; i < set.sines; ++i) most += std::fabs(sines[i].amplitude);
        return v > 0.0 && y - side[s].alpha > most;
    }
};

}  // namespace rocking::ROCKING_ISA::longrun
