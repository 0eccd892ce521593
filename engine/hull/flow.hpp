// The motion during a contact: accelerations, and steps of fifth order by Dormand and Prince (1980). Closed forms exist
// for one vertex, a sticking edge, and up to three sliding vertices. Every other contact is a small linear system.
#pragma once
#include <cstring>

#include "trial.hpp"

namespace rocking::hull {

struct Mode {
    Contact contact;
    Vecs starts;          // by member: direction in which the member starts to slide, axes of the ground
    Few<char> starting;
    bool pulled = false;  // true if no contact set satisfies all laws; this contact is a replacement
    bool stuck(std::size_t k) const { return has(contact.stuck, contact.members[k]); }
    bool resting() const { return contact.members.size() > 2 && contact.stuck.size() == contact.members.size(); }
};

struct Rates {  // time derivatives of a state, in the order of the state
    Vec place;
    double q[4];
    Vec velocity, spin;
};
constexpr int kNumbersOfState = 13;
static_assert(sizeof(State) == kNumbersOfState * sizeof(double) && sizeof(Rates) == sizeof(State), "states are added number by number");

struct Forces {
    bool found = true;
    Numbers normals, pulls;  // by member: normal and tangential forces
};

inline Vec point_velocity(const Body& b, const State& s, const Mat& axes, int i) { return s.velocity + axes * cross(s.spin, b.points[i]); }

inline Vec slip_direction(const Body& b, const State& s, const Mat& axes, const Mode& mode, std::size_t k) {
    if (mode.starting[k]) return mode.starts[k];
    const Vec v = point_velocity(b, s, axes, mode.contact.members[k]);
    return unit({v.x, v.y, 0.0});
}

class Flow {
  public:
    Flow(const Body& body, double friction) : b_(body), mu_(friction) {}

    void start(const Mode& mode) {
        mode_ = &mode;
        const Contact& c = mode.contact;
        const std::size_t n = c.members.size(), stuck = c.stuck.size();
        kind_ = n == 0 ? kFlight : n <= 3 && !stuck ? kSliding : n == 1 ? kStuckVertex : n == 2 && stuck == 2 ? kEdge : kAny;
        if (kind_ == kEdge) hinge_ = {b_, c.members[0], c.members[1]};
        solution_.contact = c, known_ = false;
    }

    // f: optional output of the forces.
    void rates(const State& s, Vec field, Rates& r, Forces* f, Mat* kept = nullptr) {
        const Mat axes = frame(s.q);
        if (kept) *kept = axes;
        const Vec w = s.spin;
        Vec linear = row_times(field, axes), angular = b_.inverse * cross(b_.inertia * w, w);
        const bool solved = act(s, axes, linear, angular, f);
        if (f) f->found = solved;
        found_ &= solved;
        r.place = s.velocity, r.velocity = axes * linear, r.spin = angular;
        const double *q = s.q;
        r.q[0] = -0.5 * (q[1] * w.x + q[2] * w.y + q[3] * w.z);  // Eq. 22
        r.q[1] = 0.5 * (q[0] * w.x + q[2] * w.z - q[3] * w.y);
        r.q[2] = 0.5 * (q[0] * w.y + q[3] * w.x - q[1] * w.z);
        r.q[3] = 0.5 * (q[0] * w.z + q[1] * w.y - q[2] * w.x);
    }

    static constexpr int kSamples = 4;
    static constexpr double nodes[kSamples] = {0.0, 0.3, 0.8, 1.0};
    State samples[kSamples];  // states at the start, at two stages and at the end
    Forces forces[kSamples];
    Mat axes[kSamples];
    double error = 0.0;
    bool found() const { return found_; }

    // weights of the stages; the last row gives the error estimate
    static constexpr double weights[8][7] = {{},
                                             {1.0 / 5.0},
                                             {3.0 / 40.0, 9.0 / 40.0},
                                             {44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0},
                                             {19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0},
                                             {9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0},
                                             {35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0},
                                             {71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339200.0, 22.0 / 525.0, -1.0 / 40.0}};

    // Advances by a fraction of a step.
    const State& step(const State& state, const Field& field, double span, double fraction, double pace) {
        const double h = fraction * span;
        found_ = true;
        // the first stage is known from a longer step from the same state, or from the previous step
        bool first = known_ && std::memcmp(&samples[0], &state, sizeof state) == 0 && std::memcmp(&first_, &field.power[0], sizeof first_) == 0;
        if (!first && known_ && std::memcmp(&samples[3], &state, sizeof state) == 0 && largest(last_ - field.power[0]) <= 1e-13 * largest(last_)) {
            rates_[0] = rates_[6], samples[0] = state, forces[0] = forces[3], axes[0] = axes[3];
            first = forces[0].found;
        }
        known_ = true, first_ = field.power[0], last_ = field.at(fraction);
        if (!first) samples[0] = state, rates(state, first_, rates_[0], &forces[0], &axes[0]);
        rates(moved<1>(state, h), field.at(0.2 * fraction), rates_[1], nullptr);
        samples[1] = moved<2>(state, h);
        rates(samples[1], field.at(0.3 * fraction), rates_[2], &forces[1], &axes[1]);
        samples[2] = moved<3>(state, h);
        rates(samples[2], field.at(0.8 * fraction), rates_[3], &forces[2], &axes[2]);
        rates(moved<4>(state, h), field.at(8.0 / 9.0 * fraction), rates_[4], nullptr);
        rates(moved<5>(state, h), last_, rates_[5], nullptr);
        samples[3] = moved<6>(state, h);
        rates(samples[3], last_, rates_[6], &forces[3], &axes[3]);
        const State wrong = moved<7>({{}, {0.0}, {}, {}}, h);
        double turned = 0.0;
        for (double c : wrong.q) turned = greater(turned, std::fabs(c));
        error = greater(norm(wrong.place) / b_.size, 2.0 * turned);
        error = greater(error, greater(norm(wrong.velocity) / (b_.size * pace), norm(wrong.spin) / pace));
        if (!std::isfinite(norm(wrong.place) + turned + norm(wrong.velocity) + norm(wrong.spin))) error = kNan;
        normalise(samples[3].q);
        return samples[3];
    }

    // Stores the motion over the last complete step for `along`.
    void keep(double span) { whole_ = span, kept_ = false; }
    void interpolate() {
        if (kept_) return;
        kept_ = true;
        const double span = whole_;
        static constexpr double weight[7] = {-12715105075.0 / 11282082432.0, 0.0, 87487479700.0 / 32700410799.0, -10690763975.0 / 1880347072.0,
                                             701980252875.0 / 199316789632.0, -1453857185.0 / 822651844.0, 69997945.0 / 29380423.0};
        const State none{{}, {0.0}, {}, {}};
        static constexpr double unity = 1.0;
        course_[0] = samples[0];
        course_[1] = moved(none, rates_, weights[6], 6, span);
        course_[2] = added(moved(none, rates_, &unity, 1, span), -1.0, course_[1]);
        course_[3] = added(added(course_[1], -1.0, moved(none, rates_ + 6, &unity, 1, span)), -1.0, course_[2]);
        course_[4] = moved(none, rates_, weight, 7, span);
    }

    // Motion at a fraction of the last step, of fourth order (Hairer, Norsett & Wanner 1993, II.6).
    State along(double fraction) {
        interpolate();
        const double left = 1.0 - fraction;
        State result = added(course_[3], left, course_[4]);
        result = added(course_[2], fraction, result), result = added(course_[1], left, result), result = added(course_[0], fraction, result);
        normalise(result.q);
        return result;
    }

    // Height of a point at a fraction of the step.
    double height(double fraction, Vec point) {
        interpolate();
        const double left = 1.0 - fraction;
        const auto mixed = [&](const double* a, const double* b, const double* c, const double* d, const double* e) {
            return *a + fraction * (*b + left * (*c + fraction * (*d + left * *e)));
        };
        const State* c = course_;
        double q[4];
        for (int i = 0; i < 4; ++i) q[i] = mixed(c[0].q + i, c[1].q + i, c[2].q + i, c[3].q + i, c[4].q + i);
        const double size = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
        return mixed(&c[0].place.z, &c[1].place.z, &c[2].place.z, &c[3].place.z, &c[4].place.z) + dot(frame(q).c, point) / size;
    }

    // Changes the end time of the step by a small amount.
    void nudge(double time) {
        static constexpr double unity = 1.0;
        samples[3] = moved(samples[3], rates_ + 6, &unity, 1, time);
        normalise(samples[3].q), axes[3] = frame(samples[3].q);
    }

    const Forces& forces_at(const State& s, Vec field) {
        Rates none;
        rates(s, field, none, &between_);
        return between_;
    }

  private:
    static State added(const State& s, double factor, const State& o) {
        State result{s.place + factor * o.place, {}, s.velocity + factor * o.velocity, s.spin + factor * o.spin};
        for (int i = 0; i < 4; ++i) result.q[i] = s.q[i] + factor * o.q[i];
        return result;
    }

    enum Kind { kFlight, kStuckVertex, kEdge, kSliding, kAny };

    // State plus the increments of the first n stages.
    template <int n>
    State moved(const State& s, double h) const {
        double c[n], total[kNumbersOfState];
        const double *from = numbers(s), *k = numbers(rates_[0]);
        for (int j = 0; j < n; ++j) c[j] = h * weights[n][j];
        for (int i = 0; i < kNumbersOfState; ++i) {
            double sum = from[i];
            ROCKING_EACH_TERM
            for (int j = 0; j < n; ++j)
                if (weights[n][j] != 0.0) sum += c[j] * k[j * kNumbersOfState + i];
            total[i] = sum;
        }
        State moved;
        std::memcpy(&moved, total, sizeof total);
        return moved;
    }
    template <class T>
    static const double* numbers(const T& s) { return reinterpret_cast<const double*>(&s); }

    static State moved(const State& s, const Rates* k, const double* weights, int n, double h) {
        double numbers[kNumbersOfState], rate[kNumbersOfState];
        std::memcpy(numbers, &s, sizeof numbers);
        for (int j = 0; j < n; ++j) {
            const double c = h * weights[j];
            if (c == 0.0) continue;
            std::memcpy(rate, k + j, sizeof rate);
            for (int i = 0; i < kNumbersOfState; ++i) numbers[i] += c * rate[i];
        }
        State moved;
        std::memcpy(&moved, numbers, sizeof numbers);
        return moved;
    }

    void set(Forces* f, double normal, double pull) const {
        if (f) f->normals.assign(1, normal), f->pulls.assign(1, pull);
    }

    // Adds the effect of the contact to accelerations without contact; false without a solution.
    bool act(const State& s, const Mat& axes, Vec& linear, Vec& angular, Forces* f) {
        const Contact& c = mode_->contact;
        if (kind_ == kFlight) {
            if (f) f->normals.clear(), f->pulls.clear();
            return true;
        }
        if (kind_ == kEdge) return edge(s, axes, linear, angular, f), true;
        if (kind_ == kSliding) return c.members.size() == 1 ? sliding<1>(s, axes, linear, angular, f) : c.members.size() == 2 ? sliding<2>(s, axes, linear, angular, f) : sliding<3>(s, axes, linear, angular, f);
        if (kind_ == kAny) return system(s, axes, linear, angular, f);
        const int i = c.members[0];
        const Vec r = b_.points[i], up = axes.c, free = linear + cross(angular, r) + cross(s.spin, cross(s.spin, r)), force = -1.0 * (b_.stiff[i] * free);
        const double normal = dot(up, force);
        set(f, normal, norm(force - normal * up));
        linear = linear + 1.0 / b_.mass * force, angular = angular + b_.inverse * cross(r, force);
        return true;
    }

    // An edge at rest can only rotate about itself. The moments determine the force across the edge at both ends.
    void edge(const State& s, const Mat& axes, Vec& linear, Vec& angular, Forces* f) const {
        const Vec e = hinge_.along, w = s.spin;
        const Vec gyro = cross(w, b_.inertia * w), field = linear;
        hinge_.held(b_, gyro, w, linear, angular);
        if (!f) return;
        const auto [force, second] = hinge_.forces(b_, gyro, linear, angular, field);
        const Vec up = axes.c, across = unit(cross(up, e)), first = force - second;
        const double normal[2] = {dot(up, first), dot(up, second)}, side[2] = {dot(across, first), dot(across, second)}, total = dot(e, force);
        f->normals.assign(normal, normal + 2), f->pulls.assign(2, 0.0);
        if (mu_ == kInfinite) return;
        double by[2];
        share_along(normal, side, mu_, by);
        for (int k = 0; k < 2; ++k) f->pulls[k] = std::sqrt(side[k] * side[k] + by[k] * total * by[k] * total);
    }

    // Up to three vertices that all slide: solves Eq. 252 for their normal forces.
    template <int n>
    bool sliding(const State& s, const Mat& axes, Vec& linear, Vec& angular, Forces* f) const {
        const int* members = mode_->contact.members.begin();
        const Vec up = axes.c, w = s.spin;
        const double light = 1.0 / b_.mass, lifts = dot(up, linear), swing = dot(up, w), square = dot(w, w);
        Vec push[n], moment[n], lever[n];  // moments of the forces, and angular accelerations per unit normal force
        double t[n][n + 1], threshold[n];
        for (int k = 0; k < n; ++k) {
            const Vec r = b_.points[members[k]], arm = cross(r, up);
            push[k] = up - mu_ * row_times(slip_direction(b_, s, axes, *mode_, k), axes);
            moment[k] = cross(r, push[k]), lever[k] = b_.inverse * arm;
            t[k][n] = -(lifts + dot(angular, arm) + swing * dot(w, r) - square * dot(up, r));
        }
        for (int j = 0; j < n; ++j) {
            for (int k = 0; k < n; ++k) t[j][k] = light * dot(up, push[k]) + dot(lever[j], moment[k]);
            threshold[j] = kSingular * t[j][j];
        }
        double normal[n];
        if (!eliminated<n>(t, threshold, normal)) return false;
        Vec force, turn;
        for (int k = 0; k < n; ++k) force = force + normal[k] * push[k], turn = turn + normal[k] * moment[k];
        if (f) f->normals.assign(normal, normal + n), f->pulls.assign(n, 0.0);
        linear = linear + light * force, angular = angular + b_.inverse * turn;
        return true;
    }

    bool system(const State& s, const Mat& axes, Vec& linear, Vec& angular, Forces* f) {
        const std::size_t n = mode_->contact.members.size();
        problem_.body = &b_, problem_.axes = axes, problem_.linear = linear, problem_.angular = angular, problem_.spin = s.spin;
        problem_.friction = mu_, problem_.forces = true;
        solution_.directions.assign(n, Vec{});
        for (std::size_t k = 0; k < n; ++k)
            if (!mode_->stuck(k)) solution_.directions[k] = row_times(slip_direction(b_, s, axes, *mode_, k), axes);
        if (!solve(problem_, solution_)) return false;
        linear = solution_.linear, angular = solution_.angular;
        if (f) {
            f->normals = solution_.normals, f->pulls.assign(n, 0.0);
            for (std::size_t k = 0; k < n; ++k) f->pulls[k] = norm(solution_.pulls[k]);
        }
        return true;
    }

    const Body& b_;
    double mu_;
    Hinge hinge_;
    const Mode* mode_ = nullptr;
    Kind kind_ = kFlight;
    bool found_ = true, known_ = false, kept_ = false;
    double whole_ = 0.0;
    Vec first_, last_;
    Rates rates_[7];
    State course_[5];
    Forces between_;
    Problem problem_;
    Solution solution_;
};

}  // namespace rocking::hull
