// Interface to Python: arrays as input and output. Threads compute chunks of rows without the interpreter lock.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <atomic>
#include <deque>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "ranges.hpp"
#include "table.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace rocking {

template <class T>
using In = nb::ndarray<const T, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
template <class T>
using Out = nb::ndarray<T, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

static std::vector<std::string> instruction_sets() {
    std::vector<std::string> names;
#if defined(ROCKING_X86)
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
        names.push_back("avx512");
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) names.push_back("avx2");
#endif
    names.push_back("plain");
    return names;
}

static Run kernel(const std::string& isa, bool single, const Choice& choice) {
    const auto supported = instruction_sets();
    if (std::find(supported.begin(), supported.end(), isa) == supported.end())
        throw std::invalid_argument("this processor has no " + isa);
    Run run = nullptr;
#if defined(ROCKING_X86)
    if (isa == "avx512") run = avx512::kernel_for(single, choice);
    if (isa == "avx2") run = avx2::kernel_for(single, choice);
#endif
    if (isa == "plain") run = plain::kernel_for(single, choice);
    if (!run) throw std::invalid_argument("no kernel for this order, degree and model");
    return run;
}

// The motions of a campaign, prepared once.
struct Library {
    Motions motions;
    In<double> keep;

    Library(In<double> data, int degree, bool vertical, In<std::int64_t> first, In<std::int64_t> segments,
            In<std::int64_t> still, In<double> step)
        : keep(data) {
        if (degree != 1 && degree != 7) throw std::invalid_argument("degree must be 1 or 7");
        if (degree == 7 && vertical) throw std::invalid_argument("a smooth motion has no vertical part");
        if (first.size() != segments.size() || first.size() != still.size() || first.size() != step.size())
            throw std::invalid_argument("first, segments, still and step must be of one length");
        motions.data = data.data();
        motions.degree = degree;
        motions.vertical_part = vertical;
        if (data.size() >= (std::size_t(1) << 31)) throw std::invalid_argument("more than 2^31 numbers in one library");
        const auto size = static_cast<std::int64_t>(data.size());
        const int hop = motions.stride(), extra = degree == 1 ? hop : 0;
        for (std::size_t k = 0; k < first.size(); ++k) {
            const Shake shake{first(k), segments(k), still(k), step(k), 0, {0.0, 0.0}, {0.0, 0.0}};
            const std::int64_t jump = shake.still > 0 ? 1 : 0;
            if (shake.first < 0 || shake.segments < 1 || shake.segments > size || shake.still < 0 || shake.still > size ||
                (degree > 1 && jump) || !(shake.step > 0.0) ||
                shake.first + (shake.segments + jump + shake.still) * hop + extra > size)
                throw std::invalid_argument("a motion lies outside the data");
            motions.shakes.push_back(shake);
        }
        motions.find_ranges();
    }
};

static Law law_of(int kind, In<double> at, In<double> value, std::uint64_t seed) {
    Law law;
    law.kind = static_cast<LawKind>(kind);
    law.at.assign(at.data(), at.data() + at.size());
    law.seed = seed;
    if (law.kind == LawKind::constant) return law;
    // one table for both sides, or two tables: left, then right
    const std::size_t size = law.at.size(), left = value.size() == 2 * size ? size : 0;
    if (size == 0 || value.size() != left + size) throw std::invalid_argument("a law needs a table");
    for (int side = 0; side < 2; ++side) {
        const double* first = value.data() + (side ? left : 0);
        law.value[side].assign(first, first + size);
        law.largest[side] = *std::max_element(first, first + size);
    }
    return law;
}

// Converts a dictionary of arrays to rows. The lengths are checked here, the values in the kernel.
static Rows rows_of(const nb::dict& in, const nb::dict& out) {
    Rows rows{};
    rows.count = -1;
    auto same = [&](std::size_t n) {
        if (rows.count >= 0 && static_cast<std::size_t>(rows.count) != n) throw std::invalid_argument("rows of unequal length");
        rows.count = static_cast<std::int64_t>(n);
    };
    auto number = [&](const char* name) {
        auto a = nb::cast<In<double>>(in[name]);
        same(a.size());
        return a.data();
    };
    auto index = [&](const char* name) {
        auto a = nb::cast<In<std::int64_t>>(in[name]);
        same(a.size());
        return a.data();
    };
    rows.alpha_right = number("alpha_right");
    rows.alpha_left = number("alpha_left");
    rows.p_right = number("p_right");
    rows.p_left = number("p_left");
    rows.r_right = number("r_right");
    rows.r_left = number("r_left");
    rows.q_right = number("q_right");
    rows.q_left = number("q_left");
    rows.share[0] = number("share_right");
    rows.share[1] = number("share_left");
    rows.scale = number("scale");
    rows.rotation = number("rotation");
    rows.velocity = number("velocity");
    rows.motion = index("motion");
    rows.key = index("key");
    auto small = [&](const char* name) {
        auto a = nb::cast<Out<std::int8_t>>(out[name]);
        same(a.size());
        return a.data();
    };
    auto real = [&](const char* name) {
        auto a = nb::cast<Out<double>>(out[name]);
        same(a.size());
        return a.data();
    };
    auto count = [&](const char* name) {
        auto a = nb::cast<Out<std::int64_t>>(out[name]);
        same(a.size());
        return a.data();
    };
    rows.outcome = small("outcome");
    rows.status = small("status");
    rows.side = small("side");
    rows.still = small("still_rocking");
    rows.peak = real("peak_rotation");
    rows.peak_time = real("peak_time");
    rows.peak_velocity = real("peak_velocity");
    rows.overturning_time = real("overturning_time");
    rows.first_uplift = real("first_uplift");
    rows.error = real("truncation");
    rows.least_force = real("least_force");
    rows.friction = real("friction_demand");
    rows.impacts = count("impacts");
    rows.uplifts = count("uplifts");
    return rows;
}

static Settings settings_of(double gravity, double longest_step, double rest_speed, std::int64_t most_impacts, bool linear, int order, bool ground) {
    if (!(gravity > 0.0) || !(longest_step > 0.0) || !(rest_speed >= 0.0) || most_impacts < 1)
        throw std::invalid_argument("settings must be positive");
    return {gravity, longest_step, rest_speed, most_impacts, linear, order, ground};
}

// Rows for one kernel, in the order of computation.
struct Share {
    Run run;
    std::vector<std::int64_t> list;
    Queue queue;

    Share(Run run_, std::vector<std::int64_t> list_, std::int64_t chunk, int threads)
        : run(run_), list(std::move(list_)), queue{static_cast<std::int64_t>(list.size()), chunk, threads} {}
};

// Short rows are last in the queue. Therefore lanes are idle for less time at the end.
static void short_ones_last(std::vector<std::int64_t>& list, const Motions& m, const Rows& rows, int threads) {
    const auto length = [&](std::int64_t row) {
        const std::int64_t motion = rows.motion[row];
        return motion < 0 || motion >= static_cast<std::int64_t>(m.shakes.size()) ? 0 : m.shakes[motion].segments;
    };
    const auto tail = std::min<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(list.size()), std::ptrdiff_t{512} * threads);
    std::stable_sort(list.end() - tail, list.end(), [&](auto a, auto b) { return length(a) > length(b); });
}

// Computes all chunks with all threads, without waiting between chunks.
static void share_out(std::deque<Share>& shares, const Motions& m, const Law& law, const Rows& all, const Settings& set,
                      int threads, Work& total) {
    std::mutex one_at_a_time;
    auto labour = [&] {
        for (Share& share : shares) {
            Rows rows = all;
            rows.list = share.list.data();
            rows.count = static_cast<std::int64_t>(share.list.size());
            const Work work = share.run(m, law, rows, set, nullptr, share.queue);
            const std::lock_guard<std::mutex> guard(one_at_a_time);
            total.steps += work.steps;
            total.sweeps += work.sweeps;
            total.events += work.events;
            total.orders += work.orders;
        }
    };
    std::vector<std::thread> crew;
    for (int k = 1; k < threads; ++k) crew.emplace_back(labour);
    labour();
    for (std::thread& worker : crew) worker.join();
}

static nb::dict run_batch(const Library& library, const nb::dict& in, const nb::dict& out, int kind, In<double> at, In<double> value,
                          std::uint64_t seed, double gravity, double longest_step, double rest_speed, std::int64_t most_impacts,
                          bool linear, int order, int threads, std::int64_t chunk, const std::string& isa) {
    const Rows rows = rows_of(in, out);
    const Law law = law_of(kind, at, value, seed);
    const Settings set = settings_of(gravity, longest_step, rest_speed, most_impacts, linear, order, false);
    const Motions& m = library.motions;
    if (order != 8 && m.vertical_part) throw std::invalid_argument("no kernel for this order, degree and model");
    const Run run = kernel(isa, false, {order, m.degree, m.vertical_part, linear});
    if (chunk < 1 || threads < 1) throw std::invalid_argument("threads and chunk must be at least 1");
    Work total;
    {
        nb::gil_scoped_release release;
        std::vector<std::int64_t> near_samples, others;
        const double reach = reach_of_order_six(set.longest_step);
        for (std::int64_t row = 0; row < rows.count; ++row)
            (takes_order_six(m, rows, row, set, reach) ? near_samples : others).push_back(row);
        short_ones_last(near_samples, m, rows, threads);
        short_ones_last(others, m, rows, threads);
        std::deque<Share> shares;
        if (!near_samples.empty())
            shares.emplace_back(kernel(isa, false, {6, 1, m.vertical_part, false}), std::move(near_samples), chunk, threads);
        if (!others.empty()) shares.emplace_back(run, std::move(others), chunk, threads);
        share_out(shares, m, law, rows, set, threads, total);
    }
    nb::dict work;
    work["steps"] = total.steps;
    work["sweeps"] = total.sweeps;
    work["events"] = total.events;
    work["orders"] = total.orders;
    return work;
}

static nb::list run_single(const Library& library, const nb::dict& in, const nb::dict& out, int kind, In<double> at, In<double> value,
                           std::uint64_t seed, double gravity, double longest_step, double rest_speed, std::int64_t most_impacts,
                           bool linear, bool to_the_ground, Out<double> rotation, Out<double> velocity, const std::string& isa) {
    const Rows rows = rows_of(in, out);
    const Law law = law_of(kind, at, value, seed);
    const Settings set = settings_of(gravity, longest_step, rest_speed, most_impacts, linear, 8, to_the_ground);
    const Motions& m = library.motions;
    if (rows.count != 1 || rows.motion[0] < 0 || rows.motion[0] >= static_cast<std::int64_t>(m.shakes.size()))
        throw std::invalid_argument("one row of a known motion expected");
    const Shake& shake = m.shakes[rows.motion[0]];
    const auto need = static_cast<std::size_t>(shake.segments + shake.still + 1);
    if (rotation.size() != need || velocity.size() != need) throw std::invalid_argument("room for the samples expected");
    Trace trace{rotation.data(), velocity.data(), {}};
    trace.rotation[0] = rows.rotation[0];
    trace.velocity[0] = rows.velocity[0];
    Queue queue{1, 1, 1};
    const int order = takes_order_six(m, rows, 0, set, reach_of_order_six(set.longest_step)) ? 6 : 8;
    kernel(isa, true, {order, m.degree, m.vertical_part, linear})(m, law, rows, set, &trace, queue);
    nb::list events;
    for (const Event& e : trace.events)
        events.append(nb::make_tuple(e.time, static_cast<int>(e.kind), static_cast<int>(e.side), e.before, e.after, e.coefficient));
    return events;
}

}  // namespace rocking

NB_MODULE(_engine, m) {
    // a study that exists until Python ends keeps its prepared motions; this is not a leak
    nb::set_leak_warnings(false);
    using namespace rocking;
    m.doc() = "Taylor steps of many rocking histories side by side.";
    nb::class_<Library>(m, "Library")
        .def(nb::init<In<double>, int, bool, In<std::int64_t>, In<std::int64_t>, In<std::int64_t>, In<double>>(), "data"_a, "degree"_a,
             "vertical"_a, "first"_a, "segments"_a, "still"_a, "step"_a);
    m.def("instruction_sets", &instruction_sets);
    m.def("run_batch", &run_batch, "library"_a, "rows"_a, "results"_a, "kind"_a, "at"_a, "value"_a, "seed"_a, "gravity"_a,
          "longest_step"_a, "rest"_a, "most_impacts"_a, "linear"_a, "order"_a, "threads"_a, "chunk"_a, "isa"_a);
    m.def("run_single", &run_single, "library"_a, "rows"_a, "results"_a, "kind"_a, "at"_a, "value"_a, "seed"_a, "gravity"_a,
          "longest_step"_a, "rest"_a, "most_impacts"_a, "linear"_a, "to_the_ground"_a, "rotation"_a, "velocity"_a, "isa"_a);
}
