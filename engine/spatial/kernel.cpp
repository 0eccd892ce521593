// Histories of a table, row by row. Compiled once for each instruction set; ROCKING_ISA is the name of the set.
#include "run.hpp"
#include "table.hpp"

namespace rocking::spatial {
namespace ROCKING_ISA {

class Kernel final : public Engine {
public:
    explicit Kernel(const Numbers& n) : degree_(n.degree) {
        times_.assign(n.times, n.times + n.time_count);
        data_.assign(n.accelerations, n.accelerations + n.acceleration_count);
        positions_.assign(n.positions, n.positions + n.position_count * kPosition);
        if (n.kept) kept_.assign(n.kept, n.kept + 2 * n.vertex_count * kKept);
        for (std::int64_t i = 0; i < n.motion_count; ++i)
            motions_.push_back({times_.data() + n.places[3 * i], data_.data() + n.places[3 * i + 1], n.places[3 * i + 2]});
        bodies_.resize(n.body_count);
        for (std::int64_t i = 0; i < n.body_count; ++i) read(n, i, bodies_[i]);
    }

    void run(const Rows& rows, std::int64_t at, const Limits& l, std::vector<double>* trace) const override {
        const double* v = rows.numbers + at * kRowNumbers;
        const std::int64_t* c = rows.choices + at * kRowChoices;
        Row row;
        row.body = c[0], row.motion = c[1], row.law = c[2];
        row.coefficient = v[0], row.scale = v[1], row.horizon = v[2];
        std::copy(v + 3, v + 7, row.attitude);
        row.velocity = {v[7], v[8], v[9]};
        std::vector<Sample> samples;
        Result r;
        if (usable(row, v)) r = history(row, {l.gravity, l.rest_speed, l.tolerance, l.longest, l.most_events}, trace ? &samples : nullptr);
        write(r, rows.results + at * kResults, rows.counts + at * kCounts);
        for (const Sample& s : samples)
            for (const double x : {s.time, static_cast<double>(s.kind), static_cast<double>(s.contact), static_cast<double>(s.number), s.before,
                                   s.after, s.x.x, s.x.y, s.x.z, s.y.x, s.y.y, s.y.z, s.z.x, s.z.y, s.z.z, s.velocity.x, s.velocity.y, s.velocity.z})
                trace->push_back(x);
    }

private:
    void read(const Numbers& n, std::int64_t i, Body& b) const {
        const double* v = n.bodies + i * kBodyNumbers;
        b.mass = v[0], b.p = v[1], b.size = v[2], b.lift = v[3], b.radius = v[4];
        b.centre = {v[5], v[6], v[7]};
        b.inertia = {{v[8], v[9], v[10]}, {v[11], v[12], v[13]}, {v[14], v[15], v[16]}};
        const std::int64_t *corners = n.corners + i * kBodyPlaces, first = corners[0], count = corners[1];
        b.ked = {positions_.data() + corners[2] * kPosition, static_cast<int>(corners[3])};
        b.calibrated = {positions_.data() + corners[4] * kPosition, static_cast<int>(corners[5])};
        b.usable = true;
        for (int k = 0; k < kBodyNumbers; ++k) b.usable &= std::isfinite(v[k]);
        for (std::int64_t k = 0; k < 2 * count; ++k) b.usable &= std::isfinite(n.vertices[2 * first + k]);
        b.round = count == 0;
        b.usable &= b.mass > 0.0 && b.p > 0.0 && b.size > 0.0 && b.lift > 0.0 && (!b.round || b.radius > 0.0);
        if (!b.usable) return;
        b.count = static_cast<int>(count);
        for (std::int64_t k = first; k < first + count; ++k) b.vertices.push_back({n.vertices[2 * k], n.vertices[2 * k + 1], 0.0});
        prepare(b, kept_.empty() ? nullptr : kept_.data() + 2 * first * kKept);
    }

    bool usable(const Row& row, const double* v) const {
        for (int k = 0; k < kRowNumbers; ++k)
            if (!(std::fabs(v[k]) <= 1e9)) return false;
        double size = 0.0;
        for (int k = 0; k < 4; ++k) size += row.attitude[k] * row.attitude[k];
        const auto count = [](const auto& all) { return static_cast<std::int64_t>(all.size()); };
        if (row.body < 0 || row.body >= count(bodies_) || row.motion < 0 || row.motion >= count(motions_)) return false;
        const Body& body = bodies_[row.body];
        if (row.law < kHousner || row.law > kCalibrated || (row.law == kKed && body.ked.intervals == 0) || (row.law == kCalibrated && body.calibrated.intervals == 0)) return false;
        if (row.law == kKedPoint && (kept_.empty() || body.round || !std::isfinite(body.vertex[0].kept[0]))) return false;
        const Vec w = row.velocity;
        const double* q = row.attitude;
        const bool upright = q[0] * q[0] + q[3] * q[3] > q[1] * q[1] + q[2] * q[2];
        return body.usable && size > 1e-3 && upright &&
               row.coefficient >= 0.0 && row.coefficient <= 1.0 && norm(w) <= 1e4 * body.p && row.horizon >= 0.0;
    }

    Result history(const Row& row, const Settings& settings, std::vector<Sample>* trace) const {
        const Orders orders(settings.tolerance);
        const Body& body = bodies_[row.body];
        const Motion& motion = motions_[row.motion];
        if (degree_ == 1) return Run<1>(body, motion, row, settings, orders, trace).run();
        return Run<7>(body, motion, row, settings, orders, trace).run();
    }

    static void write(const Result& r, double* v, std::int64_t* c) {
        const double values[kResults] = {r.peak_tilt, r.peak_time, r.peak_spin, r.overturning_time, r.direction,
                                         r.first_uplift, r.end_time, r.held, r.lost};
        const std::int64_t counts[kCounts] = {r.outcome, r.status, r.over_contact, r.over_number, r.impacts, r.uplifts, r.events, r.steps, r.still_rocking};
        std::copy(values, values + kResults, v);
        std::copy(counts, counts + kCounts, c);
    }

    int degree_;
    std::vector<double> times_, data_, kept_, positions_;
    std::vector<Motion> motions_;
    std::vector<Body> bodies_;
};

std::unique_ptr<Engine> engine_of(const Numbers& numbers) { return std::make_unique<Kernel>(numbers); }

}  // namespace ROCKING_ISA
}  // namespace rocking::spatial
