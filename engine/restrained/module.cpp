// Interface to Python: motions are passed once, then tables of bodies, restraints and histories.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <atomic>
#include <stdexcept>
#include <thread>

#include "run.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace rocking::restrained {

template <class T>
using Line = nb::ndarray<T, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
template <class T>
using Table = nb::ndarray<T, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

// Per history: alpha, p, I, m g R, r of the right and of the left side; scale, theta, theta'. Per restraint: law (7), levers (6).
constexpr int kNumbers = 13, kRestraint = 13, kChoices = 4, kResults = 6, kCounts = 6, kOfRestraint = 8;
constexpr std::int64_t kChunk = 8;

static void expect(bool fine, const char* message) {
    if (!fine) throw std::invalid_argument(message);
}

class Library {
  public:
    // Rows of `places`: first coefficient, number of segments, number of terms, 1 if a vertical part follows.
    Library(Line<const double> data, Table<const std::int64_t> places, Line<const double> steps) : data_(data.data(), data.data() + data.size()) {
        expect(places.shape(1) == 4 && places.shape(0) == steps.size(), "tables of motions expected");
        const auto size = static_cast<std::int64_t>(data.size());
        for (std::size_t i = 0; i < steps.size(); ++i) {
            const std::int64_t *p = places.data() + 4 * i, length = p[1] * p[2];
            expect(p[0] >= 0 && p[1] >= 1 && p[2] >= 2 && p[2] <= kGround && p[0] + length * (p[3] ? 2 : 1) <= size && steps.data()[i] > 0.0,
                   "a motion names numbers that are not there");
            motions_.push_back({data_.data() + p[0], p[3] ? data_.data() + p[0] + length : nullptr, p[1], static_cast<int>(p[2]), steps.data()[i]});
        }
    }

    // Rows of `choices`: motion, number of segments, first restraint, number of restraints.
    void run(Table<const double> numbers, Table<const double> restraints, Table<const std::int64_t> choices, Table<double> results, Table<std::int64_t> counts,
             Table<double> of_restraints, double gravity, double rest_speed, double tolerance, std::int64_t most_events, bool linear, int threads) const {
        const auto rows = static_cast<std::int64_t>(numbers.shape(0));
        const auto fits = [&](const auto& a, int columns) { return static_cast<std::int64_t>(a.shape(0)) == rows && static_cast<int>(a.shape(1)) == columns; };
        expect(fits(numbers, kNumbers) && fits(choices, kChoices) && fits(results, kResults) && fits(counts, kCounts) && restraints.shape(1) == kRestraint &&
                   of_restraints.shape(1) == kOfRestraint && threads > 0,
               "tables of histories expected");
        const Settings set{gravity, rest_speed, tolerance, most_events, linear};
        const double *v = numbers.data(), *laws = restraints.data();
        const std::int64_t* c = choices.data();
        std::int64_t written = 0;
        for (std::int64_t k = 0; k < rows; ++k) check(c + k * kChoices, restraints.shape(0)), written += c[k * kChoices + 3];
        expect(written <= static_cast<std::int64_t>(of_restraints.shape(0)), "a row per restraint expected");
        double *out = results.data(), *device_out = of_restraints.data();
        std::int64_t* integers = counts.data();
        std::vector<std::int64_t> first(rows + 1, 0);
        for (std::int64_t k = 0; k < rows; ++k) first[k + 1] = first[k] + c[k * kChoices + 3];
        nb::gil_scoped_release release;
        std::atomic<std::int64_t> next{0};
        auto labour = [&] {
            for (std::int64_t from; (from = next.fetch_add(kChunk)) < rows;)
                for (std::int64_t row = from; row < std::min(from + kChunk, rows); ++row) {
                    std::vector<Device> devices = devices_of(laws, c + row * kChoices, set);
                    const Result r = followed(v + row * kNumbers, c + row * kChoices, set, devices, nullptr, nullptr);
                    write(r, out + row * kResults, integers + row * kCounts);
                    for (std::size_t i = 0; i < devices.size(); ++i) describe(devices[i], r, device_out + (first[row] + i) * kOfRestraint);
                }
        };
        std::vector<std::thread> crew;
        for (std::int64_t k = 1; k < std::min<std::int64_t>(threads, (rows + kChunk - 1) / kChunk); ++k) crew.emplace_back(labour);
        labour();
        for (std::thread& worker : crew) worker.join();
    }

    // One history with its samples; returns counts, results, events of body and restraints, peaks, states of restraints, contacts with walls.
    nb::tuple trace(Line<const double> numbers, Table<const double> restraints, Line<const std::int64_t> choices, Table<double> samples, Table<double> elongation,
                    Table<double> force, Table<double> restraint_work, double gravity, double rest_speed, double tolerance, std::int64_t most_events, bool linear) const {
        expect(numbers.size() == kNumbers && choices.size() == kChoices && restraints.shape(1) == kRestraint, "one history expected");
        const std::int64_t* c = choices.data();
        check(c, restraints.shape(0));
        const auto count = static_cast<std::size_t>(c[1]) + 1, n = static_cast<std::size_t>(c[3]);
        for (const auto* a : {&elongation, &force, &restraint_work}) expect(a->shape(0) == count && a->shape(1) == n, "a row per sample expected");
        expect(samples.shape(0) == 3 && samples.shape(1) == count, "a row per sample expected");
        const Settings set{gravity, rest_speed, tolerance, most_events, linear};
        std::vector<Device> devices = devices_of(restraints.data(), c, set);
        double* s = samples.data();
        Trace out{s, s + count, s + 2 * count, elongation.data(), force.data(), restraint_work.data(), {}, {}, {}, {}};
        std::int64_t written = 0;
        const Result r = followed(numbers.data(), c, set, devices, &out, &written);
        double values[kResults];
        std::int64_t counts[kCounts];
        write(r, values, counts);
        nb::list states, integers, floats;
        for (Device& d : devices)
            states.append(nb::make_tuple(d.law.phase.name, d.law.plastic, d.law.yields, d.law.lost, d.work, d.elongation, d.rate, d.largest_force,
                                         d.smallest_force, d.largest_elongation, d.smallest_elongation, d.start_energy));
        for (std::int64_t k : counts) integers.append(k);
        for (double k : values) floats.append(k);
        return nb::make_tuple(integers, floats, written, listed(out.body), listed(out.restraints), listed(out.peaks), states, listed(out.contacts));
    }

  private:
    void check(const std::int64_t* c, std::size_t rows) const {
        expect(c[0] >= 0 && c[0] < static_cast<std::int64_t>(motions_.size()) && c[1] >= 1 && c[2] >= 0 && c[3] >= 0 && c[3] <= kDevices &&
                   c[2] + c[3] <= static_cast<std::int64_t>(rows),
               "a history names a motion or restraints that are not there");
    }
    static nb::list listed(const std::vector<double>& values) {
        nb::list list;
        for (double v : values) list.append(v);
        return list;
    }
    static std::vector<Device> devices_of(const double* laws, const std::int64_t* c, const Settings& set) {
        std::vector<Device> devices;
        devices.reserve(c[3]);
        for (std::int64_t i = 0; i < c[3]; ++i) devices.emplace_back(laws + (c[2] + i) * kRestraint, set.linear);
        return devices;
    }
    Result followed(const double* v, const std::int64_t* c, const Settings& set, std::vector<Device>& devices, Trace* trace, std::int64_t* written) const {
        for (int k = 0; k < kNumbers; ++k)
            if (!(std::fabs(v[k]) <= 1e30)) return {};
        Body b;
        for (int k = 0; k < 2; ++k) b.sides[k] = {v[5 * k], v[5 * k + 1], v[5 * k + 2], v[5 * k + 3], v[5 * k + 4]};
        Run run(b, motions_[c[0]], v[10], c[1], set, devices, trace);
        const Result r = run.run(v[11], v[12]);
        if (written) *written = run.written;
        return r;
    }
    static void write(const Result& r, double* v, std::int64_t* c) {
        const double values[kResults] = {r.peak_rotation, r.peak_time, r.peak_velocity, r.overturning_time, r.first_uplift, r.residual_rotation};
        const std::int64_t counts[kCounts] = {r.outcome, r.status, r.side, r.impacts, r.uplifts, r.still_rocking};
        for (int k = 0; k < kResults; ++k) v[k] = r.status == kGood ? values[k] : kNan;
        std::copy(counts, counts + kCounts, c);
    }
    static void describe(Device& d, const Result& r, double* v) {
        const double values[kOfRestraint] = {d.largest_force, d.smallest_force, d.largest_elongation, d.smallest_elongation, d.law.plastic,
                                             static_cast<double>(d.law.yields), d.law.broken() ? 1.0 : 0.0, d.dissipated()};
        for (int k = 0; k < kOfRestraint; ++k) v[k] = r.status == kGood ? values[k] : kNan;
    }

    std::vector<double> data_;
    std::vector<Motion> motions_;
};

}  // namespace rocking::restrained

NB_MODULE(_restrained, m) {
    using namespace rocking::restrained;
    m.doc() = "Histories of plane bodies with tendons, dampers, fuses, springs and walls.";
    nb::class_<Library>(m, "Library")
        .def(nb::init<Line<const double>, Table<const std::int64_t>, Line<const double>>(), "data"_a, "places"_a, "steps"_a)
        .def("run", &Library::run, "numbers"_a, "restraints"_a, "choices"_a, "results"_a, "counts"_a, "of_restraints"_a, "gravity"_a, "rest_speed"_a,
             "tolerance"_a, "most_events"_a, "linear"_a, "threads"_a)
        .def("trace", &Library::trace, "numbers"_a, "restraints"_a, "choices"_a, "samples"_a, "elongation"_a, "force"_a, "restraint_work"_a, "gravity"_a,
             "rest_speed"_a, "tolerance"_a, "most_events"_a, "linear"_a);
}
