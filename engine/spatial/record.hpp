// Inputs and results of a history.
#pragma once
#include <limits>

#include "rest.hpp"

namespace rocking::spatial {
namespace ROCKING_ISA {

enum Outcome : int { kNoUplift = 0, kRocked = 1, kOverturned = 2, kFailed = 3 };
enum Status : int { kGood = 0, kInvalid = 1, kNotFinite = 2, kTooManyEvents = 3, kLostContact = 5 };  // codes of `Status`
enum Kind : int { kUplift = 0, kImpact = 1, kChange = 2, kComesToRest = 3 };

struct Settings {
    double gravity, rest_speed, tolerance, longest;
    std::int64_t most_events;
};

struct Row {
    std::int64_t body = 0, motion = 0, law = 0;
    double coefficient = 0.0, scale = 1.0, horizon = 0.0;
    double attitude[4] = {1.0, 0.0, 0.0, 0.0};
    Vec velocity;
};

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct Result {
    int outcome = kFailed, status = kInvalid, over_contact = -1, over_number = -1;
    double peak_tilt = kNan, peak_time = kNan, peak_spin = kNan, overturning_time = kNan, direction = kNan, first_uplift = kNan;
    double end_time = kNan, held = kNan, lost = kNan;
    std::int64_t impacts = 0, uplifts = 0, events = 0, steps = 0, still_rocking = 0;
};

// Attitude as the axes of the ground in axes of the body, angular velocity in axes of the body.
struct Sample {
    double time;
    int kind, contact, number;  // number -1: end of a step
    double before, after;
    Vec x, y, z, velocity;
};

inline double azimuth_of(Vec x, Vec y) { return std::atan2(y.z, x.z); }

}  // namespace ROCKING_ISA
}  // namespace rocking::spatial
