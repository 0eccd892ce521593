// Inputs and results of the engine: plain arrays, one entry per history.
#pragma once
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <vector>

namespace rocking {

enum Outcome : std::int8_t { kNoUplift = 0, kRocked = 1, kOverturned = 2, kFailed = 3 };
enum Status : std::int8_t { kGood = 0, kInvalid = 1, kNotFinite = 2, kTooManyEvents = 3, kNotResolved = 4 };
enum EventKind : std::int8_t { kUplift = 0, kImpact = 1, kRest = 2 };

struct Range {
    double low, high;
};

// One ground motion within the common array of coefficients.
struct Shake {
    std::int64_t first;     // index of the first coefficient of the motion
    std::int64_t segments;  // number of segments (intervals between samples)
    // number of segments of rest after the motion; two samples at one instant are the jump to zero
    std::int64_t still;
    double step;            // duration of a segment [s]
    std::int64_t block;     // index of the first block of the motion in the ranges
    Range horizontal, vertical;  // ranges of the accelerations; they include zero [m/s2]
};

constexpr int kBlock = 32;  // number of segments in a block; every block has one range of accelerations

// Smallest and largest accelerations of one direction [m/s2].
struct Ranges {
    std::vector<Range> within;  // range within every block
    std::vector<Range> later;   // range from every block to the end; includes zero
};

// The motions of a batch. Degree 1: a list of samples, or of pairs (horizontal, vertical) if there is a vertical part.
// Degree 7: a list of the coefficients of all segments.
struct Motions {
    const double* data;
    int degree;
    bool vertical_part;
    std::vector<Shake> shakes;
    Ranges horizontal, vertical;  // the second is empty without a vertical part
    int stride() const { return degree == 1 ? (vertical_part ? 2 : 1) : degree + 1; }
    void find_ranges();
};

// Velocity change at an impact: r = r_side * table(speed), or r_side * quantile_side(share_side * random number).
enum class LawKind : int { constant = 0, of_speed = 1, random = 2 };
struct Law {
    LawKind kind = LawKind::constant;
    // abscissae; values of the tables for landing on the right foot and on the left foot
    std::vector<double> at, value[2];
    std::uint64_t seed = 0;
    double largest[2] = {1.0, 1.0};
};

struct Event {
    double time, before, after, coefficient;
    EventKind kind;
    std::int8_t side;
};

// Output of a single history: samples and events.
struct Trace {
    double* rotation;
    double* velocity;
    std::vector<Event> events;
};

struct Rows {
    std::int64_t count;
    const double *alpha_right, *alpha_left, *p_right, *p_left, *r_right, *r_left, *q_right, *q_left;
    // per side: fraction of the probability of a random law that is sampled; larger values create energy
    const double* share[2];
    const double *scale, *rotation, *velocity;
    const std::int64_t *motion, *key;
    // results
    std::int8_t *outcome, *status, *side, *still;
    double *peak, *peak_time, *peak_velocity, *overturning_time, *first_uplift, *error, *least_force, *friction;
    std::int64_t *impacts, *uplifts;
    const std::int64_t* list = nullptr;  // rows to compute; all rows if empty
};

struct Settings {
    double gravity;
    double longest_step;  // largest p * step of a Taylor expansion [-]
    double rest;          // speed / (p alpha) below which a series of impacts may be replaced by rest [-]
    std::int64_t most_impacts;
    bool linear;
    int order;
    bool to_the_ground;   // continue an overturning body until it lies on the ground
};

// Largest resultant acceleration of a motion, from both directions, divided by gravity.
inline double strength_of(const Shake& shake, double over_gravity) {
    const double push = std::max(shake.horizontal.high, -shake.horizontal.low);
    const double lift = std::max(shake.vertical.high, -shake.vertical.low);
    return std::fabs(over_gravity) * (push + lift);
}

// Number of parts of a segment. At accelerations of many g the ground moves the body faster than gravity.
inline double parts_of(const Shake& shake, double p, double over_gravity, double longest_step) {
    const double reach = p * shake.step * std::sqrt(std::max(1.0, 0.5 * strength_of(shake, over_gravity)));
    return std::max(1.0, std::ceil(reach / longest_step));  // Eq. 53
}

// Largest reach (p times a step under 1 g) for order 6: its truncation error, reach^7 / 7! of p alpha, is then below
// 1/100 of the error of order 8 at its longest step. Order 6 is faster.
inline double reach_of_order_six(double longest_step) { return std::pow(std::pow(longest_step, 9) / 7200.0, 1.0 / 7.0); }  // Eq. 54

// True if all steps of a row are short enough for order 6. Under b g the error of the rotation in a step is about
// reach^5 b^3 / 70 of alpha.
inline bool takes_order_six(const Motions& m, const Rows& rows, std::int64_t row, const Settings& set, double reach) {
    if (set.order != 8 || m.degree != 1 || set.linear) return false;
    if (rows.motion[row] < 0 || rows.motion[row] >= static_cast<std::int64_t>(m.shakes.size())) return false;
    const Shake& shake = m.shakes[rows.motion[row]];
    const double p = std::max(rows.p_right[row], rows.p_left[row]);
    return p * shake.step * std::pow(std::max(1.0, strength_of(shake, rows.scale[row] / set.gravity)), 0.6) < reach;
}

// Queue of rows. A thread takes several rows at a time, and fewer rows near the end. Thus all threads end together.
struct Queue {
    std::int64_t end, chunk, threads;
    std::atomic<std::int64_t> next{0};

    bool take(std::int64_t& from, std::int64_t& to) {
        from = next.load();
        do {
            if (from >= end) {
                from = to = end;
                return false;
            }
            to = from + std::clamp<std::int64_t>((end - from) / (4 * threads), 1, chunk);
        } while (!next.compare_exchange_weak(from, to));
        return true;
    }
};

struct Work {
    std::int64_t steps = 0;  // Taylor steps of active lanes
    std::int64_t sweeps = 0; // steps of all lanes
    std::int64_t events = 0; // events of single lanes
    std::int64_t orders = 0; // sum of the orders of all steps
};

}  // namespace rocking
