// Input and output of the long-run engine.
#pragma once
#include <atomic>
#include <cstdint>

namespace rocking {
namespace longrun {

struct Side {
    double alpha, p2, r;  // coefficient of restitution of impacts that end the contact on this side
};
// Factor on the coefficients of restitution over the rotation rate before the impact: linear between points, constant outside.
struct SpeedLaw {
    const double *at, *factors;
    int points;
};
struct Sine {
    double amplitude, omega, phase;  // of the ground acceleration over g
};
enum class Parameter : int { none, amplitude, omega, restitution, alpha };

struct Settings {
    int sines;
    bool linear;
    double overturned, rest, step_error;  // final rotation, speed over alpha p of a possible rest, error of a step over alpha
    Parameter parameter;      // of the last tangent vector; the amplitudes change in proportion
    SpeedLaw law;
};

constexpr int kBody = 6, kStart = 3, kResults = 9, kEnds = 12, kMostSines = 32;

// Rows of histories over whole periods of the first sine: settled ones, then kept ones with their states and impacts.
struct Cycles {
    const double *bodies, *starts;
    const Sine* sines;
    double *results, *sections, *impacts;
    std::int64_t rows, settled, kept, most_impacts;
    Settings set;
};
// Rows of flights from one impact over n impacts, with derivatives.
struct Flights {
    const double *bodies, *starts;
    const Sine* sines;
    double* ends;
    std::int64_t rows, impacts;
    Settings set;
};

using Queue = std::atomic<std::int64_t>;

#define ROCKING_LONGRUN(isa)                                       \
    namespace isa {                                                \
    namespace longrun {                                            \
    void cycles(const rocking::longrun::Cycles&, int vectors, Queue&); \
    void flights(const rocking::longrun::Flights&, bool derivatives, Queue&); \
    }                                                              \
    }

}  // namespace longrun
using longrun::Queue;
ROCKING_LONGRUN(plain)
ROCKING_LONGRUN(avx2)
ROCKING_LONGRUN(avx512)
}  // namespace rocking
