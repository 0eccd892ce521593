// Interface to Python: one history of a stack, with its samples.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <stdexcept>

#include "run.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace rocking::stack {

template <class T>
using Table = nb::ndarray<T, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

// Columns. Bodies: mass, inertia, corners of base and top from the centre (left, right, height of base; left, right, height of top),
// position, velocity, rotation, angular velocity. Joints: friction, restitution, slow speed, width, offset, weight above.
constexpr std::size_t kBody = 14, kJoint = 6, kOfJoint = 7, kOfBody = 5, kTotals = 4;

static void expect(bool fine, const char* message) {
    if (!fine) throw std::invalid_argument(message);
}

static Run run_of(const double* b, const double* j, std::size_t n, const Settings& set) {
    Run run(set);
    run.bodies.push_back({0.0, 0.0, 0.0, 0.0, 0.0, -kFar, kFar, 0.0});
    run.at.push_back({}), run.moves.push_back({}), run.mass.push_back(0.0), run.inertia.push_back(0.0);
    run.size = kFar;
    for (std::size_t k = 0; k < n; ++k, b += kBody, j += kJoint) {
        run.bodies.push_back({1.0 / b[0], 1.0 / b[1], b[2], b[3], b[4], b[5], b[6], b[7]});
        run.mass.push_back(b[0]), run.inertia.push_back(b[1]);
        run.at.push_back({{b[8], b[9]}, b[12]}), run.moves.push_back({{b[10], b[11]}, b[13]});
        run.laws.push_back({j[0], j[1], j[2], j[3], j[4]}), run.weight_above.push_back(j[5]);
        run.size = std::min(run.size, std::sqrt(b[2] * b[2] + b[4] * b[4]));
    }
    run.begin();
    return run;
}

static void sample(const Run& run, double time, double* row) {
    const std::size_t n = run.laws.size();
    row[0] = time;
    for (std::size_t k = 0; k < n; ++k) {
        const double values[kOfBody] = {run.at[k + 1].angle, run.moves[k + 1].spin, run.at[k + 1].at.x, run.at[k + 1].at.z, run.extremes[k].displacement};
        for (std::size_t i = 0; i < kOfBody; ++i) row[1 + i * n + k] = values[i];
    }
    const double totals[kTotals] = {run.work, run.kinetic(), run.potential(), run.lost};
    std::copy(totals, totals + kTotals, row + 1 + kOfBody * n);
}

static double polynomial(const double* c, std::size_t terms, double tau) {
    double value = 0.0;
    for (std::size_t i = terms; i-- > 0;) value = value * tau + c[i];
    return value;
}

static nb::tuple trace(Table<const double> bodies, Table<const double> joints, Table<const double> horizontal, Table<const double> vertical,
                       Table<double> samples, Table<double> of_joints, double step, double scale, double gravity, double tolerance, std::int64_t most_events,
                       std::int64_t steps, std::int64_t quiet, bool free) {
    const std::size_t n = bodies.shape(0), count = horizontal.shape(0), terms = horizontal.shape(1);
    expect(n >= 1 && bodies.shape(1) == kBody && joints.shape(0) == n && joints.shape(1) == kJoint && of_joints.shape(0) == n && of_joints.shape(1) == kOfJoint,
           "tables of bodies and joints expected");
    const std::size_t width = 1 + kOfBody * n + kTotals, up = vertical.shape(0) ? vertical.shape(1) : 0;
    expect(samples.shape(0) == count + 1 && samples.shape(1) == width && (!up || vertical.shape(0) == count) && steps >= 1 && step > 0.0,
           "a row per sample expected");
    Run run = run_of(bodies.data(), joints.data(), n, {gravity, tolerance, most_events});
    const double *x = horizontal.data(), *z = vertical.data(), h = step / static_cast<double>(steps);
    double* rows = samples.data();
    std::size_t written = 1;
    {
        nb::gil_scoped_release release;
        sample(run, 0.0, rows);
        for (std::size_t k = 0; k < count && run.status == kGood && run.fallen < 0; ++k) {
            for (std::int64_t i = 0; i < steps && run.status == kGood && run.fallen < 0; ++i) {
                const double tau = static_cast<double>(i) / static_cast<double>(steps);
                const Vector ground{scale * polynomial(x + k * terms, terms, tau), up ? scale * polynomial(z + k * up, up, tau) : 0.0};
                run.step((static_cast<double>(k) + tau) * step, h, k == 0 && i == 0 ? 0.5 * h : h, ground);
            }
            sample(run, static_cast<double>(k + 1) * step, rows + written * width);
            ++written;
            if (free && static_cast<std::int64_t>(k) >= quiet && run.still()) break;
        }
        run.finish();
    }
    double* out = of_joints.data();
    for (std::size_t k = 0; k < n; ++k) {
        const Extremes& e = run.extremes[k];
        const double values[kOfJoint] = {e.opening, e.slip, e.normal, e.ratio, e.slip_time, e.gap, e.flight_time};
        std::copy(values, values + kOfJoint, out + k * kOfJoint);
    }
    nb::list events;
    for (double value : run.events) events.append(value);
    const nb::tuple quality = nb::make_tuple(run.solver.unsolved, -run.deepest / run.size, run.gained);
    return nb::make_tuple(written, run.outcome, run.status, run.fallen, run.overturning_time, !run.still(), events, quality);
}

}  // namespace rocking::stack

NB_MODULE(_stack, m) {
    using namespace rocking::stack;
    m.doc() = "Histories of plane bodies on each other.";
    m.def("trace", &trace, "bodies"_a, "joints"_a, "horizontal"_a, "vertical"_a, "samples"_a, "of_joints"_a, "step"_a, "scale"_a, "gravity"_a, "tolerance"_a,
          "most_events"_a, "steps"_a, "quiet"_a, "free"_a);
}
