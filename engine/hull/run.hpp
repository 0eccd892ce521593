// One history: steps, events located to rounding, changes of contact, impacts, rest.
#pragma once
#include <array>

#include "candidates.hpp"
#include "flow.hpp"
#include "law.hpp"

namespace rocking::hull {

// gaps / size: below kClosed vertices land together, below kGrazed a vertex lands
constexpr double kClosed = 1e-11, kGrazed = 1e-14, kForce = 1e-11;
// speeds / sqrt(g size): end of sliding, possible sticking, constant direction of sliding
constexpr double kSlip = 5e-6, kSlides = 1e-4, kStrikes = 5e-10;
constexpr std::array<double, 4> kLadder{1e-11, 1e-9, 1e-7, 1e-5};
constexpr double kFlatWithin = 1e-6;  // gap / size below which all corners of a facet land together
constexpr double kAhead = 1e-6, kCrowded = 1e-2, kGathered = 1e-7, kGathering = 1e-4, kPatience = 100.0, kMargin = 0.1, kAfter = 0.1, kDrift = 1e-2, kNudge = 0.1;
constexpr int kPiled = 30, kMany = 200, kCrowd = 12, kHalvings = 80;

// Codes of `rocking.outcome`.
enum Outcome : int { kNoUplift = 0, kRocked = 1, kOverturned = 2, kFailed = 3, kSlid = 4, kRockedAndSlid = 5, kFlew = 6 };
enum Status : int { kGood = 0, kInvalid = 1, kNotFinite = 2, kTooManyEvents = 3, kStuck = 6, kNoContactForce = 7 };
enum Kind : int { kNone, kGap, kNormal, kShelf, kSlipping, kSticking };

struct Settings {
    double tolerance, rest_speed;
    std::int64_t most_events;
};

// States of a history at the ends of its steps, and its impacts.
struct Trace {
    // nodes: time, attitude, position, velocity, spin; impacts: time, kinetic energy before and after
    std::vector<double> nodes, impacts;
    // contacts at every node and after every impact: number of vertices, and their indices
    std::vector<std::int64_t> members, stuck, struck;
    double least_cosine = 1.0;
    bool fell = false;
};
constexpr int kNode = 14, kImpact = 3;

struct Result {
    int outcome = kFailed, status = kInvalid, pose = -1;
    std::int64_t impacts = 0, uplifts = 0, events = 0, steps = 0, held = 0, replaced = 0;
    bool still_rocking = false;
    double peak_tilt = 0.0, peak_time = 0.0, peak_spin = 0.0, overturning_time = kNan, direction = kNan, first_uplift = kNan, sliding = 0.0,
           residual = 0.0, end = 0.0, lost = 0.0;
};

class Run {
  public:
    Run(const Body& body, const Ground& ground, const Law& law, double friction, const Settings& set, Trace* trace = nullptr)
        : b_(body), g_(ground), law_(law), mu_(friction), set_(set), flow_(body, friction), trace_(trace) {
        pace_ = std::sqrt(g_.gravity / b_.size), speed_ = g_.gravity / pace_;
        slow_ = set_.rest_speed * speed_, slack_ = kForce * g_.gravity;
        // smaller gaps count as zero, and so do the energies of smaller rises
        rest_ = greater(set_.rest_speed * set_.rest_speed, kClosed);
        weak_ = rest_ * b_.mass * g_.gravity * b_.size;
        stop_ = greater(kSlip, std::sqrt(set_.tolerance)) * speed_, slides_at_ = greater(kSlides, 2.0 * std::sqrt(set_.tolerance)) * speed_;
        length_ = span_ = 0.1 / pace_;
    }

    // stood: facet below the body before the initial tilt.
    Result run(const State& start, double horizon, int stood) {
        s_ = start;
        until_ = greater(horizon, g_.end());
        first_ = start.place;
        const Mat axes = frame(s_.q);
        law_.base = stood_ = under_ = stood;
        upright_ = -1.0 * unit(b_.facets[stood_]);
        tilt_ = dot(upright_, axes.c), tilting_ = 0.0, kept_ = 0.0, up_ = axes.c;
        flow_.start(mode_);
        touch(touching_);
        bool strikes = false;
        for (int i : touching_) strikes |= velocity(i).z < -kStrikes * speed_;
        if (strikes) impact();
        else choose(touching_);
        keep();
        while (ended_ == kGood && !over()) {
            if (mode_.resting()) rest();
            else step();
        }
        return judged();
    }

  private:
    // ---- the course of a history ----

    bool over() {
        if (s_.place.z < -2.0 * b_.size) return fell_ = true;
        if (time_ < until_) return false;
        if (mode_.resting()) return true;
        return r_.still_rocking = time_ > until_ + kPatience / pace_;
    }

    Result judged() {
        r_.status = ended_, r_.pose = b_.poses[under_], r_.end = time_;
        if (ended_ != kGood) r_.outcome = kFailed;
        else if (fell_ || r_.pose != b_.poses[stood_]) r_.outcome = kOverturned;
        else if (flew_) r_.outcome = kFlew;
        else if (rocked_) r_.outcome = slid_ ? kRockedAndSlid : kRocked;
        else r_.outcome = slid_ ? kSlid : kNoUplift;
        if (r_.outcome != kOverturned) r_.overturning_time = r_.direction = kNan;
        r_.still_rocking &= r_.outcome != kOverturned;
        r_.peak_tilt = peak_ < 1.0 ? std::atan2(std::sqrt((1.0 - peak_) * (1.0 + peak_)), peak_) : 0.0;
        if (trace_) trace_->least_cosine = peak_, trace_->fell = fell_;
        r_.residual = std::sqrt((s_.place.x - first_.x) * (s_.place.x - first_.x) + (s_.place.y - first_.y) * (s_.place.y - first_.y));
        return r_;
    }

    // Records a state: peaks, and the deviation of the centre of mass from the initial pose.
    void keep() {
        const Mat axes = frame(s_.q);
        const double tilt = dot(upright_, axes.c), tilting = -dot(upright_, cross(s_.spin, axes.c)), span = time_ - kept_;
        note(tilt, time_);
        if (span > 0.0 && tilting_ < 0.0 && tilting > 0.0) {  // smallest cosine of the Hermite cubic
            const double d0 = tilting_ * span, d1 = tilting * span, rise = tilt - tilt_;
            const double c3 = d0 + d1 - 2.0 * rise, c2 = 3.0 * rise - 2.0 * d0 - d1;
            const double root = std::sqrt(greater(c2 * c2 - 3.0 * c3 * d0, 0.0)), at = -d0 / (c2 + root);
            if (at > 0.0 && at < 1.0) note(tilt_ + at * (d0 + at * (c2 + at * c3)), kept_ + at * span);
        }
        r_.peak_spin = greater(r_.peak_spin, norm(s_.spin));
        const int under = b_.under(axes.c, under_);
        if (under != under_) {
            const List& poses = b_.poses;
            if (poses[under] != poses[under_] && poses[under_] == poses[stood_]) {
                const Vec apart = b_.facets[under_] - b_.facets[under];
                const double before = dot(apart, up_), after = dot(apart, axes.c);
                r_.overturning_time = kept_ + (after > before ? -before / (after - before) : 1.0) * span;
                const Vec leans = axes * upright_;
                r_.direction = std::atan2(leans.y, leans.x);
            }
            under_ = under;
        }
        tilt_ = tilt, tilting_ = tilting, kept_ = time_, up_ = axes.c;
        if (!trace_) return;
        const double *q = s_.q, node[kNode] = {time_, q[0], q[1], q[2], q[3], s_.place.x, s_.place.y, s_.place.z, s_.velocity.x, s_.velocity.y, s_.velocity.z, s_.spin.x, s_.spin.y, s_.spin.z};
        trace_->nodes.insert(trace_->nodes.end(), node, node + kNode);
        list(mode_.contact.members, trace_->members), list(mode_.contact.stuck, trace_->stuck);
    }

    static void list(const Points& points, std::vector<std::int64_t>& all) {
        all.push_back(static_cast<std::int64_t>(points.size())), all.insert(all.end(), points.begin(), points.end());
    }

    void note(double cosine, double time) {
        if (cosine < peak_) peak_ = cosine, r_.peak_time = time;
    }

    // ---- rest ----

    void rest() {
        if (g_.motion->count <= stretch_) return hold(until_);
        const double end = g_.time(stretch_ + 1), span = end - time_;
        if (mode_.pulled) {
            const double pause = lesser(1e-3 / pace_, span);
            stretch_ += pause == span;
            hold(pause == span ? end : time_ + pause);
            touch(touching_);
            return choose(touching_);
        }
        g_.field(stretch_, time_, span, field_);
        border();
        const int marks = field_.degree < 2 ? 1 : 8;
        double before = 0.0;
        for (int k = 1; k <= marks; ++k) {
            const double mark = k / static_cast<double>(marks);
            if (stands(field_.at(mark)) < 0.0) {
                double low = before, high = mark;
                for (int j = 0; j < kHalvings; ++j) {
                    const double middle = 0.5 * (low + high);
                    (stands(field_.at(middle)) < 0.0 ? high : low) = middle;
                }
                hold(time_ + high * span);
                ++r_.events;
                const bool slides = slips(field_.at(high)) < 0.0;
                touch(touching_);
                const Contact left = mode_.contact;
                return choose(touching_, &left, nullptr, !slides);
            }
            before = mark;
        }
        hold(end);
        ++stretch_;
    }

    void hold(double until) {
        time_ = until;
        keep();
    }

    struct Side {
        double inside, height;
        Vec inward;
    };

    void border() {
        if (bordered_) return;
        bordered_ = true;
        sides_.clear();
        const Mat axes = frame(s_.q);
        const Points& members = mode_.contact.members;
        for (std::size_t k = 0; k < members.size(); ++k) {
            const Vec a = axes * b_.points[members[k]], b = axes * b_.points[members[(k + 1) % members.size()]];
            const double x = b.x - a.x, y = b.y - a.y, size = std::sqrt(x * x + y * y);
            const Vec inward{-y / size, x / size, 0.0};
            sides_.push_back({-(a.x * inward.x + a.y * inward.y), a.z, inward});
        }
    }

    // Smallest margin of rest: moment of the pressure about the border, or friction margin.
    double stands(Vec pull) const {
        double margin = lesser(-pull.z, slips(pull));
        for (const Side& s : sides_)
            margin = lesser(margin, (-s.inside * pull.z - s.height * (pull.x * s.inward.x + pull.y * s.inward.y)) / b_.size);  // Eq. 94
        return margin;
    }

    double slips(Vec pull) const { return mu_ == kInfinite ? kInfinite : -mu_ * pull.z - std::sqrt(pull.x * pull.x + pull.y * pull.y); }

    // ---- a step ----

    const State& to(double fraction) {
        if (fraction != part_) {
            // interpolation needs the complete step, which later steps overwrite
            if (fraction != 1.0) flow_.interpolate();
            if (across_) {
                Field sooner;
                g_.across(stretch_, time_, fraction * span_, sooner);
                flow_.step(start_, sooner, fraction * span_, 1.0, pace_);
            } else {
                flow_.step(start_, field_, span_, fraction, pace_);
            }
            part_ = fraction;
        }
        return flow_.samples[3];
    }

    // Largest slip speed / limit of the vertices that start to slide, at the end of the step.
    double fastest_start() const {
        double most = 0.0;
        for (std::size_t k = 0; k < mode_.starting.size(); ++k)
            if (mode_.starting[k]) {
                const Vec v = point_velocity(b_, flow_.samples[3], flow_.axes[3], mode_.contact.members[k]);
                most = greater(most, std::sqrt(v.x * v.x + v.y * v.y));
            }
        return most / slides_at_;
    }

    void step() {
        ++r_.steps;
        const bool moving = stretch_ < g_.motion->count;
        const double left = (moving ? g_.time(stretch_ + 1) : kInfinite) - time_;
        double span = lesser(length_, left);
        if (span < left && left < 2.0 * span) span = 0.5 * left;
        across_ = moving && crosses(span);
        if (!across_) g_.field(stretch_, time_, span, field_);
        start_ = s_, span_ = span;
        flow_.step(start_, field_, span_, part_ = 1.0, pace_);
        const double error = flow_.error;
        if (!std::isfinite(error)) {  // forces are so large that the first stage is not finite; a shorter step is used
            if (!(span * pace_ > 1e-10)) return end_with(kNotFinite);
            length_ = 0.1 * span;
            return;
        }
        for (const Forces& f : flow_.forces)
            if (!f.found) {
                if (span * pace_ > 1e-9) {
                    length_ = 0.25 * span;
                } else {
                    touch(touching_);
                    shocked(touching_);
                }
                return;
            }
        const double fast = fastest_start();
        if (fast > 2.0 && span * pace_ > 2e-3) {
            length_ = span * greater(1.5 / fast, 0.1);
            return;
        }
        // larger growth factors have no effect
        const double growth = error < 5e-4 * set_.tolerance ? 4.0 : 0.9 * std::pow(set_.tolerance / error, 0.2);
        if (error > set_.tolerance && span * pace_ > 1e-10) {
            length_ = span * greater(0.1, growth);
            return;
        }
        const double base = growth > 1.0 && (span == left || across_) ? greater(span, length_) : span;
        length_ = lesser(base * lesser(greater(growth, 0.3), 4.0), 0.2 / pace_);
        double fraction = 1.0;
        const Kind kind = first_event(fraction);
        to(fraction);
        slide(fraction * span);
        time_ += fraction * span;
        if (kind == kNone && span == left) ++stretch_, time_ = g_.time(stretch_);
        if (across_)
            while (stretch_ < g_.motion->count && g_.time(stretch_ + 1) <= time_) ++stretch_;
        s_ = flow_.samples[3];
        if (kind != kNone || mode_.pulled || drifted()) settle_on(mode_.contact, {});
        keep();
        finish(kind);
    }

    // True if the step may continue to a later sample; sets the length.
    bool crosses(double& length) {
        std::int64_t last = stretch_ + 1;
        if (g_.motion->degree != 1 || last < smooth_ || trace_) return false;
        while (last - stretch_ < kAcross && last < g_.motion->count && g_.time(last + 1) - time_ <= length_) ++last;
        if (last == stretch_ + 1) return false;
        const double span = g_.time(last) - time_;
        if (!(g_.across(stretch_, time_, span, field_) <= std::sqrt(set_.tolerance) * g_.gravity)) return smooth_ = last + kAcross, false;
        length = span;
        return true;
    }

    // True if the step violates the contact by more than a small fraction of the step error.
    bool drifted() const {
        const double most = kDrift * set_.tolerance;
        for (int i : mode_.contact.members) {
            const Vec v = point_velocity(b_, s_, flow_.axes[3], i);
            if (std::fabs(s_.place.z + dot(flow_.axes[3].c, b_.points[i])) > most * b_.size || std::fabs(v.z) > most * speed_) return true;
            if (has(mode_.contact.stuck, i) && largest(v) > most * speed_) return true;
        }
        return false;
    }

    // Path length of the vertex that slides most; exact for cubics at the four stages.
    void slide(double span) {
        static constexpr double weight[4] = {1.0 / 12.0, 10.0 / 21.0, 5.0 / 12.0, 1.0 / 42.0};
        double most = 0.0;
        const Points& members = mode_.contact.members;
        if (mode_.contact.stuck.size() == members.size()) return;
        for (std::size_t k = 0; k < members.size(); ++k) {
            if (mode_.stuck(k)) continue;
            double path = 0.0;
            for (int j = 0; j < 4; ++j) {
                const Vec v = point_velocity(b_, flow_.samples[j], flow_.axes[j], members[k]);
                path += weight[j] * std::sqrt(v.x * v.x + v.y * v.y);
            }
            most = greater(most, path);
        }
        r_.sliding += span * most;
    }

    void finish(Kind kind) {
        for (std::size_t k = 0; k < mode_.starting.size(); ++k)
            if (mode_.starting[k] && slip(mode_.contact.members[k]) > slides_at_) mode_.starting[k] = 0;
        if (kind == kGap) return impact();
        if (kind == kNone && !mode_.pulled) return;
        touch(touching_);
        if (kind == kNone) return choose(touching_);
        ++r_.events;
        const Contact left = mode_.contact;
        choose(touching_, kind == kSlipping ? nullptr : &left, nullptr, kind == kNormal || kind == kShelf);
        keep();
    }

    struct Watch {
        Kind kind;
        int i, slot;     // vertex, and its index among the members
    };
    struct Fall {
        double about, low, high;
        Watch what;
        double values[4];  // values of the margin at the stages
        bool operator<(const Fall& o) const {
            if (about != o.about) return about < o.about;
            if (low != o.low) return low < o.low;
            if (high != o.high) return high < o.high;
            return what.kind != o.what.kind ? what.kind < o.what.kind : what.i < o.what.i;
        }
    };

    // Time at which the first margin falls below zero, and the kind of the margin.
    Kind first_event(double& fraction) {
        Kind first = kNone;
        fallen();
        std::sort(falls_.begin(), falls_.end());
        for (const Fall& f : falls_)
            for (const double end : {lesser(f.high, fraction), fraction})  // values at the stages are approximate
                if ((end == fraction ? at(f.what, end) : near(f.what, end)) < 0.0) {
                    fraction = located(f, lesser(f.low, end), end), first = f.what.kind;
                    break;
                }
        return first;
    }

    void fallen() {
        falls_.clear();
        flow_.keep(span_);
        watch();
        dips_.clear();
        for (const Watch& w : watched_) {
            double v[4];
            for (int k = 0; k < 4; ++k) v[k] = margin(w, flow_.samples[k], flow_.axes[k], flow_.forces[k]);
            if (v[0] < 0.0) {
                // a vertex that has just left is on the ground, except for rounding
                if (w.kind != kGap || !(velocity(w.i).z >= -1e-12 * speed_)) {
                    falls_.push_back({0.0, 0.0, 0.0, w, {v[0], v[1], v[2], v[3]}});
                    continue;
                }
                v[0] = 0.0;
            }
            int below = 0;
            for (int k = 1; k < 4 && !below; ++k) below = v[k] < 0.0 ? k : 0;
            if (below) {
                const double a = v[below - 1], b = v[below], low = Flow::nodes[below - 1], high = Flow::nodes[below];
                falls_.push_back({low + (high - low) * a / (a - b), low, high, w, {v[0], v[1], v[2], v[3]}});
            } else if (w.kind == kGap) {
                const double a = velocity(w.i).z, b = point_velocity(b_, flow_.samples[3], flow_.axes[3], w.i).z;
                const double lowest = lesser(lesser(v[0], v[1]), lesser(v[2], v[3]));
                if (a < 0.0 && b > 0.0 && lowest < b_.size * 1e-3) dips_.push_back({0.9 * a / (a - b), 0.0, a / (a - b), w, {v[0], v[1], v[2], v[3]}});
            }
        }
        for (const Fall& d : dips_)
            if (near(d.what, d.high) < 0.0) falls_.push_back(d);
    }

    // The zero of a margin that is negative at the end of a bracket. The target is slightly below zero. The first
    // estimate is from the interpolated motion. Then each secant iteration integrates the motion to its estimate.
    double located(const Fall& f, double low, double high) {
        const Watch& w = f.what;
        const double close = w.kind == kGap ? 0.5 * kGrazed * b_.size : w.kind == kShelf ? kClosed * b_.size : w.kind == kSlipping ? 1e-3 * stop_ : slack_;
        if (part_ == high && at(w, high) >= -close) return high;
        double slope = 0.0, from = guessed(f, low, high, 0.5 * close, slope);
        for (int k = 0; k < 5 && slope < 0.0; ++k) {
            const double value = at(w, from);
            if (value < 0.0 && value >= -close) return from;
            if ((w.kind == kGap || w.kind == kSlipping) && nudged(w, value, slope, close)) return part_;
            const double to = from - (value + 0.5 * close) / slope;
            if (!(0.0 < to && to < high)) break;
            from = to;
        }
        return searched(f, low, high, close);
    }

    // Extrapolates to the zero with the last derivative, if the zero is so near that the second-order error vanishes.
    bool nudged(const Watch& w, double value, double slope, double close) {
        const double fraction = part_;
        for (int k = 0; k < 4; ++k) {
            const double by = -(value + 0.5 * close) / slope;
            part_ += by;
            if (!(std::fabs(part_ - fraction) * span_ * pace_ < kNudge * std::sqrt(set_.tolerance))) break;
            flow_.nudge(by * span_);
            value = margin(w, flow_.samples[3], flow_.axes[3], flow_.forces[3]);
            if (value < 0.0 && value >= -close) return true;
        }
        part_ = -1.0;
        return false;
    }

    // Time at which the interpolated motion has the margin -aim, and the slope there; slope 0 if there is no such time.
    double guessed(const Fall& f, double low, double high, double aim, double& slope) {
        const Watch& w = f.what;
        if (low > 0.0 && near(w, low) < 0.0) high = low, low = 0.0;
        if (low == 0.0 && f.values[0] == 0.0)  // the vertex has just left: find a time at which it is above the ground
            for (const double resolution = 1e-6 * high; near(w, low = 0.5 * high) < 0.0;)
                if (!((high = low) > resolution)) return high;
        double a = low, b = high, at_a = near(w, a) + aim, at_b = near(w, b) + aim, x = 0.0;
        if (!(at_a >= 0.0 && at_b <= 0.0)) return high;
        for (int k = 0, side = 0; k < 40; ++k) {  // regula falsi, by the Illinois rule
            const double before = x;
            x = (a * at_b - b * at_a) / (at_b - at_a);
            const double value = near(w, x) + aim;
            if (std::fabs(value) <= 1e-3 * aim || std::fabs(x - before) < 1e-12) break;
            const int now = value < 0.0 ? -1 : 1;
            if (now < 0) b = x, at_b = value, at_a *= side == now ? 0.5 : 1.0;
            else a = x, at_a = value, at_b *= side == now ? 0.5 : 1.0;
            side = now;
        }
        const double apart = 1e-4 * high;
        slope = (near(w, x + apart) - near(w, x - apart)) / (2.0 * apart);
        return x;
    }

    // If the interpolation fails: the zero of the cubic through the four stages, in a bracket.
    double searched(const Fall& f, double low, double high, double close) {
        const Watch& w = f.what;
        double at_high = at(w, high), x = guess(f, low, high), last = high, at_last = at_high;
        bool sure = low == 0.0;  // true if the margin is above zero at the low end
        if (sure && f.values[0] == 0.0)  // the vertex has just left: find a time at which it is above the ground
            for (double up = 0.5 * high, resolution = 1e-6 * high; up > resolution; up *= 0.5) {
                const double value = at(w, up);
                if (value < 0.0) high = last = up, at_high = at_last = value;
                else {
                    low = up;
                    break;
                }
            }
        for (int k = 0; k < kHalvings && at_high < -close && high - low > 1e-15; ++k) {
            if (!(low < x && x < high)) {
                x = sure || k < 3 ? 0.5 * (low + high) : 0.0;
                if (x == 0.0) low = 0.0, x = 0.5 * high, sure = true;
            }
            const double value = at(w, x), slope = (value - at_last) / (x - last);
            if (value < 0.0) high = x, at_high = value;
            else low = x, sure = true;
            last = x, at_last = value;
            x = slope < 0.0 ? x - (value + 0.5 * close) / slope : 0.5 * (low + high);
            if (k % 8 == 7) x = 0.5 * (low + high);
        }
        return high;
    }

    // Position where the cubic through the values at the stages becomes negative.
    static double guess(const Fall& f, double low, double high) {
        const double* v = f.values;
        double c[4] = {v[0], v[1], v[2], v[3]};  // divided differences
        for (int k = 1; k < 4; ++k)
            for (int j = 3; j >= k; --j) c[j] = (c[j] - c[j - 1]) / (Flow::nodes[j] - Flow::nodes[j - k]);
        const auto value = [&](double x) { return c[0] + x * (c[1] + (x - Flow::nodes[1]) * (c[2] + (x - Flow::nodes[2]) * c[3])); };
        double a = low, b = high;
        for (int k = 0; k < 24; ++k) {
            const double middle = 0.5 * (a + b);
            (value(middle) < 0.0 ? b : a) = middle;
        }
        return 0.5 * (a + b);
    }

    void watch() {
        watched_.clear();
        const Points& members = mode_.contact.members;
        for (std::size_t k = 0; k < members.size(); ++k) {
            const int i = members[k], slot = static_cast<int>(k);
            const bool stuck = mode_.stuck(k);
            if (!mode_.pulled) watched_.push_back({kNormal, i, slot});
            if (stuck && !mode_.pulled && mu_ < kInfinite) watched_.push_back({kSticking, i, slot});
            if (stuck) continue;
            watched_.push_back({kSlipping, i, slot});
            if (g_.ends()) watched_.push_back({kShelf, i, slot});
        }
        slides_.clear();
        const Mat axes = frame(s_.q);
        for (std::size_t k = 0; k < members.size(); ++k) slides_.push_back(mode_.stuck(k) ? Vec{} : slip_direction(b_, s_, axes, mode_, k));
        const State& end = flow_.samples[3];
        const Vec up = axes.c, after = flow_.axes[3].c;
        const double fastest = greater(norm(s_.velocity) + b_.size * norm(s_.spin), norm(end.velocity) + b_.size * norm(end.spin));
        const double reach = fastest * span_, high = s_.place.z, later = end.place.z;
        // the list of near vertices remains valid until the body has moved by the margin of the list
        travelled_ += reach;
        if (!(travelled_ + 2.0 * reach <= margin_)) {
            margin_ = greater(kMargin * b_.size, 4.0 * reach), travelled_ = reach;
            near_.clear();
            for (std::size_t i = 0; i < b_.points.size(); ++i)
                if (high + dot(up, b_.points[i]) < margin_) near_.push_back(static_cast<int>(i));
        }
        for (int i : near_)
            if (lesser(high + dot(up, b_.points[i]), later + dot(after, b_.points[i])) < reach && !has(members, i)) watched_.push_back({kGap, i, -1});
    }

    // Value of an event function: a height, an acceleration or a speed.
    double margin(const Watch& w, const State& s, const Mat& axes, const Forces& f) const {
        if (w.kind == kGap || w.kind == kShelf) {
            const Vec p = b_.points[w.i];
            if (w.kind == kShelf) return g_.inside(s.place + axes * p);
            const double height = s.place.z + dot(axes.c, p) + kGrazed * b_.size;
            return !g_.ends() || height > 0.0 || g_.inside(s.place + axes * p) >= 0.0 ? height : kInfinite;
        }
        if (!f.found) return -1.0;
        if (w.kind == kNormal) return f.normals[w.slot] / b_.mass + slack_;
        if (w.kind == kSticking) return (mu_ * f.normals[w.slot] - f.pulls[w.slot]) / b_.mass + slack_ * (1.0 + mu_);
        const double speed = dot(slides_[w.slot], point_velocity(b_, s, axes, w.i));
        return speed + (mode_.starting[w.slot] ? 2.0 : -1.0) * stop_;
    }

    double at(const Watch& w, double fraction) {
        const State& s = to(fraction);
        return margin(w, s, flow_.axes[3], flow_.forces[3]);
    }

    // Value of an event function from the interpolated motion.
    double near(const Watch& w, double fraction) {
        static const Forces none;
        if (w.kind == kGap && !g_.ends()) return flow_.height(fraction, b_.points[w.i]) + kGrazed * b_.size;
        const State s = flow_.along(fraction);
        return margin(w, s, frame(s.q), w.kind == kNormal || w.kind == kSticking ? flow_.forces_at(s, field_.at(fraction)) : none);
    }

    // ---- contact ----

    Vec velocity(int i) const { return point_velocity(b_, s_, frame(s_.q), i); }
    double slip(int i) const {
        const Vec v = velocity(i);
        return std::sqrt(v.x * v.x + v.y * v.y);
    }

    void touch(Points& touching, double reach = kClosed) const {
        touching.clear();
        const Mat axes = frame(s_.q);
        for (std::size_t i = 0; i < b_.points.size(); ++i) {
            if (s_.place.z + dot(axes.c, b_.points[i]) > reach * b_.size) continue;
            if (!g_.ends() || g_.inside(s_.place + axes * b_.points[i]) >= 0.0) touching.push_back(static_cast<int>(i));
        }
    }

    // Gravity minus the ground acceleration, slightly after the present time.
    Vec pull() const {
        if (stretch_ >= g_.motion->count) return g_.weight;
        Field f;
        g_.field(stretch_, time_, kAhead / pace_, f);
        return f.at(1.0);
    }

    Problem problem_of(Vec field, double friction) const {
        Problem p;
        p.body = &b_, p.axes = frame(s_.q), p.linear = row_times(field, p.axes), p.spin = s_.spin, p.friction = friction;
        p.angular = b_.inverse * cross(b_.inertia * s_.spin, s_.spin);
        return p;
    }
    Problem velocities(double friction) const {
        Problem p;
        p.body = &b_, p.axes = frame(s_.q), p.linear = row_times(s_.velocity, p.axes), p.angular = s_.spin, p.friction = friction;
        return p;
    }

    // Replacement if no candidate satisfies all laws: no gap closes, and the tensile force is as small as possible.
    template <class Fits>
    static const Solution* least_pull(const Problem& p, Candidates& all, const Points& touching, double slack, Fits fits) {
        const Solution* best = nullptr;
        double most = -kInfinite;
        const Solution* pushed = nullptr;
        all.all();
        for (std::size_t k = 0; const Solution* c = all[k]; ++k) {
            if (!fits(*c) || c->contact.members.empty() || !clear(p, *c, touching, slack)) continue;
            const double weakest = *std::min_element(c->normals.begin(), c->normals.end());
            if (!pushed && weakest >= -slack * p.body->mass) pushed = c;
            if (weakest > most) most = weakest, best = c;
            if (pushed) break;
        }
        return pushed ? pushed : best;
    }

    static bool same(const Points& points, const Points& other) {
        if (points.size() != other.size()) return false;
        Points a = points, b = other;
        std::sort(a.begin(), a.end()), std::sort(b.begin(), b.end());
        return a == b;
    }

    struct Over {
        Contact contact;
        bool leaves;
    };

    // Uses the first candidate with forces that satisfy all laws. exclude: ended contact; closed: vertices stopped by
    // an impact; leaves: true if a vertex of the ended contact leaves. Then its vertices cannot all remain, sticking or
    // sliding.
    void choose(const Points& touching, const Contact* exclude = nullptr, const Points* closed = nullptr, bool leaves = false) {
        if (ended_ != kGood || guarded()) return;
        if (!at_once_ || closed) over_.clear();  // contacts that ended at this time are not used again
        if (exclude) over_.push_back({*exclude, leaves});
        const bool crowd = crowded();
        if (crowd && time_ > gathered_) return gather();
        Points near, still;
        const Mat axes = frame(s_.q);
        for (int i : touching) {
            const double leaves_at = point_velocity(b_, s_, axes, i).z;
            const bool held = closed && has(*closed, i);
            if (held || leaves_at <= slow_) near.push_back(i);
            if (held || leaves_at <= kStrikes * speed_) still.push_back(i);
        }
        // a slowly leaving vertex may remain together with vertices at rest, but cannot replace them
        const auto fits = [&](const Solution& s) {
            const Points& m = s.contact.members;
            return still.empty() || m.empty() || std::any_of(m.begin(), m.end(), [&](int i) { return has(still, i); });
        };
        Problem p = problem_of(pull(), mu_);
        p.forces = true;
        Moving moving;
        if (mu_ < kInfinite)
            for (int i : near)
                if (slip(i) > 3.0 * stop_) {
                    const Vec v = velocity(i);
                    moving.push_back({i, row_times(unit({v.x, v.y, 0.0}), p.axes)});
                }
        Candidates& candidates = holding_;
        candidates.begin(p, touching, near, moving, 1e-5 * g_.gravity, 2.0 * kLadder.back() * g_.gravity);
        // an ended contact may continue if there is no other contact
        for (int pass = crowd ? 3 : 0; pass < (mu_ < kInfinite ? 3 : 1); ++pass) {
            if (pass && over_.empty()) break;
            const auto fresh = [&](const Solution& s) {
                const Contact& c = s.contact;
                const auto ended = [&](const Over& o) { return pass < 2 && same(c.members, o.contact.members) && ((o.leaves && !pass) || same(c.stuck, o.contact.stuck)); };
                return fits(s) && std::none_of(over_.begin(), over_.end(), ended);
            };
            for (double slack : kLadder)
                if (const Solution* candidate = candidates.first(slack * g_.gravity, fresh)) return take(p, *candidate, moving);
        }
        if (!moving.empty() && !mode_.pulled && !crowd) return shocked(near);
        const Solution* best = crowd ? nullptr : least_pull(p, candidates, near, 1e-9 * g_.gravity, fits);
        if (!best) {
            std::size_t first = 0;
            while (candidates[first] && !fits(*candidates[first])) ++first;
            if (candidates[first] && !candidates[first]->contact.members.empty()) best = candidates[first];
        }
        if (!best && crowd) best = least_pull(p, candidates, near, 1e-9 * g_.gravity, fits);
        if (!best) return end_with(kNoContactForce);
        r_.held += !(best->contact == mode_.contact) || !mode_.pulled;
        take(p, *best, moving);
        mode_.pulled = true;
    }

    bool crowded() {
        if (time_ - since_ > kCrowded / pace_) changes_ = 0, since_ = time_;
        changes_ += !mode_.pulled;
        return changes_ > kCrowd || at_once_ > kPiled;
    }

    bool guarded() {
        at_once_ = time_ <= moment_ ? at_once_ + 1 : 0;
        moment_ = time_;
        if (at_once_ > kMany) ended_ = kStuck;
        if (r_.events > set_.most_events) ended_ = kTooManyEvents;
        return ended_ != kGood;
    }

    void end_with(Status status) { ended_ = status; }

    void take(const Problem& p, const Solution& solution, const Moving& moving) {
        const Contact& c = solution.contact;
        const std::size_t n = c.members.size();
        if (mode_.contact.members.size() > 2 && n < 3) {
            if (!r_.uplifts++) r_.first_uplift = time_;
        }
        Mode mode;
        mode.contact = c, mode.starts.assign(n, Vec{}), mode.starting.assign(n, 0);
        Points still;
        for (std::size_t k = 0; k < n; ++k) {
            const bool moves = moving_of(moving, c.members[k]);
            if (!moves) still.push_back(c.members[k]);
            if (has(c.stuck, c.members[k]) || (moves && slip(c.members[k]) > slides_at_)) continue;
            mode.starting[k] = 1, mode.starts[k] = p.axes * solution.directions[k];
        }
        mode_ = mode, bordered_ = false;
        flow_.start(mode_);
        if (!c.stuck.empty()) anchor_ = s_.place + p.axes * b_.points[c.stuck[0]];
        const double before = kinetic();
        settle_on(mode_.contact, still);
        r_.lost += before - kinetic();
        length_ = lesser(length_, kAfter / pace_);
        flew_ |= n == 0, slid_ |= c.stuck.size() < n, rocked_ |= n > 0 && n < 3;
        if (mode_.resting()) s_.velocity = s_.spin = {};
    }

    double kinetic() const { return 0.5 * (b_.mass * dot(s_.velocity, s_.velocity) + dot(s_.spin, b_.inertia * s_.spin)); }
    double energy() const { return kinetic() - b_.mass * dot(g_.weight, s_.place); }

    // Removes drift and rounding errors from attitude, position and velocities; still: vertices without slip.
    void settle_on(const Contact& c, const Points& still) {
        const Points& members = c.members;
        if (members.empty()) return;
        for (int k = 0; k < (members.size() > 1 ? 2 : 0); ++k) level(members);
        const Mat axes = frame(s_.q);
        const Vec first = axes * b_.points[c.stuck.empty() ? members[0] : c.stuck[0]];
        if (!c.stuck.empty()) s_.place.x = anchor_.x - first.x, s_.place.y = anchor_.y - first.y;
        s_.place.z = -first.z;
        if (members.size() == 1) {
            const int i = members[0];
            const Vec at = row_times(s_.velocity, axes) + cross(s_.spin, b_.points[i]);
            const bool sticks = !still.empty() || !c.stuck.empty();
            const Vec push = sticks ? -1.0 * (b_.stiff[i] * at) : -dot(axes.c, at) / dot(axes.c, b_.soft[i] * axes.c) * axes.c;
            s_.velocity = s_.velocity + 1.0 / b_.mass * (axes * push), s_.spin = s_.spin + b_.inverse * cross(b_.points[i], push);
            return;
        }
        const Points& stuck = still.empty() ? c.stuck : still;
        if (stuck.size() == members.size() && members.size() > 2) {
            s_.velocity = s_.spin = {};
        } else if (stuck.size() == members.size()) {
            Vec linear = row_times(s_.velocity, axes), angular;
            Hinge(b_, members[0], members[1]).held(b_, -1.0 * (b_.inertia * s_.spin), {}, linear, angular);
            s_.velocity = axes * linear, s_.spin = angular;
        } else {
            project(c, stuck);
        }
    }

    // Makes a contact stick, or keep its height, by an impact without bounce.
    bool project(const Contact& c, const Points& stuck) {
        if (c.members.empty()) return false;
        const Problem p = velocities(kInfinite);
        Solution s;
        s.contact = {c.members, stuck};
        s.directions.assign(c.members.size(), Vec{});
        Points all(c.members.size());
        for (std::size_t k = 0; k < all.size(); ++k) all[k] = static_cast<int>(k);
        if (!linear(p, all, s)) return false;
        s_.velocity = p.axes * s.linear, s_.spin = s.angular;
        return true;
    }

    // Rotates the body by the smallest angle that brings an edge or a facet onto the ground.
    void level(const Points& members) {
        const Mat axes = frame(s_.q);
        const std::size_t n = members.size();
        const Vec a = b_.points[members[0]], edge = axes * (b_.points[members[n < 4 ? n / 2 : n / 3]] - a);
        Vec turn;
        if (n == 2) {
            const double flat = edge.x * edge.x + edge.y * edge.y;
            turn = {-edge.z * edge.y / flat, edge.z * edge.x / flat, 0.0};
        } else {
            Vec normal = unit(cross(edge, axes * (b_.points[members[2 * n / 3]] - a)));
            if (!(normal.z > 0.0)) normal = -1.0 * normal;
            turn = {normal.y, -normal.x, 0.0};
        }
        const double x = 0.5 * turn.x, y = 0.5 * turn.y, *q = s_.q;
        double product[4] = {q[0] - x * q[1] - y * q[2], q[1] + x * q[0] + y * q[3], q[2] + y * q[0] - x * q[3], q[3] + x * q[2] - y * q[1]};  // Eq. 80
        normalise(product);
        std::copy(product, product + 4, s_.q);
    }

    // ---- impacts ----

    void impact() {
        const Points old = mode_.contact.members;
        Points touching;
        touch(touching);
        flatten(touching);
        const double before = kinetic();
        Problem p = velocities(mu_);
        const Moving none;
        const double fastest = norm(p.linear) + b_.size * norm(p.angular);
        const auto fits = [&](const Solution& s) { return 0.5 * (b_.mass * dot(s.linear, s.linear) + dot(s.angular, b_.inertia * s.angular)) <= before * (1.0 + 1e-12); };
        const Solution* chosen = nullptr;
        Problem both[2] = {p, p};
        int last = 0;
        bool piled = false;
        for (int attempt = 0; attempt < 2; ++attempt) {
            last = attempt;
            Problem& now = both[attempt];
            if (attempt == 0 && !old.empty())
                for (int i : touching) {
                    if (has(old, i)) continue;
                    const Vec at = law_.place(b_, nearest(b_, old, b_.points[i]), b_.points[i]), off = at - b_.points[i];
                    if (dot(off, off) > 0.0) now.places.push_back({i, at});
                }
            Candidates& all = landing_[attempt];
            all.begin(now, touching, touching, none, 0.0, 2.0 * kLadder.back() * fastest);
            for (int l = 0; l < 3 && !chosen; ++l) chosen = all.first(kLadder[l] * fastest, fits);
            if (at_once_ > kPiled) {
                chosen = nullptr, piled = true;
                break;
            }
            if (chosen || now.places.empty()) break;
            ++r_.replaced;
        }
        if (!chosen) {
            ++r_.held;
            if (!piled) chosen = least_pull(both[last], landing_[last], touching, 1e-9 * fastest, fits);
        }
        Points closed = touching;
        if (chosen) {
            s_.velocity = p.axes * chosen->linear, s_.spin = chosen->angular;
            closed = chosen->contact.members;
        } else {
            pile(touching);
        }
        const double after = kinetic();
        r_.lost += before - after;
        choose(touching, nullptr, &closed);
        calm();
        ++r_.events, ++r_.impacts;
        if (trace_) {
            for (double v : {time_, before, after}) trace_->impacts.push_back(v);
            list(mode_.contact.members, trace_->struck);
        }
        keep();
    }

    // Adds all corners of a facet that lands nearly flat to the touching vertices, and rotates the facet to flat. At
    // the end of such a landing the contact moves from corner to corner, at first without loss, and the order of the
    // corners depends on rounding.
    void flatten(Points& touching) {
        Points near;
        touch(near, kFlatWithin);
        if (near.size() < 3 || near.size() == touching.size()) return;
        const Mat axes = frame(s_.q);
        int flat = 0;
        double lowest = kInfinite;
        for (std::size_t k = 0; k < b_.facets.size(); ++k) {
            const double down = dot(unit(b_.facets[k]), axes.c);
            if (down < lowest) lowest = down, flat = static_cast<int>(k);
        }
        Points corners;
        for (int k = b_.first_corner[flat]; k < b_.first_corner[flat + 1]; ++k) corners.push_back(b_.corners[k]);
        const Points& carry = mode_.contact.members;
        for (int i : corners)
            if (!has(near, i) || (!has(carry, i) && velocity(i).z > 0.0)) return;  // Eq. 328
        const double before = energy() - kinetic();
        const int kept = carry.empty() ? corners[0] : carry[0];
        const Vec fixed = s_.place + axes * b_.points[kept];
        for (int k = 0; k < 2; ++k) level(corners);
        const Mat now = frame(s_.q);
        const Vec at = fixed - now * b_.points[kept];
        s_.place = {at.x, at.y, -(now * b_.points[corners[0]]).z};
        r_.lost += before - (energy() - kinetic());
        for (int i : corners)
            if (!has(touching, i)) touching.push_back(i);
        std::sort(touching.begin(), touching.end());
    }

    // Ends a sequence of changes at one time: the vertices that approach the ground are placed at rest in contact.
    void gather() {
        const double reach = time_ > gathered_ + kCrowded / pace_ ? kGathered : 10.0 * kGathered;
        gathered_ = time_, changes_ = at_once_ = 0;
        const double before = energy();
        Points near, still;
        touch(touching_, reach);
        for (int i : touching_)
            if (std::fabs(velocity(i).z) <= kGathering * speed_) near.push_back(i);
        const Points border = outline(velocities(mu_), near);
        for (int i : border)
            if (slip(i) <= slides_at_) still.push_back(i);
        settle_on({border, {}}, still);
        r_.lost += before - energy();
        choose(near, nullptr, &near);
    }

    // Makes the largest face stick by a plastic impact, even if the impulse is tensile.
    void pile(const Points& touching) {
        const Problem p = velocities(0.0);
        const auto all = faces(p, touching);
        if (!all.empty()) project({all[0], {}}, all[0]);
    }

    // Makes sliding vertices stick immediately if no contact force exists (Painleve).
    void shocked(const Points& touching) {
        const Points kept = touching;
        const double before = kinetic();
        pile(kept);
        r_.lost += before - kinetic();
        choose(kept, nullptr, &kept);
    }

    // Places a nearly resting body flat on a facet, if the body remains at rest there.
    void calm() {
        Points near;
        touch(near, 10.0 * rest_);
        if (mode_.resting() || near.size() < 3 || ended_ != kGood) return;
        const Mat now = frame(s_.q);
        // the energy needed to stop one vertex is a lower bound; gaps contribute at most 10 of the 30
        for (int i : near) {
            const Vec v = point_velocity(b_, s_, now, i);
            if (0.5 * v.z * v.z > 30.0 * weak_ * dot(now.c, b_.soft[i] * now.c)) return;
        }
        const State state = s_;
        const Vec anchor = anchor_;
        const double lost = r_.lost, before = energy();
        const Problem p = problem_of(pull(), kInfinite);
        const Points members = faces(p, near)[0];
        if (members.size() < 3) return;
        Solution held;
        held.contact = {members, members};
        held.directions.assign(members.size(), Vec{});
        if (!solve(p, held) || !(*std::min_element(held.normals.begin(), held.normals.end()) > 0.0)) return;
        const bool slides = std::any_of(near.begin(), near.end(), [&](int i) { return slip(i) > stop_; });
        for (int sticks = 1; sticks >= (slides ? 0 : 1); --sticks) {
            if (sticks) anchor_ = s_.place + p.axes * b_.points[members[0]];
            settle_on({members, sticks ? members : Points{}}, {});
            if (before - energy() <= weak_) {
                choose(near, nullptr, &near);
                r_.lost = lost + before - energy();
                return;
            }
            s_ = state, anchor_ = anchor;
        }
    }

    const Body& b_;
    const Ground& g_;
    Law law_;
    const double mu_;
    const Settings& set_;
    Flow flow_;
    double pace_, speed_, slow_, stop_, slides_at_, slack_, rest_, weak_, length_, span_, until_ = 0.0, time_ = 0.0, part_ = -1.0;
    std::int64_t stretch_ = 0, smooth_ = 0;
    State s_, start_;
    Mode mode_;
    Vec anchor_, first_, upright_, up_;
    Field field_;
    int stood_ = 0, under_ = 0, at_once_ = 0, changes_ = 0;
    double moment_ = -1.0, since_ = 0.0, gathered_ = -kInfinite, tilt_ = 1.0, tilting_ = 0.0, kept_ = 0.0, peak_ = 1.0, margin_ = -1.0, travelled_ = 0.0;
    bool across_ = false, bordered_ = false, fell_ = false, flew_ = false, slid_ = false, rocked_ = false;
    Status ended_ = kGood;
    std::vector<Over> over_;
    // candidates for forces, and for the impulses of one impact; stored to reuse their memory
    Candidates holding_, landing_[2];
    Few<Side> sides_;
    Points touching_, near_;
    Vecs slides_;
    std::vector<Watch> watched_;
    std::vector<Fall> falls_, dips_;
    Trace* const trace_;
    Result r_;
};

}  // namespace rocking::hull
