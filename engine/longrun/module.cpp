// The door to Python: rows of bodies, forcings and starts; threads take rows in turn.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "kernel.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace rocking::longrun {

template <class T, int n>
using Array = nb::ndarray<T, nb::ndim<n>, nb::c_contig, nb::device::cpu>;

static void expect(bool holds, const char* message) {
    if (!holds) throw std::invalid_argument(message);
}

template <class Work>
static void spread(int threads, Work work) {
    std::vector<std::thread> others;
    for (int k = 1; k < threads; ++k) others.emplace_back(work);
    work();
    for (auto& thread : others) thread.join();
}

// The fastest instruction set of this processor that was compiled.
static int best() {
#if defined(ROCKING_X86)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl")) return 2;
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return 1;
#endif
    return 0;
}
static int level(const std::string& isa) {
    const int known = best(), asked = isa == "avx512" ? 2 : isa == "avx2" ? 1 : isa == "plain" ? 0 : isa.empty() ? known : 3;
    if (asked > known) throw std::invalid_argument("this processor has no " + isa);
    return asked;
}

static SpeedLaw of(const Array<const double, 2>& law) { return {law.data(), law.data() + law.shape(1), static_cast<int>(law.shape(1))}; }

// bodies: (rows, 6), sines: (rows, sines, 3), starts: (rows, 3) of time, rotation and rotation rate.
static void many(Array<const double, 2> bodies, Array<const double, 3> sines, Array<const double, 2> starts, Array<double, 2> results, Array<double, 3> sections,
                 Array<double, 3> impacts, Array<const double, 2> law, std::int64_t settled, int vectors, bool linear, double overturned, double rest, double step_error, int threads, const std::string& isa) {
    const auto rows = static_cast<std::int64_t>(bodies.shape(0));
    const auto fits = [&](const auto& array) { return static_cast<std::int64_t>(array.shape(0)) == rows; };
    expect(fits(sines) && fits(starts) && fits(results) && fits(sections) && fits(impacts) && bodies.shape(1) == kBody && starts.shape(1) == kStart &&
               sines.shape(2) == 3 && sines.shape(1) >= 1 && sines.shape(1) <= kMostSines && results.shape(1) == kResults && sections.shape(2) == 2 &&
               impacts.shape(2) == 3 && threads > 0 && vectors >= 0 && vectors <= 2 && settled >= 0 && sections.shape(1) > 0 && law.shape(0) == 2,
           "tables of histories expected");
    const Cycles work{bodies.data(), starts.data(), reinterpret_cast<const Sine*>(sines.data()), results.data(), sections.data(), impacts.data(), rows, settled,
                      static_cast<std::int64_t>(sections.shape(1)), static_cast<std::int64_t>(impacts.shape(1)),
                      {static_cast<int>(sines.shape(1)), linear, overturned, rest, step_error, Parameter::none, of(law)}};
    const int set = level(isa);
    Queue queue{0};
    nb::gil_scoped_release release;
    spread(threads, [&] {
#if defined(ROCKING_X86)
        if (set == 2) return avx512::longrun::cycles(work, vectors, queue);
        if (set == 1) return avx2::longrun::cycles(work, vectors, queue);
#endif
        plain::longrun::cycles(work, vectors, queue);
    });
}

// From one impact over n: starts (rows, 3) of time, speed after the impact and side; ends (rows, 12): time, speed, side, event, derivatives of
// time and then of speed by start time, start speed and parameter (none for -1), peak over alpha, velocity before the last impact.
static void over_impacts(Array<const double, 2> bodies, Array<const double, 3> sines, Array<const double, 2> starts, Array<double, 2> ends, Array<const double, 2> law, std::int64_t n, int parameter,
                         bool linear, double overturned, double rest, double step_error, int threads, const std::string& isa) {
    const auto rows = static_cast<std::int64_t>(bodies.shape(0));
    const auto fits = [&](const auto& array) { return static_cast<std::int64_t>(array.shape(0)) == rows; };
    expect(fits(sines) && fits(starts) && fits(ends) && bodies.shape(1) == kBody && starts.shape(1) == kStart && ends.shape(1) == kEnds && sines.shape(2) == 3 &&
               sines.shape(1) >= 1 && sines.shape(1) <= kMostSines && n > 0 && parameter >= -1 && parameter <= 4 && threads > 0 && law.shape(0) == 2,
           "tables of flights expected");
    const Flights work{bodies.data(), starts.data(), reinterpret_cast<const Sine*>(sines.data()), ends.data(), rows, n,
                       {static_cast<int>(sines.shape(1)), linear, overturned, rest, step_error, static_cast<Parameter>(std::max(parameter, 0)), of(law)}};
    const int set = level(isa);
    Queue queue{0};
    nb::gil_scoped_release release;
    spread(threads, [&] {
#if defined(ROCKING_X86)
        if (set == 2) return avx512::longrun::flights(work, parameter >= 0, queue);
        if (set == 1) return avx2::longrun::flights(work, parameter >= 0, queue);
#endif
        plain::longrun::flights(work, parameter >= 0, queue);
    });
}

NB_MODULE(_longrun, m) {
    m.def("many", &many, "bodies"_a, "sines"_a, "starts"_a, "results"_a, "sections"_a, "impacts"_a, "law"_a, "settled"_a, "vectors"_a, "linear"_a, "overturned"_a, "rest"_a,
          "step_error"_a, "threads"_a, "isa"_a = "");
    m.def("over_impacts", &over_impacts, "bodies"_a, "sines"_a, "starts"_a, "ends"_a, "law"_a, "n"_a, "parameter"_a, "linear"_a, "overturned"_a, "rest"_a, "step_error"_a, "threads"_a,
          "isa"_a = "");
}

}  // namespace rocking::longrun
