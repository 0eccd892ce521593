// Input and output of the long-run engine.
#pragma once
#include <atomic>
#include <cstdint>

namespace rocking {
namespace longrun {

struct Side {
    double alpha, p2, r;  // r: coefficient of restitution of impacts that end the contact on this side
};
// Factor on the coefficients of restitution over the rotation rate before the impact: linear between points, constant outside.
struct SpeedLaw {
    const double *at, *factors;
    int points;
};
struct Sine {
    double amplitude, omega, phase;  // ground acceleration / g: amplitude, circular frequency, phase
};
enum class Parameter : int { none, amplitude, omega, restitution, alpha };

struct Settings {
    int sines;
    bool linear;
    // rotation at the end, largest speed / (alpha p) of a possible rest, error of a step / alpha
    double overturned, rest, step_error;
    Parameter parameter;      // parameter of the last tangent vector; all amplitudes change in proportion
    SpeedLaw law;
};

constexpr int kBody = 6, kStart = 3, kResults = 9, kEnds = 13, kMostSines = 32;

struct Rows {
    const double *bodies, *starts;
    const Sine* sines;
    std::int64_t count;
    Settings set;
};
// Histories over complete periods of the first sine: transient periods, then recorded periods with states and impacts.
struct Cycles : Rows {
    double *results, *sections, *impacts;
    std::int64_t settled, kept, most_impacts;
};
// Motions from one impact over a number of impacts, with derivatives.
struct Flights : Rows {
    double* ends;
    std::int64_t impacts;
};

using Queue = std::atomic<std::int64_t>;

#define ROCKING_LONGRUN(isa)                                                           \
    namespace isa {                                                                    \
    namespace longrun {                                                                \
    void run(const rocking::longrun::Cycles&, int vectors, rocking::longrun::Queue&);  \
    void run(const rocking::longrun::Flights&, int vectors, rocking::longrun::Queue&); \
    }                                                                                  \
    }

}  // namespace longrun
ROCKING_LONGRUN(plain)
ROCKING_LONGRUN(avx2)
ROCKING_LONGRUN(avx512)
}  // namespace rocking
