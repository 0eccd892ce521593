// One history of a body with restraints: Taylor steps from event to event. All events are zeros of the series.
#pragma once
#include <vector>

#include "rest.hpp"
#include "series.hpp"
#include "zeros.hpp"

namespace rocking::restrained {

enum Outcome : std::int64_t { kNoUplift = 0, kRocked = 1, kOverturned = 2, kFailed = 3, kHeld = 7 };
enum Status : std::int64_t { kGood = 0, kInvalid = 1, kNotFinite = 2, kTooManyEvents = 3, kLostContact = 5, kStuck = 6 };
enum BodyEvent : int { kUplift = 0, kImpact = 1, kRest = 2 };
constexpr double kEnd = 1.0 - 1e-13, kHalfPi = 1.5707963267948966, kSingular = 1e-14, kTie = 1e-11, kAfter = 30.0, kBlocked = 1e9;
constexpr int kInstants = 32;  // instants per step at which the contact with a wall is recorded

struct Settings {
    double gravity, rest_speed, tolerance;
    std::int64_t most_events;
    bool linear;
};

struct Result {
    std::int64_t outcome = kFailed, status = kInvalid, side = 0, impacts = 0, uplifts = 0, still_rocking = 0;
    double peak_rotation = 0.0, peak_time = 0.0, peak_velocity = 0.0, overturning_time = kNan, first_uplift = kNan, residual_rotation = 0.0;
};

// Output of a single history: samples, and events as rows (kind, time, side or restraint, 4 numbers).
struct Trace {
    double *rotation, *velocity, *work, *elongation, *force, *restraint_work;  // one row per sample
    std::vector<double> body, restraints, peaks, contacts;  // contacts: time, theta, theta', forces in contact with walls
};

class Run {
  public:
    Run(const Body& body, const Motion& motion, double scale, std::int64_t count, const Settings& set, std::vector<Device>& devices, Trace* trace)
        : b_(body), m_(motion), scale_(scale / set.gravity), count_(count), end_(count), set_(set), d_(devices), trace_(trace), s_(set.tolerance) {
        for (int k = 0; k < 2; ++k) {
            const Side& s = b_.sides[k];
            const double top = (k ? -1.0 : 1.0) * s.alpha;
            q_[k] = {k ? -1.0 : 1.0, s.alpha, s.p, s.inertia, std::sin(top), std::cos(top), set.linear};
        }
        for (const Device& d : d_)
            for (int k = 0; k < 2; ++k)
                if (!std::isnan(d.law.rebound) && (k ? -1.0 : 1.0) * d.levers[k].at_rest < 0.0) rebound_[k] = d.law.rebound;
        for (const Device& d : d_) powers_ |= d.law.is_power(), friction_ |= d.law.slip_force != 0.0;
    }

    Result run(double rotation, double velocity) {
        side_ = rotation > 0.0 || (rotation == 0.0 && velocity > 0.0) ? 1 : -1;
        theta_ = rotation, rate_ = velocity;
        for (Device& d : d_) d.load(lever(d).elongation(rotation));
        start();
        while (!done_) step(1.0);
        r_.residual_rotation = last_theta_;
        r_.still_rocking = r_.outcome == kRocked && (last_theta_ != 0.0 || last_rate_ != 0.0);
        return r_;
    }

  private:
    int at() const { return side_ > 0 ? 0 : 1; }
    const Equation& q() const { return q_[at()]; }
    const Lever& lever(const Device& d) const { return d.levers[at()]; }
    double now() const { return (stretch_ + tau_) * m_.step; }
    double slow() const { return kSingular * q().p * q().alpha; }

    void start() {
        const bool upright = std::fabs(theta_) <= 1e-16;
        if (upright && std::fabs(rate_) <= kNothing * q().p * q().alpha) {
            theta_ = rate_ = 0.0;
            sample();
            return stay();
        }
        sample();
        ++r_.uplifts, r_.first_uplift = 0.0;
        note(kUplift, 0.0, 0.0, 0.0);
        peak();
        if (rate_ == 0.0) turn();
        else head(rate_ > 0.0 ? 1 : -1);
    }

    // Ground motion over the part of the segment after tau, divided by g: push and weight.
    int ground(double width, double* push, double* weight) const {
        for (int k = 0; k < m_.terms; ++k) push[k] = weight[k] = 0.0;
        if (stretch_ < std::min(m_.count, count_)) {
            m_.shifted(m_.push, stretch_, tau_, width, scale_, push);
            if (m_.lift) m_.shifted(m_.lift, stretch_, tau_, width, scale_, weight);
        }
        weight[0] += 1.0;
        return m_.terms;
    }

    void step(double width) {
        width = std::min(width, longest() - tau_);
        const double h = h_ = width * m_.step;
        const bool singular = powers_ && std::fabs(rate_) < slow();
        double push[kGround], weight[kGround];
        const int terms = ground(width, push, weight), count = static_cast<int>(d_.size());
        for (int i = 0; i < count; ++i) s_.items[i].is_viscous = !d_[i].law.is_power() || (!singular && lever(d_[i]).slope(theta_) != 0.0);
        s_.expand(q(), theta_, rate_, h, push, weight, terms, d_.data(), count);
        if (singular) return pass_turn(h, width);
        const double fraction = trusted(h);
        if (!(fraction > 0.0)) {  // next to a turning point with a power-law damper
            if (!powers_ || width < 1e-20) return end(kFailed, kNotFinite);
            return step(1e-4 * width);
        }
        find_event(fraction);
        const double x = next_.kind == kNone ? fraction : next_.x * fraction;
        at_once_ = x > 0.0 ? 0 : at_once_ + 1;
        if (at_once_ > 1000) return end(kFailed, kStuck);
        add_work(x, push, weight, terms);
        if (std::any_of(d_.begin(), d_.end(), [](const Device& d) { return d.law.touches(); })) note_contact(x, width);
        theta_ = value(s_.theta, s_.n, x), rate_ = slope(s_.theta, s_.n, x) / h;
        r_.peak_velocity = std::max(r_.peak_velocity, std::fabs(rate_));
        carry(x, h);
        move(x == 1.0 && width + tau_ == longest() ? longest() : tau_ + x * width);
        if (next_.kind != kNone && !done_) act();
    }

    // Makes long steps on resting ground if no samples are needed.
    double longest() const { return !trace_ && stretch_ >= m_.count ? static_cast<double>(end_ - stretch_) : 1.0; }

    double trusted(double h) const {
        const int n = s_.n;
        for (int k = n - 2; k < n; ++k)
            if (!std::isfinite(s_.theta[k])) return 0.0;
        if (s_.ended) return 1.0;
        double fraction = 1.0;
        const double bound = set_.tolerance * std::max(q().alpha, std::fabs(theta_));
        for (int k = n - 2; k < n; ++k) {
            const double size = std::fabs(s_.theta[k]), fast = k * size / (h * q().p);
            if (size > bound) fraction = std::min(fraction, std::pow(bound / size, 1.0 / k));
            if (fast > bound) fraction = std::min(fraction, std::pow(bound / fast, 1.0 / (k - 1)));
        }
        return fraction;
    }

    enum What { kNone, kContact, kLies, kLimit, kArm, kTurn };
    struct Next {
        double x = 2.0;
        What kind = kNone;
        int device = 0;
        bool upwards = false;
    };

    void offer(const double* c, int n, double fraction, double sign, double first, What kind, int device = 0, bool upwards = false) {
        double bound = 0.0;
        for (int k = 1; k < n; ++k) bound += std::fabs(c[k]);
        if (first > bound) return;  // also valid for a shorter step
        double power = fraction, scaled[kMost + 2];
        scaled[0] = first;
        for (int k = 1; k < n; ++k, power *= fraction) scaled[k] = sign * c[k] * power;
        const double x = first_fall(scaled, n);
        if (x > 1.0) return;
        const double rank = kind == kContact ? x - kTie : x, best = next_.kind == kContact ? next_.x - kTie : next_.x;
        // a limit that is reached at the impact belongs to the impact
        if (rank < best) next_ = {x, kind, device, upwards};
    }

    void find_event(double fraction) {
        next_ = {};
        const int n = s_.n;
        offer(s_.theta, n, fraction, side_, side_ * s_.theta[0], kContact);
        offer(s_.theta, n, fraction, -side_, kHalfPi - side_ * s_.theta[0], kLies);
        for (int i = 0; i < static_cast<int>(d_.size()); ++i) {
            const Phase& p = d_[i].law.phase;
            if (p.high < kInf) offer(s_.items[i].elongation, n - 2, fraction, -1.0, p.high - d_[i].elongation, kLimit, i, true);
            if (p.low > -kInf) offer(s_.items[i].elongation, n - 2, fraction, 1.0, d_[i].elongation - p.low, kLimit, i, false);
            if (d_[i].law.touches() || p.name == kReleased) offer_margin(i, fraction);
            const double arm = s_.items[i].slope[0];
            if (p.direction && arm != 0.0) offer(s_.items[i].slope, n - 2, fraction, std::copysign(1.0, arm), std::fabs(arm), kArm, i);
        }
        double rate[kMost + 1];
        for (int k = 1; k < n; ++k) rate[k - 1] = k * s_.theta[k];
        offer(rate, n - 1, fraction, direction_, direction_ * rate[0], kTurn);
    }

    // The force k d + c d' of a wall ends its contact at 0, and begins the contact if the point is inside the wall.
    void offer_margin(int i, double fraction) {
        const Law& law = d_[i].law;
        const double sign = law.touches() ? -1.0 : 1.0, damping = law.damping / h_;
        double force[kMost + 1];
        const int n = s_.n - 2;
        for (int k = 0; k < n; ++k) force[k] = law.stiffness * s_.items[i].elongation[k] + damping * s_.items[i].rate[k];
        force[0] += law.stiffness * law.gap;
        offer(force, n, fraction, sign, sign * force[0], kLimit, i, law.touches());
    }

    // Records extremes of forces, and for a trace time, state and forces, at instants of a step in contact with a wall.
    void note_contact(double x, double width) {
        const int n = s_.n - 2;
        for (int k = rate_ == 0.0; k <= kInstants; ++k) {
            const double y = x * k / kInstants;
            if (trace_) trace_->contacts.insert(trace_->contacts.end(), {now() + y * width * m_.step, value(s_.theta, s_.n, y), slope(s_.theta, s_.n, y) / h_});
            for (std::size_t i = 0; i < d_.size(); ++i) {
                const Terms& t = s_.items[i];
                const bool viscous = d_[i].law.coefficient != 0.0 && t.is_viscous;
                const double e = lever(d_[i]).linear ? lever(d_[i]).at_rest * value(s_.theta, s_.n, y) : value(t.elongation, n, y);
                const double f = d_[i].law.phase.force(e) + (viscous ? value(t.viscous, n, y) : 0.0);
                d_[i].note_force(f);
                if (trace_) trace_->contacts.push_back(f);
            }
        }
    }

    // Adds the work of viscous forces, and for a trace the work of the ground.
    void add_work(double x, const double* push, const double* weight, int terms) {
        const int n = s_.n;
        for (std::size_t i = 0; i < d_.size(); ++i) {
            if (d_[i].law.coefficient == 0.0 || !s_.items[i].is_viscous) continue;
            double f[kMost + 1], v[kMost + 1], power = 1.0, total = 0.0;
            for (int k = 0; k < n - 2; ++k, power *= x) f[k] = s_.items[i].viscous[k] * power, v[k] = s_.items[i].rate[k] * power;
            for (int k = 0; k < n - 2; ++k) total += product(f, v, k) / (k + 1);
            d_[i].work += x * total;
        }
        if (!trace_) return;
        double theta[kMost + 1], rates[kMost + 1], sines[kMost + 1], cosines[kMost + 1], force[kMost + 1], power = 1.0, total = 0.0;
        for (int k = 0; k < n; ++k, power *= x) theta[k] = s_.theta[k] * power;
        for (int k = 0; k + 1 < n; ++k) rates[k] = (k + 1) * theta[k + 1];
        const double top = q().side * q().alpha - theta[0];
        sines[0] = q().linear ? top : std::sin(top), cosines[0] = q().linear ? 1.0 : std::cos(top);
        for (int k = 1; k + 1 < n; ++k) {
            sines[k] = q().linear ? -theta[k] : -product(rates, cosines, k - 1) / k;
            cosines[k] = q().linear ? 0.0 : product(rates, sines, k - 1) / k;
        }
        for (int k = 0; k + 1 < n; ++k) {
            force[k] = 0.0, power = 1.0;
            for (int j = 0; j < terms && j <= k; ++j, power *= x) force[k] += power * (push[j] * cosines[k - j] + (weight[j] - (j ? 0.0 : 1.0)) * sines[k - j]);
        }
        for (int k = 0; k + 1 < n; ++k) total += product(force, rates, k) / (k + 1);
        work_ -= b_.sides[at()].unit * total;  // Eq. 351
    }

    // Leaves or reaches a turning point without the damper, since its power law has no series there.
    void pass_turn(double h, double width) {
        const double first = s_.theta[1], second = s_.theta[2], third = s_.theta[3];
        const bool reaches = first * second < 0.0;
        double x;
        if (reaches) {
            x = std::min(1.0, -0.5 * first / second);
        } else {
            const double speed = 1.01 * slow() * h, root = std::fabs(second) + std::sqrt(second * second + 3.0 * std::fabs(third) * speed);
            x = root > 0.0 ? std::min(1.0, speed / root) : 1.0;
        }
        theta_ = value(s_.theta, s_.n, x), rate_ = reaches ? 0.0 : slope(s_.theta, s_.n, x) / h;
        next_ = {};
        carry(x, h);
        move(tau_ + x * width);
        if (reaches && !done_) turn();
    }

    void act() {
        const Next event = next_;
        if (++acts_ > 20 * set_.most_events) return end(kFailed, kTooManyEvents);
        if (event.kind == kContact) return impact();
        if (event.kind == kLies) return end(kOverturned, kGood);
        if (event.kind == kTurn) return turn();
        Device& d = d_[event.device];
        const double before = d.force();
        if (event.kind == kLimit) d.law.cross(d.elongation, event.upwards);
        else d.law.settle(d.elongation, -d.law.phase.direction);
        note_phase(event.device, before);
    }

    void impact() {
        r_.overturning_time = kNan;
        theta_ = 0.0;
        const double before = rate_, speed = std::fabs(rate_);
        const double at_wall = rebound_[1 - at()];
        if (std::isnan(at_wall)) side_ = -side_;
        const double r = std::isnan(at_wall) ? b_.sides[at()].coefficient : at_wall;
        rate_ = r * before + 0.0;  // Eq. 28; not -0 after a stop
        ++r_.impacts;
        note(kImpact, before, rate_, r);
        if (r_.impacts >= set_.most_events) return end(kFailed, kTooManyEvents);
        if (stretch_ >= count_) return end(kRocked, kGood);
        for (Device& d : d_) d.elongation = 0.0;
        const Holding held = holding();
        const bool exact = friction_ || !std::isnan(rebound_[0]) || !std::isnan(rebound_[1]);
        if (comes_to_rest(b_, held, m_, stretch_ < m_.count ? stretch_ : m_.count, tau_, count_, scale_, side_, std::fabs(r) * speed, exact ? 0.0 : set_.rest_speed)) {
            note(kRest, 0.0, 0.0, 0.0);
            rate_ = 0.0;
            for (Device& d : d_) d.rate = 0.0;
            return stay();
        }
        head(side_);
    }

    // Sets the phase of all restraints for a direction of theta'.
    void head(int direction) {
        direction_ = direction;
        for (std::size_t i = 0; i < d_.size(); ++i) {
            Device& d = d_[i];
            const double arm = lever(d).slope(theta_), before = trace_ ? d.force() : 0.0;
            const int phase = d.law.phase.name;
            d.law.settle(d.elongation, arm * direction > 0.0 ? 1 : arm * direction < 0.0 ? -1 : 0);
            d.rate = arm * rate_;
            if (d.law.touches() && d.force() > 0.0) d.law.cross(d.elongation, true);
            if (d.law.phase.name != phase) note_phase(static_cast<int>(i), before);
        }
    }

    void turn() {
        rate_ = 0.0;
        if (stretch_ >= count_ && side_ * acceleration_now() < 0.0) {
            peak();
            return end(kRocked, kGood);
        }
        peak();
        if (trace_) trace_->peaks.insert(trace_->peaks.end(), {now(), theta_});
        for (Device& d : d_) d.rate = 0.0;
        const double a = acceleration_now(), limit = friction();
        if (std::fabs(a) > limit) return head(a > 0.0 ? 1 : -1);
        hold(limit);
    }

    // Keeps the rotation until the moment exceeds the friction.
    void hold(double limit) {
        const double still = acceleration(0.0, 0.0), by_push = acceleration(1.0, 0.0) - still, by_weight = acceleration(0.0, 1.0) - still;
        while (stretch_ < count_) {
            double push[kGround], weight[kGround], best = 2.0;
            const double width = 1.0 - tau_;
            const int terms = ground(width, push, weight);
            int way = 0;
            for (int sign : {1, -1}) {
                double c[kGround];
                for (int k = 0; k < terms; ++k) c[k] = -sign * (by_push * push[k] + by_weight * weight[k]);
                c[0] += limit - sign * still;
                const double x = first_fall(c, terms);
                if (x <= 1.0 && x < best) best = x, way = sign;
            }
            if (way) {
                move(tau_ + best * width);
                if (!done_) head(way);
                return;
            }
            move(1.0);
        }
    }

    void stay() {
        if (done_) return;
        const Holding held = holding();
        const std::int64_t last = std::min(m_.count, count_);
        if (held.at(b_, 0, m_, stretch_, tau_, last, scale_) < 0.0 && held.at(b_, 1, m_, stretch_, tau_, last, scale_) < 0.0) return end(kFailed, kLostContact);
        for (std::int64_t k = stretch_; k < last; ++k) {
            const double from = k == stretch_ ? tau_ : 0.0, right = held.release(b_, 0, m_, k, from, scale_), left = held.release(b_, 1, m_, k, from, scale_);
            int side = right < left ? 1 : left < right ? -1 : 0;
            double x = std::min(right, left);
            if (!side && right <= 1.0) {  // both sides at once
                const double push = scale_ * m_.value_of(m_.push, k, right);
                side = push > 0.0 ? -1 : push < 0.0 ? 1 : 0;
            }
            if (!side) continue;
            skip_to(k);
            side_ = side;
            move(x);
            if (done_) return;
            ++r_.uplifts;
            if (!(r_.first_uplift >= 0.0)) r_.first_uplift = now();
            note(kUplift, 0.0, 0.0, 0.0);
            return head(side_);
        }
        skip_to(count_);
    }

    void skip_to(std::int64_t k) {
        if (!trace_ && k > stretch_) {
            stretch_ = k - 1, tau_ = 0.0;
            move(1.0);
        }
        while (stretch_ < k && !done_) move(1.0);
    }

    Holding holding() const {
        Holding held;
        for (int k = 0; k < 2; ++k) {
            double moment = 0.0;
            for (const Device& d : d_) {
                const double arm = d.levers[k].at_rest;
                moment += d.law.slip_force != 0.0 ? d.law.slip_force * std::fabs(arm) : (k ? -1.0 : 1.0) * arm * d.law.phase.force(0.0);
            }
            held.more[k] = moment / b_.sides[k].unit + (std::isnan(rebound_[k]) ? 0.0 : kBlocked);  // Eq. 353
            held.sine[k] = set_.linear ? b_.sides[k].alpha : std::sin(b_.sides[k].alpha);
            held.cosine[k] = set_.linear ? 1.0 : std::cos(b_.sides[k].alpha);
        }
        return held;
    }

    // theta'' without viscous forces and friction.
    double acceleration(double push, double weight) const {
        const double top = q().side * q().alpha - theta_, sine = q().linear ? top : std::sin(top), cosine = q().linear ? 1.0 : std::cos(top);
        double moment = 0.0;
        for (const Device& d : d_)
            if (d.law.slip_force == 0.0) moment += lever(d).slope(theta_) * d.law.phase.force(d.elongation);
        return -q().p * q().p * (weight * sine + push * cosine) - moment / q().inertia;
    }
    double acceleration_now() const {
        double push[kGround], weight[kGround];
        ground(1.0, push, weight);
        return acceleration(push[0], weight[0]);
    }
    double friction() const {
        double total = 0.0;
        for (const Device& d : d_) total += d.law.slip_force * std::fabs(lever(d).slope(theta_));
        return total / q().inertia;
    }

    void carry(double x, double h) {
        const bool lands = next_.kind == kContact, turns = next_.kind == kTurn || rate_ == 0.0;
        if (lands) theta_ = 0.0;
        if (turns) rate_ = 0.0;
        const int n = s_.n - 2;
        for (std::size_t i = 0; i < d_.size(); ++i) {
            const Terms& t = s_.items[i];
            const double e = lands ? 0.0 : lever(d_[i]).linear ? lever(d_[i]).at_rest * theta_ : value(t.elongation, n, x);
            d_[i].move(e, turns ? 0.0 : lands ? lever(d_[i]).at_rest * rate_ : value(t.rate, n, x) / h);
        }
        if (!(side_ * theta_ > q().alpha)) r_.overturning_time = kNan;
        else if (!(r_.overturning_time >= 0.0)) r_.overturning_time = now();
    }

    void move(double tau) {
        while (tau >= kEnd && !done_) {
            const std::int64_t stretches = longest() > 1.0 ? static_cast<std::int64_t>(tau + (1.0 - kEnd)) : 1;
            stretch_ += stretches, tau = std::max(tau - static_cast<double>(stretches), 0.0), tau_ = 0.0;
            if (tau < 1.0 - kEnd) tau = 0.0;
            if (stretch_ <= count_) sample();
            if (stretch_ == count_ && end_ == count_) finish();
            else if (stretch_ > count_ && (!may_overturn() || stretch_ >= end_)) end(kRocked, kGood);
        }
        if (!done_) tau_ = tau;
    }

    void finish() {
        peak();
        if (theta_ != 0.0 && rate_ == 0.0 && std::fabs(acceleration_now()) <= friction()) return end(kHeld, kGood);
        if (!may_overturn()) return end(r_.uplifts || r_.impacts ? kRocked : kNoUplift, kGood);
        // the outcome is computed on resting ground
        end_ = count_ + static_cast<std::int64_t>(std::ceil(kAfter / (q().p * m_.step)));
    }
    bool may_overturn() const { return theta_ != 0.0 && (side_ * rate_ > 0.0 || side_ * theta_ > q().alpha); }

    void end(std::int64_t outcome, std::int64_t status) {
        done_ = true, r_.outcome = outcome, r_.status = status;
        if (outcome == kOverturned) r_.side = side_, r_.peak_rotation = side_ * kHalfPi, r_.peak_time = r_.overturning_time;
        else r_.overturning_time = kNan;
    }

    void peak() {
        if (std::fabs(theta_) > std::fabs(r_.peak_rotation)) r_.peak_rotation = theta_, r_.peak_time = now();
    }

    void sample() {
        last_theta_ = theta_, last_rate_ = rate_;
        if (!trace_) return;
        const std::size_t n = d_.size(), k = static_cast<std::size_t>(stretch_);
        trace_->rotation[k] = theta_, trace_->velocity[k] = rate_, trace_->work[k] = work_;
        for (std::size_t i = 0; i < n; ++i)
            trace_->elongation[k * n + i] = d_[i].elongation, trace_->force[k * n + i] = d_[i].force(), trace_->restraint_work[k * n + i] = d_[i].work;
        written = stretch_ + 1;
    }
    void note(int kind, double before, double after, double r) {
        if (trace_) trace_->body.insert(trace_->body.end(), {double(kind), now(), double(side_), before, after, r});
    }
    void note_phase(int index, double before) {
        d_[index].note();
        if (trace_) trace_->restraints.insert(trace_->restraints.end(), {double(index), now(), double(d_[index].law.phase.name), theta_, d_[index].elongation, before});
    }

    const Body& b_;
    const Motion& m_;
    double scale_;
    std::int64_t count_, end_;
    const Settings& set_;
    std::vector<Device>& d_;
    Trace* trace_;
    Series s_;
    Equation q_[2];
    Next next_;
    Result r_;
    bool powers_ = false, friction_ = false, done_ = false;
    int side_ = 0, direction_ = 0, at_once_ = 0;
    std::int64_t stretch_ = 0, acts_ = 0;
    double theta_ = 0.0, rate_ = 0.0, tau_ = 0.0, work_ = 0.0, last_theta_ = 0.0, last_rate_ = 0.0, h_ = 0.0;
    double rebound_[2] = {kNan, kNan};  // coefficient of restitution at a rigid wall that blocks the right, the left side

  public:
    std::int64_t written = 0;  // number of samples
};

}  // namespace rocking::restrained
