// Interface to Python: one impact with its history, or many impacts with their results. Threads take independent rows.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <atomic>
#include <stdexcept>
#include <thread>

#include "run.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace rocking::bed {

template <class T>
using Line = nb::ndarray<T, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
template <class T>
using Table = nb::ndarray<T, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

constexpr std::size_t kNumbers = 23, kChoices = 9, kResults = 21, kCounts = 6;

struct Tables {
    const double *at, *height, *share, *numbers;
    const std::int64_t* choices;
    std::int64_t rows, points;
};

static void read(const Tables& t, std::int64_t row, Problem& p, Start& s) {
    const double* v = t.numbers + row * kNumbers;
    const std::int64_t* c = t.choices + row * kChoices;
    p.mass = v[0], p.inertia = v[1], p.height = v[2], p.gravity = v[3], p.push = v[4];
    p.stiffness = v[5], p.damping = v[6], p.exponent = v[7], p.viscosity = v[8], p.rebound = v[9], p.friction = v[10], p.creep = v[11];
    s.state = {v[12], v[13], v[14], v[15], v[16]};
    s.tolerance = v[17], s.depth = v[18], s.speed = v[19], s.half_base = v[20], s.longest = v[21], s.farthest = v[22];
    p.law = static_cast<Law>(c[0]);
    p.kind = static_cast<Friction>(c[1]);
    p.exact = c[2] != 0;
    s.end = static_cast<int>(c[3]);
    s.new_foot = c[4];
    s.old_foot = c[5];
    p.points = {c[7], t.at + c[6], t.height + c[6], t.share + c[6]};
    s.most_steps = c[8];
}

static void write(const Result& r, double* v, std::int64_t* c) {
    const double values[kResults] = {r.state[kY], r.state[kTheta], r.state[kU], r.state[kW], r.state[kOmega], r.time, r.travel,
                                     r.bed_loss, r.friction_loss, r.energy_start, r.energy_end, r.stored, r.residual, r.peak_force,
                                     r.deepest, r.touch, r.parting, r.impulse, r.impulse_moment, r.shear_impulse, r.slid};
    const std::int64_t counts[kCounts] = {r.status, r.steps, r.rejected, r.switches, r.contacts, r.forced};
    std::copy(values, values + kResults, v);
    std::copy(counts, counts + kCounts, c);
}

static Tables tables_of(Line<const double> at, Line<const double> height, Line<const double> share, Table<const double> numbers,
                        Table<const std::int64_t> choices) {
    const Tables t{at.data(), height.data(), share.data(), numbers.data(), choices.data(), static_cast<std::int64_t>(numbers.shape(0)),
                   static_cast<std::int64_t>(at.size())};
    if (numbers.shape(1) != kNumbers || choices.shape(1) != kChoices || choices.shape(0) != numbers.shape(0) || height.size() != at.size() ||
        share.size() != at.size())
        throw std::invalid_argument("tables of impacts of another shape expected");
    for (std::int64_t i = 0; i < t.rows; ++i) {
        const std::int64_t* c = t.choices + i * kChoices;
        if (c[6] < 0 || c[7] < 1 || c[6] + c[7] > t.points || c[0] < 0 || c[0] > 2 || c[1] < 0 || c[1] > 2 || c[3] < 0 || c[3] > 2)
            throw std::invalid_argument("a row of the table of impacts names what is not there");
    }
    return t;
}

static void run_batch(Line<const double> at, Line<const double> height, Line<const double> share, Table<const double> numbers,
                      Table<const std::int64_t> choices, Table<double> results, Table<std::int64_t> counts, int threads) {
    const Tables t = tables_of(at, height, share, numbers, choices);
    if (results.shape(0) != numbers.shape(0) || results.shape(1) != kResults || counts.shape(0) != numbers.shape(0) ||
        counts.shape(1) != kCounts || threads < 1)
        throw std::invalid_argument("room for the results expected");
    double* values = results.data();
    std::int64_t* integers = counts.data();
    nb::gil_scoped_release release;
    std::atomic<std::int64_t> next{0};
    auto labour = [&] {
        for (std::int64_t row; (row = next++) < t.rows;) {
            Problem p;
            Start s;
            read(t, row, p, s);
            write(Run(p, s, nullptr).run(), values + row * kResults, integers + row * kCounts);
        }
    };
    std::vector<std::thread> crew;
    for (int k = 1; k < threads; ++k) crew.emplace_back(labour);
    labour();
    for (std::thread& worker : crew) worker.join();
}

template <class T>
static nb::object array_of(const std::vector<T>& values, std::size_t columns) {
    T* data = new T[values.size() + 1];
    std::copy(values.begin(), values.end(), data);
    nb::capsule owner(data, [](void* p) noexcept { delete[] static_cast<T*>(p); });
    return nb::cast(nb::ndarray<nb::numpy, T, nb::ndim<2>>(data, {values.size() / columns, columns}, owner));
}

static nb::tuple run_single(Line<const double> at, Line<const double> height, Line<const double> share, Table<const double> numbers,
                            Table<const std::int64_t> choices, Table<double> results, Table<std::int64_t> counts) {
    const Tables t = tables_of(at, height, share, numbers, choices);
    if (t.rows != 1 || results.shape(0) != 1 || results.shape(1) != kResults || counts.shape(0) != 1 || counts.shape(1) != kCounts)
        throw std::invalid_argument("one row expected");
    Problem p;
    Start s;
    read(t, 0, p, s);
    Trace trace;
    write(Run(p, s, &trace).run(), results.data(), counts.data());
    std::vector<double> samples, spans;
    for (const Sample& a : trace.samples) {
        samples.insert(samples.end(), {a.time, a.travel, a.normal, a.shear, a.moment, a.bed_loss, a.friction_loss});
        samples.insert(samples.end(), a.state.begin(), a.state.end());
    }
    for (const Interval& a : trace.intervals) spans.insert(spans.end(), {static_cast<double>(a.point), a.on, a.off});
    return nb::make_tuple(array_of(samples, 12), array_of(trace.forces, static_cast<std::size_t>(p.points.count)), array_of(spans, 3));
}

}  // namespace rocking::bed

NB_MODULE(_bed, m) {
    using namespace rocking::bed;
    m.doc() = "Impacts of rigid bodies on a bed of contact points.";
    m.def("run_batch", &run_batch, "at"_a, "height"_a, "share"_a, "numbers"_a, "choices"_a, "results"_a, "counts"_a, "threads"_a);
    m.def("run_single", &run_single, "at"_a, "height"_a, "share"_a, "numbers"_a, "choices"_a, "results"_a, "counts"_a);
}
