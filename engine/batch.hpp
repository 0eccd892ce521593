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
    std::int64_t first;     // index of its first number
    std::int64_t segments;  // number of stretches
    std::int64_t still;     // stretches of rest after them; the jump to zero is a pair of samples at one instant
    double step;            // duration of a stretch [s]
    std::int64_t block;     // index of its first block in the ranges
    Range horizontal, vertical;  // of its accelerations, zero included [m/s2]
};

constexpr int kBlock = 32;  // stretches whose accelerations have a range of their own

// Smallest and largest accelerations of one direction [m/s2].
struct Ranges {
    std::vector<Range> within;  // each block
    std::vector<Range> later;   // from each block to the end, zero included
};

// The motions of a batch. Degree 1: samples one after another, pairs (horizontal, vertical) where there is a vertical
// part. Degree 7: coefficients of the stretches one after another.
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
    std::vector<double> at, value[2];  // of landing on the right, on the left
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
    const double* share[2];  // fraction of the probability of a random law that a side samples: larger values create energy
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
    double longest_step;  // p * step of a Taylor expansion [-]
    double rest;          // speed over p alpha below which impacts may be summed up to rest [-]
    std::int64_t most_impacts;
    bool linear;
    int order;
    bool to_the_ground;   // continue an overturning body until it lies on the ground
};

// Largest acceleration of a motion over gravity, resultant of both directions.
inline double strength_of(const Shake& shake, double over_gravity) {
    const double push = std::max(shake.horizontal.high, -shake.horizontal.low);
    const double lift = std::max(shake.vertical.high, -shake.vertical.low);
    return std::fabs(over_gravity) * (push + lift);
}

// Number of parts of a stretch. At accelerations of many g the ground moves the body faster than gravity.
inline double parts_of(const Shake& shake, double p, double over_gravity, double longest_step) {
    const double reach = p * shake.step * std::sqrt(std::max(1.0, 0.5 * strength_of(shake, over_gravity)));
    return std::max(1.0, std::ceil(reach / longest_step));  // Eq. 53
}

// Reach, p times a step under 1 g, up to which the truncation error of order 6, reach^7 / 7! of p alpha, is below a hundredth
// of that of order 8 at its longest step: equally accurate, and faster.
inline double reach_of_order_six(double longest_step) { return std::pow(std::pow(longest_step, 9) / 7200.0, 1.0 / 7.0); }  // Eq. 54

// True if all steps of a row are so short that order 6 is sufficient. Under b g the error of a rotation is about
// reach^5 b^3 / 70 of alpha in a step.
inline bool takes_order_six(const Motions& m, const Rows& rows, std::int64_t row, const Settings& set, double reach) {
    if (set.order != 8 || m.degree != 1 || set.linear) return false;
    if (rows.motion[row] < 0 || rows.motion[row] >= static_cast<std::int64_t>(m.shakes.size())) return false;
    const Shake& shake = m.shakes[rows.motion[row]];
    const double p = std::max(rows.p_right[row], rows.p_left[row]);
    return p * shake.step * std::pow(std::max(1.0, strength_of(shake, rows.scale[row] / set.gravity)), 0.6) < reach;
}

// Waiting rows. Threads take several at a time, and fewer towards the end, so that all threads end together.
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
    std::int64_t events = 0; // of single lanes
    std::int64_t orders = 0; // steps times their order
};

}  // namespace rocking
