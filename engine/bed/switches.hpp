// A step and the first switch in it: a point begins or ends contact or changes its mode, the base starts or stops
// sliding, the rotation reaches its peak, or the new foot alone presses and comes to rest (arrest), which ends the
// impact.
#pragma once
#include "motion.hpp"
#include "result.hpp"

namespace rocking::bed {

class Switches {
protected:
    Switches(const Problem& p, const Start& start) : p_(p), start_(start), bed_(p), motion_(p, bed_) {}

    struct Cause {
        std::int64_t point;  // -1 friction, -2 peak, -3 arrest
        int which;
        double at;
    };

    const Problem& p_;
    const Start& start_;
    Bed bed_;
    Motion motion_;
    State x_{}, unit_{}, just_after_{};  // just_after_: the first switch found so far
    Step<5> step_;
    Place places_[kStages + 1];  // positions of the base at the start and at the nodes of the step
    Rates rates_[kStages + 1];
    std::vector<Cause> causes_;
    double first_ = 1.0, estimate_ = 1.0;
    bool moved_ = false, arresting_ = false;

    void look_at_nodes() {
        for (int k = 0; k <= kStages; ++k) {
            const State& x = k == 0 ? step_.start : step_.stage[k - 1];
            places_[k] = place(x, p_.exact);
            rates_[k] = motion_.rates(x, places_[k]);
        }
    }

    double peak_margin(const State& x) const { return start_.end == kAtPeak ? x[kOmega] : 1.0; }

    // Fraction of the landing speed below which the new foot is at rest.
    static constexpr double kArrested = 1e-3;

    double arrest_margin(const Place& at) const { return -bed_.rate(start_.new_foot, at) - kArrested * start_.speed; }

    double margin(const Cause& c, const State& x) const {
        if (c.point == -1) return motion_.friction_margin(x);
        if (c.point == -2) return peak_margin(x);
        if (c.point == -3) return arrest_margin(place(x, p_.exact));
        return bed_.margin(c.point, c.which, place(x, p_.exact));
    }

    // The first switch in the step, as a fraction of the step; causes_ contains its causes.
    double first_cause() {
        causes_.clear();
        first_ = 1.0;
        double g[2][kStages + 1];
        for (std::int64_t i = 0, end; i < p_.points.count; i = end) {
            for (end = i + 1; bed_.affine && end < p_.points.count && bed_.mode[end] == bed_.mode[i];) ++end;
            look_along(i, end - 1);
        }
        if (p_.kind == kCoulomb) {
            for (int k = 0; k <= kStages; ++k) g[0][k] = motion_.friction_margin(k == 0 ? step_.start : step_.stage[k - 1], rates_[k]);
            look({-1, 0, 0.0}, g[0]);
        }
        if (start_.end == kAtPeak && moved_) {
            for (int k = 0; k <= kStages; ++k) g[0][k] = (k == 0 ? step_.start : step_.stage[k - 1])[kOmega];
            look({-2, 0, 0.0}, g[0]);
        }
        if (arresting_) {
            for (int k = 0; k <= kStages; ++k) g[0][k] = arrest_margin(places_[k]);
            look({-3, 0, 0.0}, g[0]);
        }
        const double near = first_ + 1e-12;
        causes_.erase(std::remove_if(causes_.begin(), causes_.end(), [near](const Cause& c) { return c.at > near; }), causes_.end());
        return causes_.empty() ? 1.0 : first_;
    }

    // Examines points i to j of one mode. If the margins are linear and far from zero at i and j, no point between has
    // a switch.
    void look_along(std::int64_t i, std::int64_t j) {
        double g[2][kStages + 1], other[2][kStages + 1];
        const int kinds = bed_.margins(i, places_, g);
        if (j > i) bed_.margins(j, places_, other);
        bool far = true;
        for (int which = 0; which < kinds; ++which) {
            const Span a = span(g[which]), b = j > i ? span(other[which]) : a;
            far = far && std::min(a.low, b.low) > 0.6 * std::max(a.range, b.range);
        }
        if (far) return;
        for (int which = 0; which < kinds; ++which) {
            look({i, which, 0.0}, g[which]);
            if (j > i) look({j, which, 0.0}, other[which]);
        }
        const std::int64_t middle = i + (j - i) / 2;
        if (middle > i) look_along(i + 1, middle);
        if (j - 1 > middle) look_along(std::max(middle, i) + 1, j - 1);
    }

    struct Span {
        double low, range;
    };
    static Span span(const double* g) {
        double low = g[1], high = g[1];
        for (int k = 2; k <= kStages; ++k) low = low < g[k] ? low : g[k], high = high > g[k] ? high : g[k];
        return {low, std::max(high, g[0]) - std::min(low, g[0])};
    }

    // Adds a switch if margin c reaches zero before the known switches; g: values of the margin at the start and at the
    // nodes.
    void look(Cause c, const double* g) {
        const Span s = span(g);
        if (s.low <= 0.6 * s.range) search(c, g, s.range);  // larger margins cannot reach zero between nodes
    }

    void search(Cause c, const double* g, double range) {
        double from = 0.0, to = 2.0;
        // when sliding has just begun, the error of the sliding speed is as large as the speed
        const double floor = c.point == -1 && motion_.slip != 0 && x_[kU] == 0.0 ? unit_[kU] : 0.0;
        for (int k = kStages; k >= 1; --k)
            if (g[k] < -floor) from = instant(k - 1), to = instant(k);
        // minimum between nodes, from the parabola through three nodes
        for (int k = 1; k < kStages && instant(k - 1) < to; ++k) {
            const double x0 = instant(k - 1), x1 = instant(k), x2 = instant(k + 1);
            const double first = (g[k] - g[k - 1]) / (x1 - x0), bend = ((g[k + 1] - g[k]) / (x2 - x1) - first) / (x2 - x0);
            if (!(bend > 0.0)) continue;
            const double dip = 0.5 * (x0 + x1 - first / bend);
            if (dip <= x0 || dip >= std::min(x2, to) || margin(c, step_.at(dip)) >= -1e-10 * range - estimate_ * floor) continue;
            from = g[k] > 0.0 && dip > x1 ? x1 : x0;
            to = dip;
        }
        if (to > 1.0 || from > first_ + 1e-12) return;
        if (to > first_ + 1e-12 && first_ < 1.0) {
            if (margin(c, just_after_) > 0.0) return;  // this switch is later
            to = first_ + 1e-12;
        }
        c.at = root(c, from, to);
        causes_.push_back(c);
        if (c.at >= first_) return;
        first_ = c.at;
        just_after_ = step_.at(first_ + 1e-12);
    }

    static double instant(int k) { return k == 0 ? 0.0 : radau::node[k - 1]; }

    double root(const Cause& c, double low, double high) const {
        const double from = low;
        double f_low = margin(c, step_.at(low)), f_high = margin(c, step_.at(high));
        // the sliding speed starts at zero and returns to zero
        if (f_low <= 0.0 && c.point == -1 && motion_.slip != 0 && x_[kU] == 0.0)
            for (double fraction = 0.5; fraction > 1e-4 && f_low <= 0.0; fraction *= 0.5) low = fraction * high, f_low = margin(c, step_.at(low));
        if (f_low <= 0.0) return from;
        for (int round = 0; round < 60 && high - low > 1e-14; ++round) {
            double mid = low + (high - low) * f_low / (f_low - f_high);
            const double resolution = 1e-3 * (high - low);
            mid = round % 3 == 2 ? 0.5 * (low + high) : std::min(std::max(mid, low + resolution), high - resolution);
            const double f = margin(c, step_.at(mid));
            if (f > 0.0) low = mid, f_low = f;
            else high = mid, f_high = f;
        }
        return high;
    }

    // Position of the vertex of the parabola through nodes k - 1, k, k + 1.
    static double vertex(int k, const double* g) {
        const double x0 = instant(k - 1), x1 = instant(k), x2 = instant(k + 1);
        const double first = (g[k] - g[k - 1]) / (x1 - x0), bend = ((g[k + 1] - g[k]) / (x2 - x1) - first) / (x2 - x0);
        return 0.5 * (x0 + x1 - first / bend);
    }
};

}  // namespace rocking::bed
