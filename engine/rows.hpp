// Copies rows of the input into SIMD lanes, and results from the lanes to the output.
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
    if (good && !down && has_peaks(i)) find_peaks();
    rows.outcome[row] = outcome;
    rows.status[row] = status;
    rows.side[row] = outcome == kOverturned ? static_cast<std::int8_t>(lane.side) : 0;
    rows.still[row] = 0;
    rows.peak[row] = down ? lane.side * kHalfPi : good ? lane.peak_signed : nan;  // a fallen body is at a quarter turn
    rows.peak_time[row] = down ? lane.over_time : good ? lane.peak_time : nan;
    rows.peak_velocity[row] = good ? fastest[i] / lane.step : nan;
    rows.overturning_time[row] = outcome == kOverturned ? lane.over_time : nan;
    rows.first_uplift[row] = lane.first_uplift;
    rows.error[row] = good ? err[i] : nan;
    const double force = down ? least_before[i] : least[i];
    const bool rocked = good && force < std::numeric_limits<double>::infinity();
    rows.least_force[row] = rocked ? force : nan;
    rows.friction[row] = rocked ? (down ? demand_before[i] : demand[i]) : nan;
    rows.impacts[row] = lane.impacts;
    rows.uplifts[row] = lane.uplifts;
    --active;
    idle(i);
}

ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::idle(int i) {
    lanes[i].row = -1;
    u[i] = 0.0;
    least[i] = least_before[i] = -1e300;  // no force is smaller
    v[i] = lever[i] = demand[i] = demand_before[i] = 0.0;
    tau[i] = kappa[i] = ca[i] = cz[i] = err[i] = fastest[i] = gate[i] = sub[i] = 0.0;
    idx[i] = 0;
    alpha[i] = peak[i] = 1.0;
    last[i] = std::numeric_limits<std::int64_t>::max();
}

// The queue is empty. Lanes of the last registers move to free lanes, so that the remaining registers are full.
ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::close_ranks() {
    used -= Q;
    int to = 0;
    for (int i = used * P; i < (used + Q) * P; ++i) {
        if (lanes[i].row < 0) continue;
        while (lanes[to].row >= 0) ++to;
        move_lane(i, to);
    }
}

ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::move_lane(int from, int to) {
    for (double* value : {u, v, tau, sub, kappa, ca, cz, alpha, peak, err, fastest, gate, least, demand, lever, sine_of,
                          cosine_of, least_before, demand_before})
        value[to] = value[from];
    for (std::int64_t* value : {idx, last}) value[to] = value[from];
    lanes[to] = lanes[from];
    for (int s = 0; s < peaks_waiting; ++s)
        if (peaks[s].lane == from) peaks[s].lane = to;
    idle(from);
}

ROCKING_KERNEL
bool Kernel<G, U, N, D, Z, L>::valid(const Rows& r, std::int64_t k, std::size_t motions) {
    for (const double* angle : {r.alpha_right, r.alpha_left})
        if (!(angle[k] > 0.0 && angle[k] < kHalfPi)) return false;
    for (const double* p : {r.p_right, r.p_left})
        if (!(p[k] > 1e-9 && p[k] < 1e9)) return false;
    for (const double* q : {r.q_right, r.q_left})
        if (q[k] <= 0.0 || q[k] > 1.000001) return false;  // NaN: q is unknown, and then the forces are unknown too
    for (const double* e : {r.r_right, r.r_left})
        if (!(e[k] >= 0.0 && e[k] <= 100.0)) return false;
    for (const double* share : r.share)
        if (!(share[k] > 0.0 && share[k] <= 1.0)) return false;
    return std::fabs(r.scale[k]) <= 1e9 && std::fabs(r.rotation[k]) < kHalfPi && std::fabs(r.velocity[k]) < 1e9 &&
           r.motion[k] >= 0 && r.motion[k] < static_cast<std::int64_t>(motions);
}

// Moves prepared rows into a lane until a row needs the lane, and prepares the next row.
ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::fill(int i) {
    idle(i);
    while (lanes[i].row < 0) {
        if (ready.row < 0 && next == end && !queue.take(next, end)) return;
        if (ready.row < 0) look_for_one();
        if (ready.row < 0) continue;
        start(i);
        look_for_one();
    }
}

// The motion of the row at a position of the queue; null if there is no such row.
ROCKING_KERNEL
const Shake* Kernel<G, U, N, D, Z, L>::shake_of(std::int64_t position) const {
    if (position >= end) return nullptr;
    const std::int64_t k = rows.motion[listed(position)];
    return k >= 0 && k < static_cast<std::int64_t>(motions.shakes.size()) ? &motions.shakes[k] : nullptr;
}

// Prepares the next row that needs a lane; writes the results of rows without motion.
ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::look_for_one() {
    ready.row = -1;
    while (next < end) {
        const std::int64_t row = listed(next++);
        // Prefetch the data of later rows. The prefetch is inside this function, because compilers may remove calls of
        // functions without other effects.
        if (const Shake* shake = shake_of(next + 6)) {
            ROCKING_PREFETCH(shake);
            ROCKING_PREFETCH(reinterpret_cast<const char*>(shake + 1) - 1);
        }
        if (const Shake* shake = shake_of(next + 3))
            for (int k = 0; k < 24; k += 4) ROCKING_PREFETCH(motions.horizontal.within.data() + shake->block + k);
        if (!valid(rows, row, motions.shakes.size())) write_invalid(row);
        else if (prepare(row)) return;
    }
}

ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::write_invalid(std::int64_t row) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    rows.outcome[row] = kFailed;
    rows.status[row] = kInvalid;
    rows.side[row] = rows.still[row] = 0;
    rows.peak[row] = rows.peak_time[row] = rows.peak_velocity[row] = nan;
    rows.overturning_time[row] = rows.first_uplift[row] = rows.error[row] = nan;
    rows.least_force[row] = rows.friction[row] = nan;
    rows.impacts[row] = rows.uplifts[row] = 0;
}

// Writes the results of a row without uplift.
ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::write_still(std::int64_t row) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    rows.outcome[row] = kNoUplift;
    rows.status[row] = kGood;
    rows.side[row] = rows.still[row] = 0;
    rows.peak[row] = rows.peak_time[row] = rows.peak_velocity[row] = rows.error[row] = 0.0;
    rows.overturning_time[row] = rows.first_uplift[row] = rows.least_force[row] = rows.friction[row] = nan;
    rows.impacts[row] = rows.uplifts[row] = 0;
}

// Prepares a row before a lane is free. False if the row needs no lane, since nothing causes uplift; its results are
// written.
ROCKING_KERNEL
bool Kernel<G, U, N, D, Z, L>::prepare(std::int64_t row) {
    ready.row = row;
    Lane& lane = ready.lane;
    lane = Lane();
    lane.row = row;
    lane.peak_signed = lane.peak_time = 0.0;
    lane.over_time = lane.first_uplift = std::numeric_limits<double>::quiet_NaN();
    const Shake& shake = motions.shakes[rows.motion[row]];
    lane.block = shake.block;
    ready.segments = shake.segments;
    lane.step = shake.step;
    lane.ax = lane.az = rows.scale[row] / set.gravity;
    lane.sides[0] = side_of(rows.alpha_right[row], rows.p_right[row], rows.r_right[row], lane.step, lane.ax);
    lane.sides[1] = side_of(rows.alpha_left[row], rows.p_left[row], rows.r_left[row], lane.step, -lane.ax);
    lane.q[0] = rows.q_right[row];
    lane.q[1] = rows.q_left[row];
    lane.first = shake.first;
    lane.still = shake.still;
    ready.parts = parts_of(shake, std::max(rows.p_right[row], rows.p_left[row]), lane.ax, set.longest_step);
    const double angle = rows.rotation[row], speed = rows.velocity[row];
    const Side& stood = lane.sides[angle > 0.0 ? 0 : 1];
    ready.still = stood.alpha - std::fabs(angle) == stood.alpha && std::fabs(speed) <= kNothing * stood.p * stood.alpha;
    ready.from = shake.first;
    if (ready.still) {
        const std::int64_t stop = shake.first + shake.segments * stride;
        ready.from = may_lift(lane, shake.horizontal, shake.vertical) ? first_block(lane, ready.from, stop) : stop;
        if (ready.from >= stop) {
            if (!resolved(ready.parts, ready.segments + lane.still)) return true;
            write_still(row);
            ready.row = -1;
            return false;
        }
    }
    for (int k = 0; k < 6; ++k) ROCKING_PREFETCH(motions.data + ready.from + 8 * k);
    ROCKING_PREFETCH(&motions.horizontal.later[shake.block + (ready.from - shake.first) / (kBlock * stride)]);
    return true;
}

// Moves the prepared row into a lane.
ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::start(int i) {
    Lane& lane = lanes[i];
    ++active;
    lane = ready.lane;
    idx[i] = lane.first;
    last[i] = lane.first + ready.segments * stride;
    cz[i] = lane.az;
    sub[i] = 1.0 / ready.parts;
    tau[i] = 0.0;
    if (!resolved(ready.parts, ready.segments + lane.still)) return finish(i, kFailed, kNotResolved);
    peak[i] = 0.0;
    least[i] = std::numeric_limits<double>::infinity();
    if (ready.still) return await(i, ready.from);
    const double angle = rows.rotation[lane.row], speed = rows.velocity[lane.row];
    lane.side = angle > 0.0 || (angle == 0.0 && speed > 0.0) ? 1 : -1;
    stand(i);
    u[i] = alpha[i] - std::fabs(angle);
    v[i] = -lane.side * speed * lane.step;
    raise_peak(i, std::fabs(angle), 0.0);
    if (u[i] < 0.0) {  // the body starts beyond the point of equilibrium
        const double* a = motions.data + idx[i];
        double s, c;
        sine_cosine(u[i], s, c);
        force_at(i, s, c, v[i], ca[i] * a[0], Z ? 1.0 + lane.az * a[Z] : 1.0);
        forces_up_to_here(i);
        lane.over_time = 0.0;
    }
    lane.uplifts = 1;
    lane.first_uplift = 0.0;
    note(i, kUplift, 0.0, 0.0, 0.0, 0.0);
}

}  // namespace ROCKING_ISA
}  // namespace rocking
