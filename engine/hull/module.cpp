// Interface to Python: bodies and motions are passed once, then tables of histories. Threads take rows in turn.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <atomic>
#include <memory>
#include <stdexcept>
#include <thread>

#include "run.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace rocking::hull {

template <class T>
using Line = nb::ndarray<T, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
template <class T>
using Table = nb::ndarray<T, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using Whole = std::int64_t;

constexpr int kNumbers = 29, kChoices = 4, kResults = 10, kCounts = 10;
constexpr Whole kChunk = 4;

static void expect(bool fine, const char* message) {
    if (!fine) throw std::invalid_argument(message);
}

static Vec vec(const double* v) { return {v[0], v[1], v[2]}; }
static Mat mat(const double* v) { return {vec(v), vec(v + 3), vec(v + 6)}; }

// Several lists of numbers in one array: index of the first number of each list, and the numbers.
static void lists(Line<const Whole> first, Line<const Whole> members, std::size_t count, std::size_t limit, List& starts, List& all) {
    expect(first.size() == count + 1 && first.data()[0] == 0 && first.data()[count] == static_cast<Whole>(members.size()), "lists of a body expected");
    for (std::size_t k = 0; k < count; ++k) expect(first.data()[k] <= first.data()[k + 1], "lists of a body expected in order");
    for (std::size_t k = 0; k < members.size(); ++k) expect(members.data()[k] >= 0 && members.data()[k] < static_cast<Whole>(limit), "a body names what is not there");
    starts.assign(first.data(), first.data() + count + 1), all.assign(members.data(), members.data() + members.size());
}

class Library {
  public:
    Library() = default;
    Library(const Library&) = delete;

    // ked, calibrated: intervals of the position k of landings on the base, for two models; empty if they are not
    // needed.
    void add_body(double mass, Table<const double> inertia, Table<const double> vertices, Table<const double> facets, Line<const Whole> poses,
                  Line<const Whole> first, Line<const Whole> beside, Line<const Whole> first_corner, Line<const Whole> corners, Table<const double> ked, Table<const double> calibrated) {
        expect(inertia.shape(0) == 3 && inertia.shape(1) == 3 && vertices.shape(1) == 3 && facets.shape(1) == 3 && vertices.shape(0) > 3 &&
                   facets.shape(0) > 3 && poses.size() == facets.shape(0) && ked.shape(1) == kInterval && calibrated.shape(1) == kInterval,
               "tables of a body expected");
        auto b = std::make_unique<Body>();
        b->mass = mass, b->inertia = mat(inertia.data());
        for (std::size_t k = 0; k < vertices.shape(0); ++k) b->points.push_back(vec(vertices.data() + 3 * k));
        for (std::size_t k = 0; k < facets.shape(0); ++k) b->facets.push_back(vec(facets.data() + 3 * k));
        b->poses.assign(poses.data(), poses.data() + poses.size());
        lists(first, beside, facets.shape(0), facets.shape(0), b->first, b->beside);
        lists(first_corner, corners, facets.shape(0), vertices.shape(0), b->first_corner, b->corners);
        for (const auto& [rows, positions] : {std::pair{&ked, &b->ked}, {&calibrated, &b->calibrated}}) {
            kept_.emplace_back(rows->data(), rows->data() + rows->size());
            *positions = {kept_.back().data(), static_cast<int>(rows->shape(0))};
        }
        b->usable = mass > 0.0;
        b->prepare();
        bodies_.push_back(std::move(b));
    }

    void add_nobody() { bodies_.push_back(std::make_unique<Body>()); }

    // rows: accelerations by segment, then by power and axis.
    void add_motion(Line<const double> times, Table<const double> rows) {
        const int powers = static_cast<int>(rows.shape(1)) / 3;
        expect(times.size() == rows.shape(0) + 1 && rows.shape(1) % 3 == 0 && powers >= 1 && powers <= kPowers, "tables of a motion expected");
        kept_.emplace_back(times.data(), times.data() + times.size());
        const double* t = kept_.back().data();
        kept_.emplace_back(rows.data(), rows.data() + rows.size());
        motions_.push_back({t, kept_.back().data(), static_cast<Whole>(rows.shape(0)), powers - 1});
    }

    void run(Table<const double> numbers, Table<const Whole> choices, Table<double> results, Table<Whole> counts, double rest_speed, double tolerance, Whole most_events, int threads) const {
        const auto rows = static_cast<Whole>(numbers.shape(0));
        const auto fits = [&](const auto& a, int columns) { return static_cast<Whole>(a.shape(0)) == rows && static_cast<int>(a.shape(1)) == columns; };
        expect(fits(numbers, kNumbers) && fits(choices, kChoices) && fits(results, kResults) && fits(counts, kCounts) && threads > 0, "tables of histories expected");
        const double* v = numbers.data();
        const Whole* c = choices.data();
        double* out = results.data();
        Whole* integers = counts.data();
        const Settings set{tolerance, rest_speed, most_events};
        nb::gil_scoped_release release;
        std::atomic<Whole> next{0};
        auto labour = [&] {
            for (Whole begin; (begin = next.fetch_add(kChunk)) < rows;)
                for (Whole row = begin; row < std::min(begin + kChunk, rows); ++row)
                    write(one(v + row * kNumbers, c + row * kChoices, set), out + row * kResults, integers + row * kCounts);
        };
        std::vector<std::thread> crew;
        for (Whole k = 1; k < std::min<Whole>(threads, (rows + kChunk - 1) / kChunk); ++k) crew.emplace_back(labour);
        labour();
        for (std::thread& worker : crew) worker.join();
    }

    // One history whose steps never pass a sample: results, nodes, impacts, contacts, and other data of a response.
    nb::tuple trace(Table<const double> numbers, Table<const Whole> choices, Table<double> results, Table<Whole> counts, double rest_speed, double tolerance, Whole most_events) const {
        expect(numbers.shape(0) == 1 && numbers.shape(1) == kNumbers && choices.shape(0) == 1 && choices.shape(1) == kChoices && results.shape(0) == 1 && results.shape(1) == kResults &&
                   counts.shape(0) == 1 && counts.shape(1) == kCounts,
               "tables of one history expected");
        auto trace = std::make_unique<Trace>();
        {
            nb::gil_scoped_release release;
            write(one(numbers.data(), choices.data(), {tolerance, rest_speed, most_events}, trace.get()), results.data(), counts.data());
        }
        return nb::make_tuple(array(trace->nodes, kNode), array(trace->impacts, kImpact), array(trace->members, 1), array(trace->stuck, 1), array(trace->struck, 1), trace->least_cosine, trace->fell);
    }

  private:
    template <class T>
    static nb::ndarray<nb::numpy, T, nb::ndim<2>> array(const std::vector<T>& values, std::size_t columns) {
        T* kept = new T[values.size() + 1];
        std::copy(values.begin(), values.end(), kept);
        nb::capsule owner(kept, [](void* p) noexcept { delete[] static_cast<T*>(p); });
        return {kept, {values.size() / columns, columns}, owner};
    }

    // Order of the numbers: coefficient or position, scale, horizon, friction, axes of the plane, half sizes of the
    // shelf, attitude, position, velocity, spin, gravity. Order of the choices: body, motion, law, initial facet.
    Result one(const double* v, const Whole* c, const Settings& set, Trace* trace = nullptr) const {
        for (int k = 0; k < kNumbers; ++k)
            if (!(std::fabs(v[k]) <= 1e9) && !(v[k] == kInfinite && (k == 3 || k == 13 || k == 14))) return {};
        const auto there = [](Whole k, const auto& all) { return k >= 0 && k < static_cast<Whole>(all.size()); };
        if (!there(c[0], bodies_) || !there(c[1], motions_) || !bodies_[c[0]]->usable || !(v[3] >= 0.0 && v[13] > 0.0 && v[14] > 0.0 && v[28] > 0.0)) return {};
        const Body& b = *bodies_[c[0]];
        if (!(c[2] == kHousner || ((c[2] == kCoefficient || c[2] == kPosition) && v[0] >= 0.0 && v[0] <= 1.0) || (c[2] == kKed && b.ked.intervals > 0) || (c[2] == kCalibrated && b.calibrated.intervals > 0))) return {};
        if (c[3] < 0 || c[3] >= static_cast<Whole>(b.facets.size())) return {};
        Ground g;
        g.motion = &motions_[c[1]], g.scale = v[1], g.gravity = v[28], g.level = mat(v + 4), g.shelf[0] = v[13], g.shelf[1] = v[14];
        g.weight = g.level * Vec{0.0, 0.0, -g.gravity};
        State s{vec(v + 19), {v[15], v[16], v[17], v[18]}, vec(v + 22), vec(v + 25)};
        const double length = s.q[0] * s.q[0] + s.q[1] * s.q[1] + s.q[2] * s.q[2] + s.q[3] * s.q[3];
        if (!(std::fabs(length - 1.0) < 1e-9)) return {};
        return Run(b, g, {static_cast<int>(c[2]), 0, v[0]}, v[3], set, trace).run(s, v[2], static_cast<int>(c[3]));
    }

    static void write(const Result& r, double* v, Whole* c) {
        const double values[kResults] = {r.peak_tilt, r.peak_time, r.peak_spin, r.overturning_time, r.direction, r.first_uplift, r.sliding, r.residual, r.end, r.lost};
        const Whole counts[kCounts] = {r.outcome, r.status, r.pose, r.impacts, r.uplifts, r.events, r.steps, r.held, r.replaced, r.still_rocking};
        for (int k = 0; k < kResults; ++k) v[k] = r.status == kGood ? values[k] : kNan;
        std::copy(counts, counts + kCounts, c);
    }

    std::vector<std::unique_ptr<Body>> bodies_;
    std::vector<Motion> motions_;
    std::vector<std::vector<double>> kept_;
};

}  // namespace rocking::hull

NB_MODULE(_hull, m) {
    using namespace rocking::hull;
    m.doc() = "Many histories of bodies on the vertices of their hull.";
    nb::class_<Library>(m, "Library")
        .def(nb::init<>())
        .def("add_body", &Library::add_body, "mass"_a, "inertia"_a, "vertices"_a, "facets"_a, "poses"_a, "first"_a, "beside"_a, "first_corner"_a,
             "corners"_a, "ked"_a, "calibrated"_a)
        .def("add_nobody", &Library::add_nobody)
        .def("add_motion", &Library::add_motion, "times"_a, "rows"_a)
        .def("run", &Library::run, "numbers"_a, "choices"_a, "results"_a, "counts"_a, "rest_speed"_a, "tolerance"_a, "most_events"_a,
             "threads"_a)
        .def("trace", &Library::trace, "numbers"_a, "choices"_a, "results"_a, "counts"_a, "rest_speed"_a, "tolerance"_a, "most_events"_a);
}
