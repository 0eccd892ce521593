// Tables of numbers between the interface to Python and the kernels, equal for all instruction sets.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

namespace rocking::spatial {

// Numbers per interval of the impulse position k: first azimuth, last azimuth, Chebyshev coefficients.
constexpr int kPosition = 35;
// body: mass, p, size, lift, radius, centre (3), inertia (9); row: coefficient, scale, horizon, attitude (4), velocity
// (3)
constexpr int kBodyNumbers = 17, kBodyPlaces = 6, kRowNumbers = 10, kRowChoices = 3;
// peak tilt, its time, peak spin, overturning time, direction, first uplift, end, held, lost energy
constexpr int kResults = 9;
// outcome, status, contact and its number at overturning, impacts, uplifts, events, steps, 1 if the body still rocks
constexpr int kCounts = 9;
// time, kind, contact, number, energies before and after, three axes, velocity
constexpr int kSample = 18;

struct Numbers {
    const double* bodies;             // rows by body
    // by body: first vertex, number of vertices; for two models first interval of k, number of intervals
    const std::int64_t* corners;
    const double* vertices;           // x and y
    const double* kept;               // moments by vertex and edge of all bodies, or null
    const double* positions;          // impulse positions k of landings of the complete base: intervals of all bodies and models
    std::int64_t body_count, vertex_count, position_count;
    int degree;
    // by motion: index of its first time, index of its first acceleration, number of segments
    const std::int64_t* places;
    const double *times, *accelerations;
    std::int64_t motion_count, time_count, acceleration_count;
};

struct Limits {
    double gravity, rest_speed, tolerance, longest;
    std::int64_t most_events;
};

struct Rows {
    const double* numbers;
    const std::int64_t* choices;      // body, motion, law
    double* results;
    std::int64_t* counts;
};

class Engine {
public:
    virtual ~Engine() = default;
    virtual void run(const Rows& rows, std::int64_t row, const Limits& limits, std::vector<double>* trace) const = 0;
};

#define ROCKING_DECLARE(isa) \
    namespace isa { std::unique_ptr<Engine> engine_of(const Numbers& numbers); }
ROCKING_DECLARE(plain)
ROCKING_DECLARE(avx2)
#undef ROCKING_DECLARE

}  // namespace rocking::spatial
