// One impact from its start to its end, with adaptive steps. Every switch is at the end of a step.
#pragma once
#include <limits>

#include "switches.hpp"

namespace rocking::bed {

constexpr double kLeak = 0.09;   // allowed energy error of a step / (tolerance * energy of the impact)
// energy error budget of an impact; the allowed error of a step decreases with the remaining budget
constexpr double kBudget = 7.0;
constexpr double kLeast = 3e-4;  // fraction of the budget that a step may always use; near rounding
// first step after a switch / previous first step after a switch, for forces that begin as d^n
constexpr double kAgain = 1.2;

class Run : Switches {
public:
    Run(const Problem& p, const Start& start, Trace* trace)
        : Switches(p, start), trace_(trace), on_(trace ? p.points.count : 0, -1.0) {
        const double d = start.depth, v = start.speed, b = start.half_base;
        unit_ = {d, d / b, v, v, v / b};
        nudge_ = unit_;
        for (double& e : unit_) e *= start.tolerance;
        for (double& e : nudge_) e *= 1e-5;
        if (p.kind == kRegularised) nudge_[kU] = std::min(nudge_[kU], 1e-3 * p.creep);
        const double turn = 0.5 * v / b;
        leak_ = std::max(kLeak * start.tolerance, 2e-14) * 0.5 * (p.inertia + p.mass * (p.height * p.height + b * b)) * turn * turn;
        // the estimate has order 5, the step has order 9: the exponent converts the tolerance, as in the codes of
        // Hairer & Wanner
        estimate_ = std::max(0.1 * std::pow(start.tolerance, 0.6) / start.tolerance, 1.0);
        instant_ = std::max(start.tolerance, 1e-12) * d / v;
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
    Trace* trace_;
    std::vector<double> on_;
    State nudge_{};
    Result out_;
    double touch_impulse_ = 0, touch_moment_ = 0, touch_shear_ = 0;
    double impulse_ = 0, moment_ = 0, shear_ = 0;
    double energy_ = 0.0, leak_ = 0.0, instant_ = 0.0, contraction_ = 1.0;
    double after_ = 0.0;
    bool after_switch_ = false;
    int stuck_ = 0, early_ = 0, late_ = 0;
    // part of the time after x_ for which step_ is valid
    enum class Known { nothing, ahead, within } known_ = Known::nothing;
    bool local_known_ = false;
    Tangent<5> local_;

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
            const double target = std::min({h, cap, start_.longest - out_.time});
            if (!attempt(target)) {
                h = 0.25 * target;
                if (h < shortest) {
                    out_.status = kFailed;
                    return;
                }
                continue;
            }
            const double factor = 0.9 * std::pow(std::max(step_.error / estimate_, 1e-10), -1.0 / 6.0);
            if (step_.error > estimate_) {
                h = target * std::max(0.1, factor);
                ++out_.rejected;
                continue;
            }
            const double next = target * std::min(bed_.linear() ? 6.0 : 3.0, std::max(0.2, factor));
            arresting_ = start_.end == kAtPeak && out_.touch >= 0.0 && out_.parting < 0.0 && alone();
            const double tau = stuck_ > 100 ? 1.0 : first_cause();
            if (stuck_ > 100) {
                causes_.clear();
                ++out_.forced;
            }
            if (tau <= 0.0) {  // the mode has already ended
                if (react()) return;
                if (++stuck_ > 100) {  // between two modes: use a short step in the mode that conserves the energy
                    h = 1e-4 * start_.depth / start_.speed;
                    calm();
                }
                continue;
            }
            if (!causes_.empty() && !shorten(tau)) {
                h = 0.25 * target;
                ++out_.rejected;
                continue;
            }
            const Tally sum = tally();
            const double after = motion_.energy(step_.end(), places_[kStages], out_.travel + sum.travel, rates_[kStages]);
            const double leak = after - energy_ + sum.bed_loss + sum.friction_loss;
            const double allowed = allowance(leak);
            if (std::abs(leak) > allowed && step_.h > 1e5 * shortest && (stuck_ == 0 || stuck_ > 100)) {
                h = step_.h * std::max(0.1, 0.8 * std::pow(allowed / std::abs(leak), 1.0 / 3.5));
                ++out_.rejected;
                continue;
            }
            if (after_switch_) after_ = step_.h;
            after_switch_ = !causes_.empty();
            h = after_switch_ && !bed_.linear() && after_ > 0.0 ? std::min(next, kAgain * after_) : next;
            stuck_ = causes_.empty() || step_.h > 1e-12 * start_.depth / start_.speed ? 0 : stuck_ + 1;
            accept(sum);
            out_.residual += leak;
            energy_ = after;
            if (!causes_.empty() && react()) return;
            if (ended()) return;
        }
        out_.status = kTimeOut;
    }

    // Allowed energy error of a step. It decreases with the used budget, unless the error has the opposite sign.
    double allowance(double leak) const {
        const double used = leak * out_.residual > 0.0 ? std::abs(out_.residual) / (kBudget / kLeak * leak_) : 0.0;
        return leak_ * std::max(1.0 - used, kLeast);
    }

    // Makes a step from x_. The initial values are from the last step, which ended at x_ or was rejected there.
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

    void forget() {  // for use after a change of the equations
        local_known_ = false;
        known_ = Known::nothing;
        contraction_ = 1.0;
    }

    // Ends the step at the first switch. The switch is located on the polynomial of the step, then on that of the
    // shorter step.
    bool shorten(double tau) {
        if (tau >= 1.0) return true;
        const Step<5> covering = step_;
        const Cause cause = *std::min_element(causes_.begin(), causes_.end(), [](const Cause& a, const Cause& b) { return a.at < b.at; });
        double h = tau * covering.h, late = 0.0;
        bool early = false;
        for (int round = 0; round < 6; ++round) {
            Guess<5> guess;
            guess.any = true;
            for (int k = 0; k < kStages; ++k) guess.stage[k] = covering.at(radau::node[k] * h / covering.h);
            if (!take_step(motion_, x_, h, unit_, local_, guess, contraction_, step_)) return false;
            const double here = margin(cause, step_.end()), fall = (margin(cause, step_.at(0.999)) - here) / (1e-3 * h);
            late = fall > 0.0 ? -here / fall : 0.0;
            const double more = 0.3 * instant_ - late;
            early = here > 0.0 && !(late >= -instant_ && fall > 0.0);
            if ((late >= 0.0 && late <= instant_) || !(fall > 0.0) || more > std::max(0.02 * h, instant_) || more < -0.5 * h) break;
            h += more;
        }
        // a step that ends late may contain another switch: use a shorter step
        late_ = late > instant_ ? late_ + 1 : 0;
        if (late_ > 0 && late_ <= 3) return false;
        // the shorter step ends before the contact changes, or at a contact force of zero without a change of contact; the number of repetitions is limited
        early_ = early ? early_ + 1 : 0;
        if (early && early_ <= 3) causes_.clear();
        look_at_nodes();
        return true;
    }

    Tally tally() const {
        Tally sum;
        for (int k = 0; k < kStages; ++k) {
            const Rates& r = rates_[k + 1];
            const double node_weight = step_.h * radau::weight[k];
            sum.travel += node_weight * r.travel;
            sum.bed_loss += node_weight * r.bed_loss;
            sum.friction_loss += node_weight * r.friction_loss;
            sum.impulse += node_weight * r.normal;
            sum.moment += node_weight * r.moment;
            sum.shear += node_weight * r.shear;
            sum.slid += node_weight * (r.normal > 0.0 ? std::abs(step_.stage[k][kU]) : 0.0);
        }
        return sum;
    }

    double depth(const Place& at) const {
        const std::int64_t last = p_.points.count - 1;
        double d = std::max(-bed_.gap(0, at), -bed_.gap(last, at));
        for (std::int64_t i = 1; !bed_.flat && i < last; ++i) d = std::max(d, -bed_.gap(i, at));
        return d;
    }

    // Largest force and depth at the nodes, and between nodes at the vertex of the parabola through three nodes.
    void crests() {
        for (int which = 0; which < 2; ++which) {
            double g[kStages + 1];
            for (int k = 0; k <= kStages; ++k) g[k] = which == 0 ? rates_[k].normal : depth(places_[k]);
            double& most = which == 0 ? out_.peak_force : out_.deepest;
            for (int k = 1; k <= kStages; ++k) most = std::max(most, g[k]);
            for (int k = 1; k < kStages; ++k) {
                if (g[k] < g[k - 1] || g[k] < g[k + 1] || g[k] < 0.9 * most) continue;
                const double top = vertex(k, g);
                if (!(top > 0.0 && top < 1.0)) continue;
                const State x = step_.at(top);
                const Place at = place(x, p_.exact);
                most = std::max(most, which == 0 ? motion_.rates(x, at).normal : depth(at));
            }
        }
    }

    void accept(const Tally& sum) {
        const Rates* r = rates_ + 1;
        crests();
        if (trace_)
            for (int k = 0; k < kStages; ++k) {
                Tally tally;
                for (int j = 0; j < kStages; ++j) {
                    const double share = step_.h * radau::matrix[k][j];
                    tally.bed_loss += share * r[j].bed_loss;
                    tally.friction_loss += share * r[j].friction_loss;
                    tally.travel += share * r[j].travel;
                }
                record(step_.stage[k], radau::node[k] * step_.h, tally);
            }
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
        moved_ = true;
        known_ = Known::ahead;
        local_known_ = false;
        if (p_.kind == kCoulomb && motion_.slip == 0) x_[kU] = 0.0;
    }

    void record(const State& x, double after, const Tally& tally) {
        const Rates r = motion_.rates(x);
        trace_->samples.push_back({out_.time + after, out_.travel + tally.travel, r.normal, r.shear, r.moment,
                                   out_.bed_loss + tally.bed_loss, out_.friction_loss + tally.friction_loss, x});
        const Place at = place(x, p_.exact);
        for (std::int64_t i = 0; i < p_.points.count; ++i) trace_->forces.push_back(bed_.force(i, at));
    }

    // Applies the switches; true at the peak.
    bool react() {
        bool peak = false, rest = x_[kU] == 0.0, leaves = false;
        const Place at = place(x_, p_.exact);
        const bool floating = bed_.pressing == 0;
        for (const Cause& c : causes_) {
            if (c.point == -3) continue;
            ++out_.switches;
            if (c.point == -2) {
                peak = true;
            } else if (c.point == -1) {
                // the sliding has reversed
                if (motion_.slip != 0 && std::abs(x_[kU]) > std::max(1e-9 * start_.speed, 10.0 * unit_[kU])) {
                    motion_.slip = x_[kU] > 0.0 ? 1 : -1;
                    continue;
                }
                leaves = motion_.slip == 0;
                arrest();
                rest = true;
            } else {
                const bool before = holds(c.point);
                const double kept = bed_.stored(c.point, at);
                const Mode was = bed_.mode[c.point];
                bed_.change(c.point, c.which, at);
                // points that began to touch during the step before the switch
                if (was == Mode::spring && bed_.mode[c.point] == Mode::pressing) out_.bed_loss += kept - bed_.stored(c.point, at);
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

    // A shear impulse stops the remaining sliding. Its moment rotates the body. The energy balance includes its work.
    void arrest() {
        const double h = p_.height, inertia = p_.inertia + p_.mass * h * h, impulse = -p_.mass * p_.inertia / inertia * x_[kU];
        out_.friction_loss -= 0.5 * impulse * x_[kU];
        shear_ += impulse;
        x_[kOmega] -= impulse * h / p_.inertia;
        x_[kU] = 0.0;
    }

    void calm() {
        forget();
        if (x_[kU] == 0.0) motion_.slip = 0;
        if (p_.law != kPlastic || p_.rebound == 0.0) return;
        const Place at = place(x_, p_.exact);
        for (const Cause& c : causes_) {
            if (c.point < 0 || !holds(c.point)) continue;
            const double kept = bed_.stored(c.point, at);
            bed_.deepest[c.point] = std::max(bed_.deepest[c.point], -bed_.gap(c.point, at));
            bed_.mode[c.point] = Mode::spring;
            out_.bed_loss += kept - bed_.stored(c.point, at);
        }
        bed_.gather();
        energy_ = motion_.energy(x_, out_.travel);
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

    // True if only the new foot is in contact.
    bool alone() {
        for (std::int64_t i = 0; i < p_.points.count; ++i)
            if (holds(i) != (i == start_.new_foot)) return false;
        return true;
    }

    // The impact ends when only the new foot is in contact and is at rest.
    bool ended() {
        if (start_.end == kAtTime || out_.touch < 0.0) return false;
        const double slow = start_.end == kAtParting ? 1e-10 : (1.0 + 1e-6) * kArrested;
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
