// One history: Taylor series from event to event, with steps that end at samples; bounds skip segments at rest.
#pragma once
#include <vector>

#include "events.hpp"
#include "impact.hpp"

namespace rocking::contact {

constexpr int kBlock = 32;
constexpr double kWhole = 1.0 - 1e-13, kClosed = 1e-13, kTolerance = 1e-12, kLongest = 0.5, kPatience = 60.0, kLight = 1e-9;

struct Range {
    double low, high;
};

// A motion as polynomials on equal segments, and the ranges of its accelerations over blocks of them.
struct Motion {
    const double *push, *lift;  // coefficients, segment after segment; no lift without a vertical part
    std::int64_t count;
    int terms;
    double step;
    std::vector<Range> pushes, lifts;

    static Range range_of(const double* c, int terms) {
        if (terms == 2) return {std::min(c[0], c[0] + c[1]), std::max(c[0], c[0] + c[1])};
        Range r{c[0], c[0]};
        for (int k = 1; k < terms; ++k) r.low += std::min(c[k], 0.0), r.high += std::max(c[k], 0.0);
        return r;
    }
    static void blocks(const double* c, std::int64_t count, int terms, std::vector<Range>& ranges) {
        for (std::int64_t i = 0; i < count; ++i) {
            const Range r = range_of(c + i * terms, terms);
            if (i % kBlock == 0) ranges.push_back(r);
            ranges.back() = {std::min(ranges.back().low, r.low), std::max(ranges.back().high, r.high)};
        }
    }
    void screen() {
        blocks(push, count, terms, pushes);
        if (lift) blocks(lift, count, terms, lifts);
    }
};

struct Row {
    double scale, end;  // scale factor of the motion; end of the history [s]
    State start;
};

struct Settings {
    double gravity, tolerance;
    std::int64_t most_events;
};

struct Result {
    double peak_rotation = 0.0, peak_time = 0.0, peak_velocity = 0.0, overturning_time = kNan, first_uplift = kNan, sliding_distance = 0.0,
           residual_displacement = 0.0, friction_usage = 0.0, end_time = 0.0;
    std::int64_t outcome = kFailed, status = kInvalid, side = 0, impacts = 0, uplifts = 0, still_rocking = 0, replaced = 0, shocks = 0, steps = 0;
};

class Run {
  public:
    Run(const Base& base, const Motion& motion, const Law& law, const Row& row, const Settings& set)
        : b_(base), m_(motion), law_(law), row_(row), set_(set), s_(row.start) {}

    Result run() {
        s_ = cleaned(b_, s_, 1e-13 * largest_speed(b_, s_));  // removes the rounding errors of the sine in the input
        bool falls = false;
        for (int foot : {kLeft, kRight}) falls |= (s_.touching & foot) && away(b_, s_, foot) < 0.0;
        if (falls) strike(kFlight);
        else change();
        note_peak(s_.rotation, 0.0);
        while (!done_ && !over()) step();
        return results();
    }

  private:
    static constexpr int kOrder = kMost;

    double now() const { return shaking() ? (stretch_ + tau_) * m_.step : time_; }
    bool shaking() const { return stretch_ < m_.count; }

    bool over() const {
        if (now() < row_.end * kWhole) return false;
        const int side = s_.rotation > 0.0 ? kRight : kLeft;
        return !(std::fabs(s_.rotation) > b_.alpha[side]) || (now() - row_.end) * b_.pace > kPatience;
    }

    // Ground motion of the next time interval; the polynomial is shifted to the remaining part of the segment.
    Ground ground(double unit) const {
        Ground g;
        g.unit = unit, g.lift[0] = set_.gravity, g.small = 0.1 * set_.tolerance;
        if (!shaking()) return g;
        g.terms = m_.terms;
        const double *push = m_.push + stretch_ * m_.terms, *lift = m_.lift ? m_.lift + stretch_ * m_.terms : nullptr;
        for (int k = 0; k < m_.terms; ++k) {
            g.push[k] = row_.scale * push[k];
            if (lift) g.lift[k] = row_.scale * lift[k] + (k ? 0.0 : set_.gravity);
        }
        const double width = unit / m_.step;
        if (tau_ == 0.0 && width == 1.0) return g;
        for (double* c : {g.push, g.lift}) {
            for (int k = 0; k + 1 < m_.terms; ++k)
                for (int j = m_.terms - 2; j >= k; --j) c[j] += tau_ * c[j + 1];  // Eq. 51
            double power = 1.0;
            for (int k = 1; k < m_.terms; ++k) c[k] *= power *= width;
        }
        return g;
    }

    void step() {
        if (s_.rotation == 0.0 && mode_ == kRest && rest()) return;
        ++r_.steps;
        double left = shaking() ? (1.0 - tau_) * m_.step : kLongest / b_.pace;
        if (now() < row_.end && row_.end - now() < left * kWhole) left = row_.end - now();
        const double most = kLongest / std::max(b_.pace, std::fabs(s_.spin));
        double unit = left;
        if (mode_.feet != kBoth && unit > most) unit = most;
        Ground g;
        for (int halving = 0;; ++halving) {
            g = ground(unit);
            series_of(b_, s_, mode_, g, law_.friction, kOrder, c_);
            if (c_.converged && std::isfinite(c_.rotation[c_.n - 1])) break;
            if (halving == 60 || c_.stiff <= 0.0) return shocked();
            unit *= 0.5;
        }
        const double stretch = unit * b_.pace;
        if (c_.stiff <= 0.0) return change();
        End kind = End::none;
        double at = 1.0;
        if (!uneventful(mode_, c_, law_.friction)) {
            functions_of(b_, mode_, c_, law_.friction, g.weight(), f_);
            if (!consistent(f_, stretch, tolerance_)) return change();
            at = std::min(first_end(f_, stretch, tolerance_, kind), 1.0);
        }
        State reached = s_;
        evaluate(at, reached);
        keep(at, reached);
        const double from = now();
        tolerance_ = kTolerance, changed_ = 0;
        reached.touching = mode_.feet;
        s_ = kept(b_, reached, mode_.feet, mode_.slip == 0);
        r_.peak_velocity = std::max(r_.peak_velocity, std::fabs(s_.spin));
        if (shaking()) {
            const double tau = at == 1.0 && unit == (1.0 - tau_) * m_.step ? 1.0 : tau_ + at * unit / m_.step;
            if (tau > kWhole) next_stretch();
            else tau_ = tau;
        } else {
            time_ = from + at * unit;
        }
        if (kind != End::none) end(kind, at);
    }

    void next_stretch() {
        ++stretch_, tau_ = 0.0;
        if (!shaking()) time_ = m_.count * m_.step;
    }

    // State and friction usage at an instant of the step; all series are evaluated together.
    void evaluate(double at, State& s) {
        double x = 0.0, z = 0.0, turn = 0.0, u = 0.0, w = 0.0, spin = 0.0, normal = 0.0, tangential = 0.0, path = 0.0;
        for (int k = c_.n - 1; k > 0; --k) {
            x = x * at + c_.x[k], z = z * at + c_.rise[k], turn = turn * at + c_.rotation[k];
            u = u * at + k * c_.x[k], w = w * at + k * c_.rise[k], spin = spin * at + k * c_.rotation[k];
        }
        s.x = x * at + c_.x[0], s.rise = z * at + c_.rise[0], s.rotation = turn * at + c_.rotation[0];
        s.u = u / c_.unit, s.w = w / c_.unit, s.spin = spin / c_.unit;
        if (!mode_.feet) return;
        const double *first = c_.normal[mode_.feet == kBoth ? kLeft : mode_.feet], *second = c_.normal[kRight];
        const double also = mode_.feet == kBoth ? 1.0 : 0.0;
        if (also == 0.0) second = first;
        note_usage(std::fabs(c_.tangential[0]), first[0] + also * second[0]);
        for (int k = c_.n; k-- > 0;) normal = normal * at + (first[k] + also * second[k]), tangential = tangential * at + c_.tangential[k];
        note_usage(std::fabs(tangential), normal);
        if (!mode_.slip) return;
        for (int k = c_.n; k-- > 0;) path = path * at + c_.sliding[k] / (k + 1);
        r_.sliding_distance += std::fabs(c_.unit * at * path);
    }

    // Records a step: peaks, and the passage of the centre of mass over the foot.
    void keep(double at, const State& reached) {
        const int n = c_.n;
        const double start = now();
        seen_ |= 1 << (!mode_.feet ? 4 : mode_.feet == kBoth ? (mode_.slip ? 1 : 0) : (mode_.slip ? 3 : 2));
        last_ = mode_;
        if (mode_.feet != kBoth) {
            if (s_.spin * reached.spin < 0.0) {
                double d[kTerms], found[kTerms + 1];
                for (int k = 1; k < n; ++k) d[k - 1] = k * c_.rotation[k];
                const int count = zeros(d, n - 1, found);
                for (int i = 0; i < count; ++i)
                    if (found[i] > 0.0 && found[i] <= at + 1e-9) note_peak(value(c_.rotation, n, std::min(found[i], at)), start + found[i] * c_.unit);
            }
            note_peak(reached.rotation, start + at * c_.unit);
            watch_top(start, at, reached.rotation);
        } else {
            passed_ = kNan;
        }
    }

    void note_usage(double tangential, double normal) {
        if (tangential > r_.friction_usage * law_.friction * normal && normal > kLight * set_.gravity)
            r_.friction_usage = std::max(r_.friction_usage, law_.friction > 0.0 ? tangential / normal / law_.friction : 1.0);  // Eq. 78
    }

    void note_peak(double rotation, double time) {
        if (std::fabs(rotation) > std::fabs(r_.peak_rotation)) r_.peak_rotation = rotation, r_.peak_time = time;
    }

    void watch_top(double start, double at, double reached) {
        const double side = reached > 0.0 ? 1.0 : -1.0, alpha = b_.alpha[reached > 0.0 ? kRight : kLeft];
        if (alpha - side * reached >= 0.0) {
            passed_ = kNan;
            return;
        }
        double gap[kTerms];
        for (int k = 0; k < c_.n; ++k) gap[k] = -side * c_.rotation[k];
        gap[0] += alpha;
        if (!(gap[0] > 0.0) && !std::isnan(passed_)) return;
        double fall = 0.0;
        if (gap[0] > 0.0 && (fall = first_fall(gap, c_.n)) > 1.0) fall = 0.0;
        passed_ = start + fall * c_.unit;
    }

    void end(End kind, double at) {
        if (++events_ >= set_.most_events) stop(kTooManyEvents);
        if (kind == End::lying) {
            lies_ = true;
            return stop(kGood);
        }
        if (kind == End::landing) return land(at);
        if (kind == End::sticking) s_ = kept(b_, s_, mode_.feet, true);
        change();
    }

    void land(double at) {
        const State before = s_;
        if (mode_.feet) {
            s_.rotation = s_.rise = 0.0;
            s_ = kept(b_, s_, mode_.feet, mode_.slip == 0);
            s_.touching = kBoth;
        } else {
            int feet = 0;
            for (int foot : {kLeft, kRight})
                if (value(c_.gap[foot], c_.n, at) <= kClosed * b_.size) feet |= foot;
            s_.touching = feet;
            if (feet == kBoth) s_.rotation = s_.rise = 0.0;
            else s_.rise = arm(b_, b_.lever[feet], before.rotation).rise;
        }
        strike(mode_);
    }

    void strike(Mode mode) {
        Struck struck;
        const Impact impact(b_, s_, law_);
        bool resolved = false, stands_in = false;
        if (mode.feet == kLeft || mode.feet == kRight) {
            const int foot = kBoth - mode.feet;
            if (!std::isnan(law_.imposed[foot])) resolved = impact.imposed(foot, law_.imposed[foot], struck);
        }
        if (!resolved) {
            double bounce[3] = {};
            for (int foot : {kLeft, kRight})
                if (s_.touching & foot) bounce[foot] = law_.bounce * -away(b_, s_, foot) > b_.slow ? law_.bounce : 0.0;
            resolved = impact.resolve(bounce, struck, stands_in);
        }
        if (!resolved) return stop(kNoForce);
        ++r_.impacts, r_.replaced += stands_in;
        after(struck);
    }

    void after(const Struck& struck) {
        const double rounding = 1e-13 * largest_speed(b_, s_);
        s_ = calmed(cleaned(b_, struck.state, rounding));
        r_.peak_velocity = std::max(r_.peak_velocity, std::fabs(s_.spin));
        change();
    }

    // A body with small velocities after an impact comes to rest, if the forces allow rest.
    State calmed(const State& after) const {
        if (after.touching != kBoth || !(std::max(std::fabs(after.w), std::fabs(after.spin) * b_.size) <= b_.slow)) return after;
        State calm = kept(b_, after, kBoth, false);
        if (std::fabs(calm.u) <= b_.slow * 1e-3) calm.u = 0.0;
        Mode mode;
        double tolerance;
        return choose(b_, calm, ground(1.0 / b_.pace), law_.friction, mode, tolerance) && mode.feet == kBoth ? calm : after;
    }

    // No contact force of a rigid body exists: apply the impulse of a shock, or end the history.
    void shocked() {
        if (++events_ >= set_.most_events) stop(kTooManyEvents);
        if (done_) return;
        if (!finite()) return stop(kNotFinite);
        Struck struck;
        if (++changed_ > 40 || !Impact(b_, s_, law_).shock(struck)) return stop(kNoForce);
        ++r_.impacts, ++r_.shocks;
        after(struck);
    }

    bool finite() const {
        return std::isfinite(s_.x) && std::isfinite(s_.rise) && std::isfinite(s_.rotation) && std::isfinite(s_.u) && std::isfinite(s_.w) && std::isfinite(s_.spin);
    }

    void change() {
        if (done_) return;
        ++changed_;
        Mode next;
        double tolerance;
        if (!choose(b_, s_, ground(1.0 / b_.pace), law_.friction, next, tolerance)) return shocked();
        if (changed_ > 40) return stop(kStuck);
        if (changed_ > 3) {
            double more = kTolerance;
            for (int k = 0; k < std::min(changed_ - 3, 5); ++k) more *= 10.0;
            tolerance = std::max(tolerance, more);
        }
        tolerance_ = tolerance;
        if (mode_.feet == kBoth && next.feet != kBoth) {
            if (std::isnan(r_.first_uplift)) r_.first_uplift = now();
            ++r_.uplifts;
        }
        mode_ = next;
        if ((mode_.feet == kLeft || mode_.feet == kRight) && s_.rotation != 0.0) s_ = kept(b_, s_, mode_.feet, mode_.slip == 0);
    }

    void stop(Status status) {
        if (done_ && r_.status != kGood) return;
        done_ = true, r_.status = status;
    }

    // True if a force or a moment could become zero under accelerations within these ranges.
    bool excited(Range push, Range lift) const {
        double low = row_.scale * push.low, high = row_.scale * push.high;
        if (low > high) std::swap(low, high);
        double down = row_.scale * lift.low, up = row_.scale * lift.high;
        const double min_weight = set_.gravity + std::min(down, up);
        const double right = b_.lever[kRight], left = -b_.lever[kLeft], h = b_.height, mu = law_.friction;
        if (!(min_weight > 0.0)) return true;
        return !(min_weight * right + low * h > 0.0 && min_weight * left - high * h > 0.0 && mu * min_weight - high > 0.0 && mu * min_weight + low > 0.0);  // Eq. 69
    }

    // Skips segments that cannot move the body; true if segments were skipped.
    bool rest() {
        const std::int64_t from = stretch_;
        const std::int64_t last = std::min<std::int64_t>(m_.count, static_cast<std::int64_t>(row_.end / m_.step + 1e-9));
        const int t = m_.terms;
        while (stretch_ < last) {
            const std::int64_t block = stretch_ / kBlock;
            const Range still{0.0, 0.0}, push = m_.pushes[block], lift = m_.lift ? m_.lifts[block] : still;
            if (stretch_ % kBlock == 0 && stretch_ + kBlock <= last && !excited(push, lift)) {
                const double most = std::fabs(row_.scale) * std::max(push.high, -push.low);
                const double min_weight = set_.gravity + std::min(row_.scale * lift.low, row_.scale * lift.high);
                if (most <= r_.friction_usage * law_.friction * min_weight) {
                    stretch_ += kBlock, tau_ = 0.0;
                    continue;
                }
            }
            const double* a = m_.push + stretch_ * t;
            const double* z = m_.lift ? m_.lift + stretch_ * t : nullptr;
            if (excited(Motion::range_of(a, t), z ? Motion::range_of(z, t) : still)) break;
            double first = a[0], up = z ? z[0] : 0.0;
            if (tau_ > 0.0) first = value(a, t, tau_), up = z ? value(z, t, tau_) : 0.0;
            note_usage(std::fabs(row_.scale * first), set_.gravity + row_.scale * up);
            note_usage(std::fabs(row_.scale * value(a, t, 1.0)), set_.gravity + (z ? row_.scale * value(z, t, 1.0) : 0.0));
            ++stretch_, tau_ = 0.0;
        }
        const bool moved = stretch_ > from;
        if (moved && !shaking()) time_ = m_.count * m_.step;
        if (!shaking() && now() < row_.end) {
            time_ = row_.end;
            seen_ |= 1, last_ = kRest, passed_ = kNan;
            return true;
        }
        if (moved) seen_ |= 1, last_ = kRest, passed_ = kNan, changed_ = 0, tolerance_ = kTolerance;
        return moved;
    }

    Result results() {
        if (!done_) r_.status = finite() ? kGood : kNotFinite;
        r_.end_time = now();
        const bool good = r_.status == kGood;
        r_.outcome = !good ? kFailed : lies_ ? kOverturned : seen_ & 16 ? kFlew : seen_ & 12 ? (seen_ & 10 ? kRockedAndSlid : kRocked) : seen_ & 2 ? kSlid : kNoUplift;
        r_.overturning_time = lies_ && good ? passed_ : kNan;
        r_.side = lies_ && good ? (r_.peak_rotation > 0.0 ? 1 : -1) : 0;
        r_.still_rocking = good && !lies_ && last_.feet != kBoth;
        r_.residual_displacement = s_.x;
        return r_;
    }

    const Base& b_;
    const Motion& m_;
    const Law& law_;
    const Row& row_;
    const Settings& set_;
    State s_;
    Mode mode_ = kRest, last_ = kRest;
    std::int64_t stretch_ = 0, events_ = 0;
    double tau_ = 0.0, time_ = 0.0, tolerance_ = kTolerance, passed_ = kNan;
    int changed_ = 0, seen_ = 0;
    bool done_ = false, lies_ = false;
    Series c_;
    Functions f_;
    Result r_;
};

}  // namespace rocking::contact
