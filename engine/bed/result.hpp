// Inputs and results of one impact.
#pragma once
#include <cstdint>
#include <vector>

#include "contact.hpp"

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

}  // namespace rocking::bed
