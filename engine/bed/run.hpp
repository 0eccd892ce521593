// One impact from its start to its end: adaptive steps between switches, each switch at the end of a step.
#pragma once
#include <limits>

#include "motion.hpp"

namespace rocking::bed {

enum End : int { kAtPeak = 0, kAtParting = 1, kAtTime = 2 };
enum Status : int { kPeak = 0, kParted = 1, kTimeOut = 2, kTooManySteps = 3, kFailed = 4, kPastTopple = 5 };

struct Start {
    State state;
    double tolerance, depth, speed, half_base, longest, farthest;
    int end;
    std::int64_t new_foot, old_foot, most_steps;
};

struct Result {
    State state{};
    double time = 0, travel = 0, bed_loss = 0, friction_loss = 0, energy_start = 0, energy_end = 0, stored = 0, residual = 0;
    double peak_force = 0, deepest = 0, touch = -1, parting = -1, impulse = 0, impulse_moment = 0, shear_impulse = 0, slid = 0;
    std::int64_t steps = 0, rejected = 0, switches = 0, contacts = 0, forced = 0;
    int status = kTimeOut;
};

struct Sample {
    double time, travel, normal, shear, moment, bed_loss, friction_loss;
    State state;
};
struct Interval {
    std::int64_t point;
    double on, off;
};
struct Trace {
    std::vector<Sample> samples;
    std::vector<double> forces;
    std::vector<Interval> intervals;
};

constexpr double kLeak = 0.03;  // energy that one step may lose or find, over tolerance and energy of the impact

class Run {
public:
    Run(const Problem& p, const Start& start, Trace* trace)
        : p_(p), start_(start), bed_(p), motion_(p, bed_), trace_(trace), on_(trace ? p.points.count : 0, -1.0) {
        const double d = start.depth, v = start.speed, b = start.half_base;
        unit_ = {d, d / b, v, v, v / b};
        nudge_ = unit_;
        for (double& e : unit_) e *= start.tolerance;
        for (double& e : nudge_) e *= 1e-5;
        if (p.kind == kRegularised) nudge_[kU] = std::min(nudge_[kU], 1e-3 * p.creep);
        const double turn = 0.5 * v / b;
        leak_ = std::max(kLeak * start.tolerance, 2e-14) * 0.5 * (p.inertia + p.mass * (p.height * p.height + b * b)) * turn * turn;
        // the estimate has order 5, the step order 9: the power of the two, as in Hairer & Wanner's codes of this family
        estimate_ = std::max(0.1 * std::pow(start.tolerance, 0.6) / start.tolerance, 1.0);
        instant_ = std::max(0.1 * start.tolerance, 1e-12) * d / v;
    }

    Result run() {
        x_ = start_.state;
        bed_.begin(place(x_, p_.exact));
        bed_.gather();
        motion_.slip = x_[kU] > 0.0 ? 1 : x_[kU] < 0.0 ? -1 : 0;
        motion_.settle_friction(x_, x_[kU] == 0.0);
        out_.contacts = bed_.pressing > 0;
        out_.energy_start = motion_.energy(x_, 0.0);
        for (std::int64_t i = 0; i < p_.points.count; ++i) {
            if (!holds(i)) continue;
            if (i != start_.old_foot) out_.touch = 0.0;
            if (trace_) on_[i] = 0.0;
        }
        if (trace_) {
            record(x_, 0.0, Tally{});
        }
        loop();
        out_.state = x_;
        out_.stored = motion_.stored(place(x_, p_.exact));
        out_.energy_end = motion_.energy(x_, out_.travel);
        out_.residual = out_.energy_end + out_.bed_loss + out_.friction_loss - out_.energy_start;
        if (trace_)
            for (std::int64_t i = 0; i < p_.points.count; ++i)
                if (on_[i] >= 0.0) trace_->intervals.push_back({i, on_[i], std::numeric_limits<double>::infinity()});
        return out_;
    }

private:
    struct Tally {
        double travel = 0, bed_loss = 0, friction_loss = 0, impulse = 0, moment = 0, shear = 0, slid = 0;
    };
    struct Cause {
        std::int64_t point;  // -1 friction, -2 peak
        int which;
        double at;
    };

    const Problem& p_;
    const Start& start_;
    Bed bed_;
    Motion motion_;
    Trace* trace_;
    std::vector<double> on_;
    State x_{}, unit_{}, nudge_{};
    Result out_;
    Step<5> step_;
    std::vector<Cause> causes_;
    double touch_impulse_ = 0, touch_moment_ = 0, touch_shear_ = 0;
    double impulse_ = 0, moment_ = 0, shear_ = 0;
    double first_ = 1.0, energy_ = 0.0, leak_ = 0.0, estimate_ = 1.0, instant_ = 0.0, contraction_ = 1.0;
    int stuck_ = 0;
    enum class Known { nothing, ahead, within } known_ = Known::nothing;  // what step_ says about the time after x_
    bool local_known_ = false;
    Tangent<5> local_;
    Place places_[kStages + 1];
    Rates rates_[kStages + 1];

    bool holds(std::int64_t i) const { return bed_.mode[i] == Mode::pressing || bed_.mode[i] == Mode::spring; }

    void loop() {
        double h = 1e-3 * start_.depth / start_.speed;
        const double cap = 0.1 * start_.longest, shortest = 1e-14 * start_.depth / start_.speed;
        energy_ = motion_.energy(x_, out_.travel);
        while (out_.time < start_.longest) {
            if (out_.steps + out_.rejected >= start_.most_steps) {
                out_.status = kTooManySteps;
                return;
            }
            const double wanted = std::min({h, cap, start_.longest - out_.time});
            if (!attempt(wanted)) {
                h = 0.25 * wanted;
                if (h < shortest) {
                    out_.status = kFailed;
                    return;
                }
                continue;
            }
            const double factor = 0.9 * std::pow(std::max(step_.error / estimate_, 1e-10), -1.0 / 6.0);
            if (step_.error > estimate_) {
                h = wanted * std::max(0.1, factor);
                ++out_.rejected;
                continue;
            }
            const double next = wanted * std::min(6.0, std::max(0.2, factor));
            const double tau = stuck_ > 100 ? 1.0 : first_cause();
            if (stuck_ > 100) {
                causes_.clear();
                ++out_.forced;
            }
            if (tau <= 0.0) {  // the mode is already over
                if (react()) return;
                if (++stuck_ > 100) {  // on the edge of two modes: a short step in the one that keeps the energy
                    h = 1e-4 * start_.depth / start_.speed;
                    calm();
                }
                continue;
            }
            if (!causes_.empty() && !shorten(tau)) {
                h = 0.25 * wanted;
                ++out_.rejected;
                continue;
            }
            const Tally sum = tally();
            const double after = motion_.energy(step_.end(), places_[kStages], out_.travel + sum.travel);
            const double leak = std::abs(after - energy_ + sum.bed_loss + sum.friction_loss);
            if (leak > leak_ && step_.h > 1e5 * shortest && stuck_ == 0) {
                h = step_.h * std::max(0.1, 0.8 * std::pow(leak_ / leak, 1.0 / 6.0));
                ++out_.rejected;
                continue;
            }
            h = next;
            stuck_ = causes_.empty() || step_.h > 1e-12 * start_.depth / start_.speed ? 0 : stuck_ + 1;
            accept(sum);
            energy_ = after;
            if (!causes_.empty() && react()) return;
            if (ended()) return;
        }
        out_.status = kTimeOut;
    }

    // A step from x_; its guess comes from the last step, which leads up to x_ or was refused from there.
    bool attempt(double h) {
        if (!local_known_) local_ = tangent(motion_, x_, nudge_);
        local_known_ = true;
        Guess<5> guess;
        const double reach = h / step_.h;
        guess.any = known_ != Known::nothing && (known_ == Known::within ? reach <= 1.0 : reach <= 4.0);
        if (guess.any)
            for (int k = 0; k < kStages; ++k) guess.stage[k] = step_.at((known_ == Known::ahead ? 1.0 : 0.0) + radau::node[k] * reach);
        if (!take_step(motion_, x_, h, unit_, local_, guess, contraction_, step_)) {
            known_ = Known::nothing;
            contraction_ = 1.0;
            ++out_.rejected;
            return false;
        }
        known_ = Known::within;
        look_at_nodes();
        return true;
    }

    void look_at_nodes() {
        for (int k = 0; k <= kStages; ++k) {
            const State& x = k == 0 ? step_.start : step_.stage[k - 1];
            places_[k] = place(x, p_.exact);
            rates_[k] = motion_.rates(x, places_[k]);
        }
    }

    void forget() {  // the equations change
        local_known_ = false;
        known_ = Known::nothing;
        contraction_ = 1.0;
    }

    double peak_margin(const State& x) const { return start_.end == kAtPeak ? x[kOmega] : 1.0; }

    double margin(const Cause& c, const State& x) const {
        if (c.point == -1) return motion_.friction_margin(x);
        if (c.point == -2) return peak_margin(x);
        return bed_.margin(c.point, c.which, place(x, p_.exact));
    }

    // The first switch inside the step, as a share of it; causes_ holds what switches there.
    double first_cause() {
        causes_.clear();
        first_ = 1.0;
        double g[2][kStages + 1];
        for (std::int64_t i = 0; i < p_.points.count; ++i) {
            const int kinds = bed_.margins(i, places_, g);
            for (int which = 0; which < kinds; ++which) look({i, which, 0.0}, g[which]);
        }
        if (p_.kind == kCoulomb) {
            for (int k = 0; k <= kStages; ++k) g[0][k] = motion_.friction_margin(k == 0 ? step_.start : step_.stage[k - 1], rates_[k]);
            look({-1, 0, 0.0}, g[0]);
        }
        if (start_.end == kAtPeak && out_.steps > 0) {
            for (int k = 0; k <= kStages; ++k) g[0][k] = (k == 0 ? step_.start : step_.stage[k - 1])[kOmega];
            look({-2, 0, 0.0}, g[0]);
        }
        const double near = first_ + 1e-12;
        causes_.erase(std::remove_if(causes_.begin(), causes_.end(), [near](const Cause& c) { return c.at > near; }), causes_.end());
        return causes_.empty() ? 1.0 : first_;
    }

    // Adds a margin that runs out before those found so far; g: its values at the start and at the nodes.
    void look(Cause c, const double* g) {
        double low = g[1], high = g[1];
        for (int k = 2; k <= kStages; ++k) low = low < g[k] ? low : g[k], high = high > g[k] ? high : g[k];
        if (low <= 0.6 * (std::max(high, g[0]) - std::min(low, g[0]))) search(c, g, high - low);  // else too far off to dip below zero
    }

    void search(Cause c, const double* g, double range) {
        double from = 0.0, to = 2.0;
        for (int k = kStages; k >= 1; --k)
            if (g[k] < 0.0) from = instant(k - 1), to = instant(k);
        for (int k = 1; k < kStages && instant(k - 1) < to; ++k) {  // a dip between nodes, from the parabola through three
            const double x0 = instant(k - 1), x1 = instant(k), x2 = instant(k + 1);
            const double first = (g[k] - g[k - 1]) / (x1 - x0), bend = ((g[k + 1] - g[k]) / (x2 - x1) - first) / (x2 - x0);
            if (!(bend > 0.0)) continue;
            const double dip = 0.5 * (x0 + x1 - first / bend);
            if (dip <= x0 || dip >= std::min(x2, to) || margin(c, step_.at(dip)) >= -1e-10 * range) continue;
            from = g[k] > 0.0 && dip > x1 ? x1 : x0;
            to = dip;
        }
        if (to > 1.0 || from > first_ + 1e-12) return;
        c.at = root(c, from, to);
        first_ = std::min(first_, c.at);
        causes_.push_back(c);
    }

    static double instant(int k) { return k == 0 ? 0.0 : radau::node[k - 1]; }

    double root(const Cause& c, double low, double high) const {
        double f_low = margin(c, step_.at(low)), f_high = margin(c, step_.at(high));
        if (f_low <= 0.0) return low;
        for (int round = 0; round < 60 && high - low > 1e-14; ++round) {
            double mid = low + (high - low) * f_low / (f_low - f_high);
            const double least = 1e-3 * (high - low);
            mid = round % 3 == 2 ? 0.5 * (low + high) : std::min(std::max(mid, low + least), high - least);
            const double f = margin(c, step_.at(mid));
            if (f > 0.0) low = mid, f_low = f;
            else high = mid, f_high = f;
        }
        return high;
    }

    // Ends the step at the first switch: found on its polynomial, then on that of the shorter step itself.
    bool shorten(double tau) {
        if (tau >= 1.0) return true;
        const Step<5> covering = step_;
        const Cause cause = *std::min_element(causes_.begin(), causes_.end(), [](const Cause& a, const Cause& b) { return a.at < b.at; });
        double h = tau * covering.h;
        for (int round = 0; round < 4; ++round) {
            Guess<5> guess;
            guess.any = true;
            for (int k = 0; k < kStages; ++k) guess.stage[k] = covering.at(radau::node[k] * h / covering.h);
            if (!take_step(motion_, x_, h, unit_, local_, guess, contraction_, step_)) return false;
            const double here = margin(cause, step_.end()), fall = (margin(cause, step_.at(0.999)) - here) / (1e-3 * h);
            const double late = fall > 0.0 ? -here / fall : 0.0;
            if ((late >= 0.0 && late <= instant_) || std::abs(late) > 0.02 * h || !(fall > 0.0)) break;
            h += 0.3 * instant_ - late;
        }
        look_at_nodes();
        return true;
    }

    Tally tally() const {
        Tally sum;
        for (int k = 0; k < kStages; ++k) {
            const Rates& r = rates_[k + 1];
            const double part = step_.h * radau::weight[k];
            sum.travel += part * r.travel;
            sum.bed_loss += part * r.bed_loss;
            sum.friction_loss += part * r.friction_loss;
            sum.impulse += part * r.normal;
            sum.moment += part * r.moment;
            sum.shear += part * r.shear;
            sum.slid += part * (r.normal > 0.0 ? std::abs(step_.stage[k][kU]) : 0.0);
        }
        return sum;
    }

    void accept(const Tally& sum) {
        const Rates* r = rates_ + 1;
        for (int k = 0; k < kStages; ++k) out_.peak_force = std::max(out_.peak_force, r[k].normal);
        if (trace_)
            for (int k = 0; k < kStages; ++k) {
                Tally part;
                for (int j = 0; j < kStages; ++j) {
                    const double share = step_.h * radau::matrix[k][j];
                    part.bed_loss += share * r[j].bed_loss;
                    part.friction_loss += share * r[j].friction_loss;
                    part.travel += share * r[j].travel;
                }
                record(step_.stage[k], radau::node[k] * step_.h, part);
            }
        const Place& at = places_[kStages];
        for (std::int64_t i = 0; i < p_.points.count; ++i) out_.deepest = std::max(out_.deepest, -bed_.gap(i, at));
        out_.time += step_.h;
        out_.travel += sum.travel;
        out_.bed_loss += sum.bed_loss;
        out_.friction_loss += sum.friction_loss;
        out_.slid += sum.slid;
        impulse_ += sum.impulse;
        moment_ += sum.moment;
        shear_ += sum.shear;
        ++out_.steps;
        x_ = step_.end();
        known_ = Known::ahead;
        local_known_ = false;
        if (p_.kind == kCoulomb && motion_.slip == 0) x_[kU] = 0.0;
    }

    void record(const State& x, double after, const Tally& part) {
        const Rates r = motion_.rates(x);
        trace_->samples.push_back({out_.time + after, out_.travel + part.travel, r.normal, r.shear, r.moment,
                                   out_.bed_loss + part.bed_loss, out_.friction_loss + part.friction_loss, x});
        const Place at = place(x, p_.exact);
        for (std::int64_t i = 0; i < p_.points.count; ++i) trace_->forces.push_back(bed_.force(i, at));
    }

    // Carries the switches out; true at the peak.
    bool react() {
        bool peak = false, rest = x_[kU] == 0.0, leaves = false;
        const Place at = place(x_, p_.exact);
        const bool floating = bed_.pressing == 0;
        for (const Cause& c : causes_) {
            ++out_.switches;
            if (c.point == -2) {
                peak = true;
            } else if (c.point == -1) {
                if (motion_.slip != 0 && std::abs(x_[kU]) > 1e-9 * start_.speed) {  // it slides the other way
                    motion_.slip = x_[kU] > 0.0 ? 1 : -1;
                    continue;
                }
                leaves = motion_.slip == 0;
                x_[kU] = 0.0;
                rest = true;
            } else {
                const bool before = holds(c.point);
                bed_.change(c.point, c.which, at);
                note(c.point, before, holds(c.point));
            }
        }
        bed_.gather();
        forget();
        energy_ = motion_.energy(x_, out_.travel);
        if (floating && bed_.pressing > 0) ++out_.contacts;
        motion_.settle_friction(x_, rest, leaves);
        if (!peak) return false;
        out_.status = kPeak;
        return true;
    }

    void calm() {
        forget();
        if (x_[kU] == 0.0) motion_.slip = 0;
        if (p_.law != kPlastic || p_.rebound == 0.0) return;
        const Place at = place(x_, p_.exact);
        for (const Cause& c : causes_) {
            if (c.point < 0 || !holds(c.point)) continue;
            bed_.deepest[c.point] = std::max(bed_.deepest[c.point], -bed_.gap(c.point, at));
            bed_.mode[c.point] = Mode::spring;
        }
        bed_.gather();
    }

    void note(std::int64_t i, bool before, bool after) {
        if (before == after) return;
        if (after && i != start_.old_foot && out_.touch < 0.0) {
            out_.touch = out_.time;
            touch_impulse_ = impulse_;
            touch_moment_ = moment_;
            touch_shear_ = shear_;
        }
        if (!trace_) return;
        if (after) on_[i] = out_.time;
        else trace_->intervals.push_back({i, on_[i], out_.time}), on_[i] = -1.0;
    }

    // The impact is over when only the new foot presses, and is arrested.
    bool ended() {
        if (start_.end == kAtTime || out_.touch < 0.0) return false;
        const double slow = start_.end == kAtParting ? 1e-10 : 1e-3;
        if (start_.end == kAtPeak && std::abs(x_[kTheta]) > start_.farthest) {
            out_.status = kPastTopple;
            return true;
        }
        const Place at = place(x_, p_.exact);
        bool over = true;
        for (std::int64_t i = 0; over && i < p_.points.count; ++i)
            if (holds(i)) over = (start_.end == kAtParting || i == start_.new_foot) && -bed_.rate(i, at) <= slow * start_.speed;
        if (!over) return false;
        const bool springs_back = p_.stiffness > 0.0 && (p_.law != kPlastic || p_.rebound > 0.0);
        if (start_.end == kAtParting && springs_back && bed_.pressing > 0) return false;
        if (out_.parting < 0.0) {
            out_.parting = out_.time;
            out_.impulse = impulse_ - touch_impulse_;
            out_.impulse_moment = moment_ - touch_moment_;
            out_.shear_impulse = shear_ - touch_shear_;
        }
        if (start_.end != kAtParting) return false;
        out_.status = kParted;
        return true;
    }
};

}  // namespace rocking::bed
