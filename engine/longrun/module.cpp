// Interface to Python: rows of bodies, forcings and starts. Threads take rows in turn.
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

// Instruction set with a given name; without a name, the fastest compiled set that this processor supports.
static int level(const std::string& isa) {
    int known = 0;
#if defined(ROCKING_X86)
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) known = 1;
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl")) known = 2;
#endif
    const int asked = isa == "avx512" ? 2 : isa == "avx2" ? 1 : isa == "plain" ? 0 : isa.empty() ? known : 3;
    if (asked > known) throw std::invalid_argument("this processor has no " + isa);
    return asked;
}

template <class Work>
static void spread(const Work& work, int vectors, int threads, const std::string& isa) {
    const int set = level(isa);
    Queue queue{0};
    const auto crew_member = [&] {
#if defined(ROCKING_X86)
        if (set == 2) return avx512::longrun::run(work, vectors, queue);
        if (set == 1) return avx2::longrun::run(work, vectors, queue);
#endif
        plain::longrun::run(work, vectors, queue);
    };
    nb::gil_scoped_release release;
    std::vector<std::thread> others;
    for (int k = 1; k < threads; ++k) others.emplace_back(crew_member);
    crew_member();
    for (auto& thread : others) thread.join();
}

using Table = Array<const double, 2>;
using Sines = Array<const double, 3>;

// bodies: (rows, 6), sines: (rows, sines, 3), starts: (rows, 3), law: (2, points), results: all result tables.
template <class... Results>
static Rows rows_of(const Table& bodies, const Sines& sines, const Table& starts, const Table& law, int parameter, bool linear, double overturned, double rest,
                    double step_error, const Results&... results) {
    const auto rows = bodies.shape(0);
    expect(((sines.shape(0) == rows && starts.shape(0) == rows) && ... && (results.shape(0) == rows)) && bodies.shape(1) == kBody && starts.shape(1) == kStart &&
               sines.shape(2) == 3 && sines.shape(1) >= 1 && sines.shape(1) <= kMostSines && law.shape(0) == 2 && parameter >= -1 && parameter <= 4,
           "tables of histories expected");
    return {bodies.data(), starts.data(), reinterpret_cast<const Sine*>(sines.data()), static_cast<std::int64_t>(rows),
            {static_cast<int>(sines.shape(1)), linear, overturned, rest, step_error, static_cast<Parameter>(std::max(parameter, 0)),
             {law.data(), law.data() + law.shape(1), static_cast<int>(law.shape(1))}}};
}

// Histories over periods; a start has time, rotation and rotation rate.
static void many(Table bodies, Sines sines, Table starts, Array<double, 2> results, Array<double, 3> sections, Array<double, 3> impacts, Table law, std::int64_t settled,
                 int vectors, bool linear, double overturned, double rest, double step_error, int threads, const std::string& isa) {
    const Rows rows = rows_of(bodies, sines, starts, law, 0, linear, overturned, rest, step_error, results, sections, impacts);
    expect(results.shape(1) == kResults && sections.shape(2) == 2 && sections.shape(1) > 0 && impacts.shape(2) == 3 && threads > 0 && vectors >= 0 && vectors <= 2 && settled >= 0,
           "tables of results expected");
    const auto kept = static_cast<std::int64_t>(sections.shape(1)), most = static_cast<std::int64_t>(impacts.shape(1));
    spread(Cycles{rows, results.data(), sections.data(), impacts.data(), settled, kept, most}, vectors, threads, isa);
}

// Motions over n impacts. starts: time, speed after the impact, side. ends (rows, 13): time, speed, side, event,
// derivatives of time and then of speed by start time, start speed and parameter (-1: none), peak / alpha, velocity
// before the last impact, and smallest minimum of y between impacts, / alpha (only with derivatives).
static void over_impacts(Table bodies, Sines sines, Table starts, Array<double, 2> ends, Table law, std::int64_t n, int parameter, bool linear, double overturned,
                         double rest, double step_error, int threads, const std::string& isa) {
    const Rows rows = rows_of(bodies, sines, starts, law, parameter, linear, overturned, rest, step_error, ends);
    expect(ends.shape(1) == kEnds && n > 0 && threads > 0, "table of ends expected");
    spread(Flights{rows, ends.data(), n}, parameter >= 0 ? 3 : 0, threads, isa);
}

NB_MODULE(_longrun, m) {
    m.def("many", &many, "bodies"_a, "sines"_a, "starts"_a, "results"_a, "sections"_a, "impacts"_a, "law"_a, "settled"_a, "vectors"_a, "linear"_a, "overturned"_a, "rest"_a,
          "step_error"_a, "threads"_a, "isa"_a = "");
    m.def("over_impacts", &over_impacts, "bodies"_a, "sines"_a, "starts"_a, "ends"_a, "law"_a, "n"_a, "parameter"_a, "linear"_a, "overturned"_a, "rest"_a, "step_error"_a, "threads"_a,
          "isa"_a = "");
}

}  // namespace rocking::longrun
