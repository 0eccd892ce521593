// Rows into lanes, and results out of them.
#pragma once
#include "kernel.hpp"

namespace rocking {
namespace ROCKING_ISA {

ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::finish(int i, Outcome outcome, Status status) {
    Lane& lane = lanes[i];
    const std::int64_t row = lane.row;
    if (status == kGood && !(err[i] <= kMostError)) {
        outcome = kFailed;
        status = kNotResolved;
    }
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const bool good = status == kGood, down = outcome == kOverturned;
    rows.outcome[row] = outcome;
    rows.status[row] = status;
    rows.side[row] = outcome == kOverturned ? static_cast<std::int8_t>(lane.side) : 0;
    rows.peak[row] = down ? lane.side * kHalfPi : good ? lane.peak_signed : nan;  // it lies at a quarter turn
    rows.peak_time[row] = down ? lane.over_time : good ? lane.peak_time : nan;
    rows.peak_velocity[row] = good ? fastest[i] / lane.step : nan;
    rows.overturning_time[row] = outcome == kOverturned ? lane.over_time : nan;
    rows.first_uplift[row] = lane.first_uplift;
    rows.error[row] = good ? err[i] : nan;
    rows.impacts[row] = lane.impacts;
    rows.uplifts[row] = lane.uplifts;
    --active;
    --busy[i / (U * P)];
    idle(i);
}

ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::idle(int i) {
    lanes[i].row = -1;
    u[i] = 0.0;
    v[i] = tau[i] = kappa[i] = ca[i] = cz[i] = idx[i] = stride[i] = err[i] = fastest[i] = gate[i] = 0.0;
    len[i] = sub[i] = alpha[i] = peak[i] = 1.0;
    last[i] = std::numeric_limits<double>::infinity();
}

ROCKING_KERNEL
bool Kernel<G, U, N, D, Z, L>::valid(const Rows& r, std::int64_t k, std::size_t motions) {
    for (const double* angle : {r.alpha_right, r.alpha_left})
        if (!(angle[k] > 0.0 && angle[k] < kHalfPi)) return false;
    for (const double* p : {r.p_right, r.p_left})
        if (!(p[k] > 1e-9 && p[k] < 1e9)) return false;
    for (const double* e : {r.r_right, r.r_left})
        if (!(e[k] >= 0.0 && e[k] <= 100.0)) return false;
    return std::fabs(r.scale[k]) <= 1e9 && std::fabs(r.rotation[k]) < kHalfPi && std::fabs(r.velocity[k]) < 1e9 &&
           r.motion[k] >= 0 && r.motion[k] < static_cast<std::int64_t>(motions);
}

// Take rows from the queue until one needs steps.
ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::fill(int i) {
    idle(i);
    while (lanes[i].row < 0) {
        if (next == end && !queue.take(next, end)) return;
        const std::int64_t row = next++;
        if (valid(rows, row, motions.shakes.size())) start(i, row);
        else write_invalid(row);
    }
}

ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::write_invalid(std::int64_t row) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    rows.outcome[row] = kFailed;
    rows.status[row] = kInvalid;
    rows.side[row] = 0;
    rows.peak[row] = rows.peak_time[row] = rows.peak_velocity[row] = nan;
    rows.overturning_time[row] = rows.first_uplift[row] = rows.error[row] = nan;
    rows.impacts[row] = rows.uplifts[row] = 0;
}

// Into how many parts a stretch is cut: a ground that shakes with many g moves the body faster than gravity does.
ROCKING_KERNEL
double Kernel<G, U, N, D, Z, L>::parts_of_step(const Lane& lane, double p) const {
    const Bounds& b = motions.bounds[lane.shake->block];
    const double push = std::fabs(lane.ax) * std::max(b.later_high, -b.later_low);
    const double lift = std::fabs(lane.az) * std::max(b.later_vertical_high, -b.later_vertical_low);
    return std::max(1.0, std::ceil(p * lane.step * std::sqrt(std::max(1.0, 0.5 * (push + lift))) / set.longest_step));
}

ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::start(int i, std::int64_t row) {
    Lane& lane = lanes[i];
    ++active;
    ++busy[i / (U * P)];
    lane = Lane();
    lane.row = row;
    lane.peak_signed = lane.peak_time = 0.0;
    lane.over_time = lane.first_uplift = std::numeric_limits<double>::quiet_NaN();
    const Shake& shake = motions.shakes[rows.motion[row]];
    lane.shake = &shake;
    lane.sides[0] = side_of(rows.alpha_right[row], rows.p_right[row], rows.r_right[row]);
    lane.sides[1] = side_of(rows.alpha_left[row], rows.p_left[row], rows.r_left[row]);
    lane.step = shake.step;
    lane.ax = lane.az = rows.scale[row] / set.gravity;
    lane.first = static_cast<double>(shake.first);
    idx[i] = lane.first;
    stride[i] = motions.stride();
    last[i] = lane.first + static_cast<double>(shake.segments) * motions.stride();
    lane.still = shake.still;
    cz[i] = lane.az;
    const double parts = parts_of_step(lane, std::max(rows.p_right[row], rows.p_left[row]));
    sub[i] = 1.0 / parts;
    tau[i] = 0.0;
    len[i] = sub[i];
    if (!(parts * static_cast<double>(shake.segments + shake.still) <= kMostSteps)) return finish(i, kFailed, kNotResolved);
    const double angle = rows.rotation[row], speed = rows.velocity[row];
    const Side& turned = lane.sides[angle > 0.0 ? 0 : 1];
    if (turned.alpha - std::fabs(angle) == turned.alpha && std::fabs(speed) <= kNothing * turned.p * turned.alpha) {
        peak[i] = 0.0;
        return rest(i);
    }
    lane.side = angle > 0.0 || (angle == 0.0 && speed > 0.0) ? 1 : -1;
    stand(i);
    u[i] = alpha[i] - std::fabs(angle);
    v[i] = -lane.side * speed * lane.step;
    peak[i] = 0.0;
    raise_peak(i, std::fabs(angle), 0.0);
    if (u[i] < 0.0) lane.over_time = 0.0;
    lane.uplifts = 1;
    lane.first_uplift = 0.0;
    note(i, kUplift, 0.0, 0.0, 0.0, 0.0);
}

}  // namespace ROCKING_ISA
}  // namespace rocking
