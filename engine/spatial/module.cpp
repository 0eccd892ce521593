// Interface to Python: bodies and motions are passed once, then tables of histories. Each thread computes the next row that is not started.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <string>
#include <thread>

#include "table.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace rocking::spatial {

template <class T>
using Line = nb::ndarray<T, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
template <class T>
using Table = nb::ndarray<T, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

constexpr std::int64_t kChunk = 8, kMostCorners = 64, kKeptNumbers = 117;

static std::vector<std::string> instruction_sets() {
    std::vector<std::string> names;
#if defined(ROCKING_X86)
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl")) names.push_back("avx512");
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) names.push_back("avx2");
#endif
    names.push_back("plain");
    return names;
}

static void expect(bool fine, const char* message) {
    if (!fine) throw std::invalid_argument(message);
}

class Stock {
public:
    Stock(Table<const double> bodies, Table<const std::int64_t> corners, Table<const double> vertices, Line<const double> kept,
          Table<const double> positions, int degree, Table<const std::int64_t> places, Line<const double> times, Line<const double> accelerations, const std::string& isa) {
        const auto size = [](const auto& a, int k) { return static_cast<std::int64_t>(a.shape(k)); };
        Numbers n{bodies.data(), corners.data(), vertices.data(), kept.size() ? kept.data() : nullptr, positions.data(),
                  size(bodies, 0), size(vertices, 0), size(positions, 0), degree, places.data(), times.data(), accelerations.data(), size(places, 0), size(times, 0), size(accelerations, 0)};
        expect(size(bodies, 1) == kBodyNumbers && size(corners, 0) == n.body_count && size(corners, 1) == kBodyPlaces, "a table of bodies expected");
        expect(size(positions, 1) == kPosition, "azimuths and coefficients of intervals expected");
        expect(size(vertices, 1) == 2 && size(places, 1) == 3 && (degree == 1 || degree == 7), "tables of vertices and motions expected");
        expect(!n.kept || size(kept, 0) == 2 * n.vertex_count * kKeptNumbers, "moments of every vertex and edge expected");
        for (std::int64_t i = 0; i < n.body_count; ++i) {
            const std::int64_t *corners_of = n.corners + i * kBodyPlaces, first = corners_of[0], count = corners_of[1];
            expect(first >= 0 && count >= 0 && count != 1 && count != 2 && count <= kMostCorners && first + count <= n.vertex_count,
                   "a body names vertices that are not there");
            for (const std::int64_t* range : {corners_of + 2, corners_of + 4})
                expect(range[0] >= 0 && range[1] >= 0 && range[0] + range[1] <= n.position_count, "a body names intervals that are not there");
        }
        for (std::int64_t i = 0; i < n.motion_count; ++i) {
            const std::int64_t* p = n.places + 3 * i;
            expect(p[0] >= 0 && p[1] >= 0 && p[2] >= 0 && p[0] + p[2] < n.time_count && p[1] + p[2] * 3 * (degree + 1) <= n.acceleration_count,
                   "a motion names numbers that are not there");
        }
        const auto supported = instruction_sets();
        expect(std::find(supported.begin(), supported.end(), isa) != supported.end(), "an instruction set of this processor expected");
#if defined(ROCKING_X86)
        if (isa != "plain") engine_ = avx2::engine_of(n);  // three components: wider registers have no effect
#endif
        if (!engine_) engine_ = plain::engine_of(n);
    }

    void run(Table<const double> numbers, Table<const std::int64_t> choices, Table<double> results, Table<std::int64_t> counts, double gravity,
             double rest_speed, double tolerance, double longest, std::int64_t most_events, int threads) const {
        const Rows rows = rows_of(numbers, choices, results, counts);
        const Limits limits{gravity, rest_speed, tolerance, longest, most_events};
        const auto count = static_cast<std::int64_t>(numbers.shape(0));
        expect(threads > 0, "at least one thread expected");
        nb::gil_scoped_release release;
        std::atomic<std::int64_t> next{0};
        auto labour = [&] {
            for (std::int64_t first; (first = next.fetch_add(kChunk)) < count;)
                for (std::int64_t row = first; row < std::min(first + kChunk, count); ++row) engine_->run(rows, row, limits, nullptr);
        };
        std::vector<std::thread> crew;
        for (std::int64_t k = 1; k < std::min<std::int64_t>(threads, (count + kChunk - 1) / kChunk); ++k) crew.emplace_back(labour);
        labour();
        for (std::thread& worker : crew) worker.join();
    }

    nb::object trace(Table<const double> numbers, Table<const std::int64_t> choices, Table<double> results, Table<std::int64_t> counts,
                     double gravity, double rest_speed, double tolerance, double longest, std::int64_t most_events) const {
        const Rows rows = rows_of(numbers, choices, results, counts);
        expect(numbers.shape(0) == 1, "one row expected");
        std::vector<double> samples;
        engine_->run(rows, 0, {gravity, rest_speed, tolerance, longest, most_events}, &samples);
        double* data = new double[samples.size() + 1];
        std::copy(samples.begin(), samples.end(), data);
        nb::capsule owner(data, [](void* p) noexcept { delete[] static_cast<double*>(p); });
        return nb::cast(nb::ndarray<nb::numpy, double, nb::ndim<2>>(data, {samples.size() / kSample, static_cast<std::size_t>(kSample)}, owner));
    }

private:
    static Rows rows_of(const Table<const double>& numbers, const Table<const std::int64_t>& choices, const Table<double>& results,
                        const Table<std::int64_t>& counts) {
        const auto fits = [&](const auto& a, int columns) { return a.shape(0) == numbers.shape(0) && static_cast<int>(a.shape(1)) == columns; };
        expect(fits(numbers, kRowNumbers) && fits(choices, kRowChoices) && fits(results, kResults) && fits(counts, kCounts),
               "tables of histories expected");
        return {numbers.data(), choices.data(), results.data(), counts.data()};
    }

    std::unique_ptr<Engine> engine_;
};

}  // namespace rocking::spatial

NB_MODULE(_spatial, m) {
    using namespace rocking::spatial;
    m.doc() = "Many histories of bodies in space.";
    m.def("instruction_sets", &instruction_sets);
    nb::class_<Stock>(m, "Stock")
        .def(nb::init<Table<const double>, Table<const std::int64_t>, Table<const double>, Line<const double>, Table<const double>, int,
                      Table<const std::int64_t>, Line<const double>, Line<const double>, const std::string&>(),
             "bodies"_a, "corners"_a, "vertices"_a, "kept"_a, "positions"_a, "degree"_a, "places"_a, "times"_a, "accelerations"_a, "isa"_a)
        .def("run", &Stock::run, "numbers"_a, "choices"_a, "results"_a, "counts"_a, "gravity"_a, "rest_speed"_a, "tolerance"_a, "longest"_a,
             "most_events"_a, "threads"_a)
        .def("trace", &Stock::trace, "numbers"_a, "choices"_a, "results"_a, "counts"_a, "gravity"_a, "rest_speed"_a, "tolerance"_a,
             "longest"_a, "most_events"_a);
}
