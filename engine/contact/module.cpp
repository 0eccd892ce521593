// Interface to Python: bodies and motions are passed once, then tables of histories. Threads take rows in turn.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <atomic>
#include <stdexcept>
#include <thread>

#include "half_cycles.hpp"
#include "run.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace rocking::contact {

template <class T>
using Line = nb::ndarray<T, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
template <class T>
using Table = nb::ndarray<T, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
template <class T>
using Block = nb::ndarray<T, nb::ndim<3>, nb::c_contig, nb::device::cpu>;

constexpr int kNumbers = 16, kChoices = 3, kResults = 9, kCounts = 9;
constexpr std::int64_t kChunk = 8;

static void expect(bool fine, const char* message) {
    if (!fine) throw std::invalid_argument(message);
}

class Library {
  public:
    // Each row of `places`: first coefficient, number of segments, number of terms, 1 if a vertical part follows.
    Library(Line<const double> data, Table<const std::int64_t> places, Line<const double> steps) : data_(data.data(), data.data() + data.size()) {
        expect(places.shape(1) == 4 && places.shape(0) == steps.size(), "tables of motions expected");
        const auto size = static_cast<std::int64_t>(data.size());
        for (std::size_t i = 0; i < steps.size(); ++i) {
            const std::int64_t *p = places.data() + 4 * i, length = p[1] * p[2];
            expect(p[0] >= 0 && p[1] >= 1 && p[2] >= 1 && p[2] <= kGround && p[0] + length * (p[3] ? 2 : 1) <= size && steps.data()[i] > 0.0,
                   "a motion names numbers that are not there");
            motions_.push_back({data_.data() + p[0], p[3] ? data_.data() + p[0] + length : nullptr, p[1], static_cast<int>(p[2]), steps.data()[i], {}, {}});
            motions_.back().screen();
        }
    }

    void run(Table<const double> numbers, Table<const std::int64_t> choices, Table<double> results, Table<std::int64_t> counts, double gravity,
             double rest_speed, double tolerance, std::int64_t most_events, int threads) const {
        const auto rows = static_cast<std::int64_t>(numbers.shape(0));
        const auto fits = [&](const auto& a, int columns) { return static_cast<std::int64_t>(a.shape(0)) == rows && static_cast<int>(a.shape(1)) == columns; };
        expect(fits(numbers, kNumbers) && fits(choices, kChoices) && fits(results, kResults) && fits(counts, kCounts) && threads > 0, "tables of histories expected");
        const double* v = numbers.data();
        const std::int64_t* c = choices.data();
        double* out = results.data();
        std::int64_t* integers = counts.data();
        const Settings set{gravity, tolerance, most_events};
        nb::gil_scoped_release release;
        std::atomic<std::int64_t> next{0};
        auto labour = [&] {
            for (std::int64_t first; (first = next.fetch_add(kChunk)) < rows;)
                for (std::int64_t row = first; row < std::min(first + kChunk, rows); ++row)
                    write(one(v + row * kNumbers, c + row * kChoices, set, rest_speed), out + row * kResults, integers + row * kCounts);
        };
        std::vector<std::thread> crew;
        for (std::int64_t k = 1; k < std::min<std::int64_t>(threads, (rows + kChunk - 1) / kChunk); ++k) crew.emplace_back(labour);
        labour();
        for (std::thread& worker : crew) worker.join();
    }

  private:
    // Order of the numbers: j, h, b of the left and the right foot, mu, e, coefficients imposed left and right, scale,
    // end, the state.
    Result one(const double* v, const std::int64_t* c, const Settings& set, double rest_speed) const {
        for (int k = 0; k < kNumbers; ++k)
            if (!(std::fabs(v[k]) <= 1e9) && k != 6 && k != 7) return {};
        const bool usable = v[0] > 0.0 && v[1] > 0.0 && v[2] > 0.0 && v[3] > 0.0 && v[4] >= 0.0 && v[5] >= 0.0 && v[5] < 1.0 && v[9] >= 0.0 &&
                            std::fabs(v[12]) < kHalfPi && c[0] >= 0 && c[0] < static_cast<std::int64_t>(motions_.size()) && c[1] >= 0 && c[1] <= 2 &&
                            c[2] >= 0 && c[2] <= 3;
        if (!usable) return {};
        const double larger = std::max(v[2], v[3]);
        Base b{v[0], v[1], {0.0, -v[2], v[3]}, std::sqrt(larger * larger + v[1] * v[1]), 0.0, 0.0, {}};
        b.pace = std::sqrt(set.gravity / b.size), b.slow = rest_speed * std::sqrt(set.gravity * b.size);
        b.alpha[kLeft] = std::atan2(v[2], v[1]), b.alpha[kRight] = std::atan2(v[3], v[1]);
        const Law law{v[4], v[5], {kNan, v[6], v[7]}, static_cast<Bounce>(c[1])};
        const Row row{v[8], v[9], {v[10], v[11], v[12], v[13], v[14], v[15], static_cast<int>(c[2])}};
        return Run(b, motions_[c[0]], law, row, set).run();
    }

    static void write(const Result& r, double* v, std::int64_t* c) {
        const double values[kResults] = {r.peak_rotation, r.peak_time, r.peak_velocity, r.overturning_time, r.first_uplift, r.sliding_distance,
                                         r.residual_displacement, r.friction_usage, r.end_time};
        const std::int64_t counts[kCounts] = {r.outcome, r.status, r.side, r.impacts, r.uplifts, r.still_rocking, r.replaced, r.shocks, r.steps};
        for (int k = 0; k < kResults; ++k) v[k] = r.status == kGood ? values[k] : kNan;
        std::copy(counts, counts + kCounts, c);
    }

    std::vector<double> data_;
    std::vector<Motion> motions_;
};

// Rows of `bodies`: alpha, p, R, mu, length of a step. push and lift: values at the start and the end of every step.
// `states`: the first state (rotation, velocity, slip) is the input.
static void slide(Table<const double> bodies, Block<const double> push, Block<const double> lift, Block<double> states, double gravity) {
    const std::size_t count = bodies.shape(1), steps = push.shape(0);
    expect(bodies.shape(0) == 5 && push.shape(1) == 2 && push.shape(2) == count && lift.shape(0) == steps && lift.shape(1) == 2 && lift.shape(2) == count &&
               states.shape(0) == 3 && states.shape(1) == steps + 1 && states.shape(2) == count,
           "tables of half cycles expected");
    const double *b = bodies.data(), *a = push.data(), *w = lift.data();
    double* out = states.data();
    const std::size_t rows = (steps + 1) * count;
    nb::gil_scoped_release release;
    for (std::size_t k = 0; k < count; ++k) {
        const SlidingFoot foot(b[k], b[count + k], b[2 * count + k], b[3 * count + k], gravity);
        Tilted s{out[k], out[rows + k], out[2 * rows + k]};
        double direction = 0.0;
        for (std::size_t n = 0; n < steps; ++n) {
            const std::size_t at = 2 * n * count + k, next = (n + 1) * count + k;
            s = foot.step(s, b[4 * count + k], {a[at], a[at + count]}, {w[at], w[at + count]}, direction);
            out[next] = s.rotation, out[rows + next] = s.velocity, out[2 * rows + next] = s.slip;
        }
    }
}

}  // namespace rocking::contact

NB_MODULE(_contact, m) {
    using namespace rocking::contact;
    m.doc() = "Many histories of plane bodies that slide, hop and fly.";
    nb::class_<Library>(m, "Library")
        .def(nb::init<Line<const double>, Table<const std::int64_t>, Line<const double>>(), "data"_a, "places"_a, "steps"_a)
        .def("run", &Library::run, "numbers"_a, "choices"_a, "results"_a, "counts"_a, "gravity"_a, "rest_speed"_a, "tolerance"_a, "most_events"_a,
             "threads"_a);
    m.def("slide", &slide, "bodies"_a, "push"_a, "lift"_a, "states"_a, "gravity"_a);
}
