// One history of a stack by time stepping (Moreau 1988, Jean 1999): impulses of a step from complementarity, positions at the ends of
// steps, velocities in their middles. The gaps at the end of a step are the exact gaps of the corners.
#pragma once
#include <limits>

#include "solver.hpp"

namespace rocking::stack {

enum Outcome : std::int64_t { kNoUplift = 0, kRocked = 1, kOverturned = 2, kFailed = 3, kSlid = 4, kRockedAndSlid = 5, kFlew = 6 };
enum Status : std::int64_t { kGood = 0, kInvalid = 1, kNotFinite = 2, kTooManyEvents = 3 };
constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kFar = 1e300;
constexpr double kOpen = 1e-5, kDisplaced = 1e-5;  // as in the response: opening [rad], displacement over the width
constexpr int kCorrections = 4;

struct Law {
    double friction, restitution, slow, width;
    double offset;  // position of the upper body from the lower body along the closed joint, at rest
};

struct Velocity {
    Vector v;
    double spin = 0.0;
};

struct Extremes {
    double opening = 0.0, slip = 0.0, normal = kFar, ratio = 0.0, slip_time = kNan, displacement = 0.0, gap = 0.0, flight_time = kNan, contact = 0.0;  // contact: end of the last step with a normal force
};

struct Settings {
    double gravity, tolerance;
    std::int64_t most_events;
};

class Run {
  public:
    std::vector<Body> bodies;  // the first is the ground
    std::vector<State> at;
    std::vector<Velocity> moves;
    std::vector<Law> laws;
    std::vector<double> mass, inertia, weight_above;
    std::vector<Extremes> extremes;
    std::vector<double> events;  // rows: time, joint, rotations, velocities before, velocities after
    std::int64_t outcome = kNoUplift, status = kGood, fallen = -1;
    double overturning_time = kNan, work = 0.0, lost = 0.0, gained = 0.0, deepest = 0.0, size = 0.0;
    Solver solver;

    explicit Run(const Settings& set) : set_(set) {}

    // After all bodies are set.
    void begin() {
        const std::size_t n = laws.size();
        joints_.assign(n, {}), corners_.resize(n), rows_.resize(n), found_.resize(n), turns_.resize(n + 1), next_.resize(n + 1), after_.resize(n + 1);
        extremes.assign(n, {}), struck_.assign(n, {}), noted_.assign(n, -kFar);
        for (std::size_t k = 0; k < n; ++k) joints_[k].friction = laws[k].friction;
        start_ = at;
    }

    double kinetic() const {
        double e = 0.0;
        for (std::size_t k = 1; k < at.size(); ++k) e += 0.5 * (mass[k] * dot(moves[k].v, moves[k].v) + inertia[k] * moves[k].spin * moves[k].spin);
        return e;
    }
    // Potential energy in the middle of the last step, above the start.
    double potential() const {
        double e = 0.0;
        for (std::size_t k = 1; k < at.size(); ++k) e += mass[k] * set_.gravity * (at[k].at.z - 0.5 * last_ * moves[k].v.z - start_[k].at.z);
        return e;
    }
    bool still() const {
        for (std::size_t k = 1; k < at.size(); ++k) {
            const double v = std::sqrt(dot(moves[k].v, moves[k].v)) + std::fabs(moves[k].spin) * size;
            if (v > 1e-9 * std::sqrt(set_.gravity * size) || std::fabs(at[k].angle - at[k - 1].angle) > 1e-7) return false;
        }
        return true;
    }

    // One step of length h from a time, under an acceleration of the ground. `kick` is the time over which forces act.
    void step(double time, double h, double kick, Vector ground) {
        const std::size_t n = laws.size();
        last_ = h, now_ = time;
        for (std::size_t k = 1; k <= n; ++k) turns_[k] = Turn(at[k].angle);
        for (std::size_t k = 0; k < n; ++k) choose(k, time);
        if (fallen >= 0) return;
        const std::vector<Velocity>& before = moves;
        free_ = before;
        for (std::size_t k = 1; k <= n; ++k) free_[k].v = free_[k].v - Vector{kick * ground.x, kick * (set_.gravity + ground.z)};
        assemble();
        guess_ = before;
        for (int turn = 0; turn < kCorrections; ++turn) {
            conditions(h, before);
            solver.solve(joints_, set_.tolerance);
            apply();
            if (depth(h) >= -1e-9 * size) break;
            guess_ = after_;
        }
        account(time, h, kick, ground, before);
        for (std::size_t k = 1; k <= n; ++k) {
            at[k].at = at[k].at + Vector{h * after_[k].v.x, h * after_[k].v.z};  // Eq. 378
            at[k].angle += h * after_[k].spin;
            if (!(std::fabs(at[k].angle) < 1e6)) status = kNotFinite;
            if (std::fabs(at[k].angle) >= kHalfPi && fallen < 0) fall(static_cast<std::int64_t>(k) - 1, time + h);
        }
        moves = after_;
    }

    void finish() {
        for (std::size_t row : pending_) write_after(row);
        pending_.clear();
        bool rocks = false, slides = false, flies = false;
        for (std::size_t k = 0; k < laws.size(); ++k) {
            extremes[k].opening = std::max(extremes[k].opening, std::fabs(at[k + 1].angle - at[k].angle));
            rocks |= extremes[k].opening > kOpen, slides |= extremes[k].slip > kDisplaced * laws[k].width;
            flies |= extremes[k].flight_time >= 0.0;
        }
        outcome = fallen >= 0 ? kOverturned : flies ? kFlew : rocks && slides ? kRockedAndSlid : rocks ? kRocked : slides ? kSlid : kNoUplift;
        if (status != kGood) outcome = kFailed;
    }

  private:
    Settings set_;
    double last_ = 0.0, now_ = 0.0;  // length and start of the step [s]
    std::vector<Joint> joints_;
    std::vector<std::array<Corner, 2>> corners_;
    std::vector<std::array<std::array<Row, 2>, 2>> rows_;  // of every corner: normal, along the face
    std::vector<std::array<Measure, 2>> found_;
    std::vector<std::array<bool, 2>> struck_;
    std::vector<Turn> turns_, next_;
    std::vector<Velocity> free_, guess_, after_;
    std::vector<State> start_;
    std::vector<std::size_t> pending_;  // events without velocities after
    std::vector<int> guide_;            // corner of the friction impulse
    std::vector<double> noted_;         // time of the last step with an impact

    void fall(std::int64_t joint, double time) { fallen = joint, overturning_time = time; }

    // The corners of a joint are the ends of the common stretch of both faces.
    void choose(std::size_t k, double time) {
        const Body &upper = bodies[k + 1], &lower = bodies[k];
        const auto on_lower = [&](double x) { return turns_[k].back(at[k + 1].at + turns_[k + 1].of({x, upper.base}) - at[k].at).x; };
        const double left = on_lower(upper.left), right = on_lower(upper.right), room = 1e-9 * laws[k].width;
        auto& c = corners_[k];
        c[0] = left >= lower.top_left - room ? Corner{true, {upper.left, upper.base}, lower.top} : Corner{false, {lower.top_left, lower.top}, upper.base};
        c[1] = right <= lower.top_right + room ? Corner{true, {upper.right, upper.base}, lower.top} : Corner{false, {lower.top_right, lower.top}, upper.base};
        if (std::min(right, lower.top_right) <= std::max(left, lower.top_left) && fallen < 0) fall(static_cast<std::int64_t>(k), time);
        for (int i = 0; i < 2; ++i) {
            found_[k][i] = measure(c[i], at[k + 1], turns_[k + 1], at[k], turns_[k]);
            rows_[k][i] = rows_of(c[i], at[k + 1], turns_[k + 1], at[k], turns_[k]);
        }
    }

    const Row& row(std::size_t k, int i) const { return i < 2 ? rows_[k][i][0] : rows_[k][guide_[k]][1]; }

    static double speed(const Row& r, const Velocity& upper, const Velocity& lower) {
        return r.x * (upper.v.x - lower.v.x) + r.z * (upper.v.z - lower.v.z) + r.upper * upper.spin - r.lower * lower.spin;
    }

    void assemble() {
        const std::size_t n = laws.size();
        guide_.resize(n);
        for (std::size_t k = 0; k < n; ++k) guide_[k] = found_[k][1].gap <= found_[k][0].gap ? 1 : 0;
        for (std::size_t k = 0; k < n; ++k) {
            const Body &upper = bodies[k + 1], &lower = bodies[k];
            for (int i = 0; i < 3; ++i) {
                const Row& a = row(k, i);
                for (int c = 0; c < 3; ++c) {
                    const Row& b = row(k, c);
                    joints_[k].own[i][c] = (a.x * b.x + a.z * b.z) * (upper.inverse_mass + lower.inverse_mass) + a.upper * b.upper * upper.inverse_inertia +
                                           a.lower * b.lower * lower.inverse_inertia;
                    if (k + 1 < n) {
                        const Row& d = row(k + 1, c);
                        joints_[k].above[i][c] = -(a.x * d.x + a.z * d.z) * upper.inverse_mass - a.upper * d.lower * upper.inverse_inertia;
                        joints_[k + 1].below[c][i] = joints_[k].above[i][c];
                    }
                }
            }
        }
    }

    State moved(std::size_t k, double h, const Velocity& v) const { return {at[k].at + Vector{h * v.v.x, h * v.v.z}, at[k].angle + h * v.spin}; }

    // Velocities of the corners without impulses, with exact gaps at the end of a step with the velocities of the guess.
    void conditions(double h, const std::vector<Velocity>& before) {
        for (std::size_t k = 1; k < at.size(); ++k) next_[k] = Turn(at[k].angle + h * guess_[k].spin);
        for (std::size_t k = 0; k < laws.size(); ++k) {
            const State upper = moved(k + 1, h, guess_[k + 1]), lower = moved(k, h, guess_[k]);
            for (int i = 0; i < 2; ++i) {
                const Measure end = measure(corners_[k][i], upper, next_[k + 1], lower, next_[k]);
                const Row& normal = rows_[k][i][0];
                const double change = speed(normal, free_[k + 1], free_[k]) - speed(normal, guess_[k + 1], guess_[k]);
                joints_[k].constant[i] = end.gap / h + change;  // Eq. 379
                const double approach = speed(normal, before[k + 1], before[k]);
                struck_[k][i] = approach < -laws[k].slow * laws[k].width && joints_[k].constant[i] < 0.0;
                if (struck_[k][i] && laws[k].restitution > 0.0)
                    joints_[k].constant[i] = speed(normal, free_[k + 1], free_[k]) + laws[k].restitution * approach;
                if (i == guide_[k]) {
                    const Row& along = rows_[k][i][1];
                    joints_[k].constant[2] = (end.along - found_[k][i].along) / h + speed(along, free_[k + 1], free_[k]) - speed(along, guess_[k + 1], guess_[k]);
                }
            }
        }
    }

    void apply() {
        after_ = free_;
        for (std::size_t k = 0; k < laws.size(); ++k)
            for (int i = 0; i < 3; ++i) {
                const double p = joints_[k].impulse[i];
                const Row& r = row(k, i);
                Velocity &u = after_[k + 1], &l = after_[k];
                u.v = u.v + Vector{p * r.x * bodies[k + 1].inverse_mass, p * r.z * bodies[k + 1].inverse_mass};
                l.v = l.v - Vector{p * r.x * bodies[k].inverse_mass, p * r.z * bodies[k].inverse_mass};
                u.spin += p * r.upper * bodies[k + 1].inverse_inertia, l.spin -= p * r.lower * bodies[k].inverse_inertia;
            }
    }

    // The smallest gap at the end of the step.
    double depth(double h) {
        double smallest = 0.0;
        for (std::size_t k = 1; k < at.size(); ++k) next_[k] = Turn(at[k].angle + h * after_[k].spin);
        for (std::size_t k = 0; k < laws.size(); ++k) {
            const State upper = moved(k + 1, h, after_[k + 1]), lower = moved(k, h, after_[k]);
            for (const Corner& c : corners_[k]) smallest = std::min(smallest, measure(c, upper, next_[k + 1], lower, next_[k]).gap);
        }
        last_depth_ = smallest;
        return smallest;
    }
    double last_depth_ = 0.0;

    void account(double time, double h, double kick, Vector ground, const std::vector<Velocity>& before) {
        deepest = std::min(deepest, last_depth_);
        double done = 0.0;
        for (std::size_t k = 1; k < at.size(); ++k) {
            const Vector mean{0.5 * (before[k].v.x + after_[k].v.x), 0.5 * (before[k].v.z + after_[k].v.z)};
            const double spin = 0.5 * (before[k].spin + after_[k].spin);
            work -= mass[k] * kick * dot(ground, mean);
            done += mass[k] * dot(mean, after_[k].v - free_[k].v) + inertia[k] * spin * (after_[k].spin - free_[k].spin);
        }
        lost -= done, gained += std::max(done, 0.0);
        for (std::size_t row : pending_) write_after(row);
        pending_.clear();
        for (std::size_t k = 0; k < laws.size(); ++k) note(k, time, h, before);
    }

    void note(std::size_t k, double time, double h, const std::vector<Velocity>& before) {
        Extremes& e = extremes[k];
        const Joint& j = joints_[k];
        const double normal = j.impulse[0] + j.impulse[1];
        e.opening = std::max(e.opening, std::fabs(at[k + 1].angle - at[k].angle));
        if (time > 0.0) e.normal = std::min(e.normal, normal / (h * weight_above[k]));
        const int guide = guide_[k];
        const State upper = moved(k + 1, h, after_[k + 1]), lower = moved(k, h, after_[k]);
        const Measure end = measure(corners_[k][guide], upper, next_[k + 1], lower, next_[k]);
        const double last = e.displacement, other = measure(corners_[k][1 - guide], upper, next_[k + 1], lower, next_[k]).gap;
        e.displacement = end.along - at_rest(k, corners_[k][guide]), e.slip = std::max(e.slip, std::fabs(e.displacement));
        e.gap = std::max(e.gap, std::min(end.gap, other));
        if (e.gap > kOpen * laws[k].width && !(e.flight_time >= 0.0)) e.flight_time = e.contact;
        if (normal > 0.0) {
            e.contact = time + h;
            e.ratio = std::max(e.ratio, std::fabs(j.impulse[2]) / normal);
            if (j.slides && std::fabs(e.displacement - last) > 1e-9 * laws[k].width && !(e.slip_time >= 0.0)) e.slip_time = time;
        }
        for (int i = 0; i < 2; ++i) {
            if (!struck_[k][i] || !(j.impulse[i] > 0.0)) continue;
            const double approach = speed(rows_[k][i][0], before[k + 1], before[k]), noted = noted_[k];
            noted_[k] = time;
            if (time - noted < 1.5 * h) continue;  // the second step of the same impact
            record(k, time + std::clamp(found_[k][i].gap / -approach, 0.0, h), before);
        }
    }

    // Position of a corner along the closed joint, without displacement.
    double at_rest(std::size_t k, const Corner& c) const { return c.above ? laws[k].offset + c.own.x : laws[k].offset - c.own.x; }

    void record(std::size_t k, double time, const std::vector<Velocity>& before) {
        const std::size_t n = laws.size();
        const std::size_t rows = events.size() / (2 + 3 * n);
        if (static_cast<std::int64_t>(rows) >= set_.most_events) status = kTooManyEvents;
        events.push_back(time), events.push_back(static_cast<double>(k));
        for (std::size_t i = 1; i <= n; ++i) events.push_back(at[i].angle + (time - now_) * before[i].spin);
        for (std::size_t i = 1; i <= n; ++i) events.push_back(before[i].spin);
        for (std::size_t i = 1; i <= n; ++i) events.push_back(kNan);
        pending_.push_back(rows);
    }
    // The velocities after an impact are those of the next step, because the corner reaches the face at the end of this step.
    void write_after(std::size_t row) {
        const std::size_t n = laws.size();
        for (std::size_t i = 0; i < n; ++i) events[row * (2 + 3 * n) + 2 + 2 * n + i] = after_[i + 1].spin;
    }
};

}  // namespace rocking::stack
