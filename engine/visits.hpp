// Visits to single lanes: impacts, tops, the ends of motions, and whatever else is not a plain step.
#pragma once
#include "kernel.hpp"

namespace rocking {
namespace ROCKING_ISA {

// Visits to lanes that may touch the ground, in M registers.
ROCKING_KERNEL
template <int M>
void Kernel<G, U, N, D, Z, L>::land(const int* who, int count) {
    alignas(64) double rows[N + 3][M * P], zero[M * P], speed[M * P];
    for (int s = 0; s < M * P; ++s) {  // plain copies: quicker than gathers
        const int i = who[s < count ? s : 0];
        rows[0][s] = alpha[i] - u[i];
        ROCKING_UNROLL
        for (int k = 0; k <= N; ++k) rows[k + 1][s] = terms[k][i];
        rows[N + 2][s] = len[i];
    }
    Pack raw[N + 2][M];
    ROCKING_UNROLL
    for (int k = 0; k <= N + 1; ++k)
        for (int m = 0; m < M; ++m) raw[k][m] = Pack::load(rows[k] + m * P);
    Landings<N, M> landings;
    const unsigned long found = landings.solve(raw);
    if (found) {
        ROCKING_UNROLL
        for (int m = 0; m < M; ++m) {
            landings.zero[m].store(zero + m * P);
            max(Pack(0.0), Pack(0.0) - landings.slope[m] / Pack::load(rows[N + 2] + m * P)).store(speed + m * P);
        }
    }
    for (int s = 0; s < count; ++s) {
        if (found >> s & 1) touch(who[s], zero[s], speed[s]);
        else visit(who[s], true);
    }
}

ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::sample(int i) {
    const Lane& lane = lanes[i];
    const std::int64_t k = static_cast<std::int64_t>((idx[i] - lane.first) / motions.stride());
    trace->rotation[k] = lane.side * (alpha[i] - u[i]);
    trace->velocity[k] = -lane.side * v[i] / lane.step;
}

ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::note(int i, EventKind kind, double time, double before, double after, double coefficient) {
    if (trace) trace->events.push_back({time, before, after, coefficient, kind, static_cast<std::int8_t>(lanes[i].side)});
}

ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::touch(int i, double zero, double speed) {
    const double c0 = alpha[i] - u[i], c1 = -terms[0][i];
    if (c1 > 0.0 && c0 + c1 > peak[i]) {
        double c[N + 2] = {c0};
        for (int k = 0; k <= N; ++k) c[k + 1] = -terms[k][i] * (1.0 / (k + 1));
        note_peak(i, c, zero);
    }
    impact(i, zero, speed);
}

ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::visit(int i, bool near) {
    double V[N + 1], c[N + 2];
    double sum = 0.0;
    for (int k = 0; k <= N; ++k) {
        V[k] = terms[k][i];
        c[k + 1] = -V[k] * (1.0 / (k + 1));
        sum += std::fabs(V[k]);
    }
    c[0] = alpha[i] - u[i];
    if (!(sum < 1e100)) return finish(i, kFailed, kNotFinite);
    const double zero = near ? first_contact(c) : 2.0;
    note_peak(i, c, zero < 1.0 ? zero : 1.0);
    if (!(zero <= 1.0)) return advance(i, V);
    double slopes[N + 1];
    slopes_of<N + 1>(c, slopes);
    impact(i, zero, std::max(0.0, -value_of<N>(slopes, zero) / len[i]));
}

// First return to y = 0; a step that starts there is divided by the known zero first.
ROCKING_KERNEL
double Kernel<G, U, N, D, Z, L>::first_contact(double* c) const {
    if (c[0] > 0.0) return first_zero<N + 1>(c);
    if (c[0] < 0.0) return 0.0;
    if (c[1] > 0.0) return first_zero<N>(c + 1);
    if (c[1] < 0.0) return 0.0;
    c[2] = std::max(c[2], 0.0);  // uplift: the moment just changed sign here, so rounding alone is left
    if (c[2] > 0.0) return first_zero<N - 1>(c + 2);
    if (c[3] > 0.0) return first_zero<N - 2>(c + 3);
    return 2.0;
}

// The highest point within a step, up to a place in it, if it is a new peak.
ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::note_peak(int i, const double* c, double upto) {
    double top = c[0], slopes[N + 1], sway = 0.0;
    for (int k = 1; k <= N + 1; ++k) top += std::max(c[k], 0.0);
    if (!(top > peak[i])) return;
    slopes_of<N + 1>(c, slopes);
    for (int k = 2; k <= N; ++k) sway += std::fabs(slopes[k]);
    const double start = slopes[0], end = value_of<N>(slopes, upto);
    // the slope leaves the straight line between its ends by less than its sway: one turn, none, or any number of them
    if (start > sway && end < -sway) {
        const double at = first_zero<N>(slopes);
        if (at <= upto) raise_peak(i, value_of<N + 1>(c, at), now(i, at));
    } else if (!(std::min(start, end) > sway) && !(std::max(start, end) < -sway)) {
        each_fall<N>(slopes, [&](double at) {
            if (at <= upto) raise_peak(i, value_of<N + 1>(c, at), now(i, at));
        });
    }
}

ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::raise_peak(int i, double y, double time) {
    if (y > peak[i]) {
        peak[i] = y;
        lanes[i].peak_signed = lanes[i].side * y;
        lanes[i].peak_time = time;
    }
}

ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::impact(int i, double at, double speed) {  // [rad per stretch]
    Lane& lane = lanes[i];
    const int old = lane.side;
    fastest[i] = std::max(fastest[i], speed);
    lane.side = -old;
    const double r = coefficient(i, speed), after = r * speed;
    ++lane.impacts;
    if (trace) note(i, kImpact, now(i, at), -old * speed / lane.step, r * (-old * speed / lane.step), r);
    stand(i);
    u[i] = alpha[i];
    v[i] = -after;
    move(i, tau[i] + at * len[i]);
    if (trace && tau[i] == 0.0) sample(i);
    if (lane.impacts >= set.most_impacts) return finish(i, kFailed, kTooManyImpacts);
    if (over(i)) return conclude(i);
    if (comes_to_rest(i, after)) {
        note(i, kRest, now(i, 0.0), 0.0, 0.0, 0.0);
        rest(i);
    }
}

ROCKING_KERNEL
double Kernel<G, U, N, D, Z, L>::coefficient(int i, double speed) const {  // [rad per stretch]
    const Lane& lane = lanes[i];
    const double r = here(i).r;
    if (law.kind == LawKind::of_speed) return r * interpolated(law.at, law.value, speed / lane.step);
    if (law.kind == LawKind::random)
        return r * interpolated(law.at, law.value, uniform(law.seed, rows.key[lane.row], lane.impacts));
    return r;
}

// Lane variables of the side on which the body stands.
ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::stand(int i) {
    const Lane& lane = lanes[i];
    const Side& s = here(i);
    alpha[i] = s.alpha;
    kappa[i] = (s.p * lane.step) * (s.p * lane.step);
    ca[i] = lane.side * lane.ax;
}

ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::move(int i, double to) {
    if (to >= kWhole) {
        idx[i] += motions.stride();
        tau[i] = 0.0;
    } else {
        tau[i] = to;
    }
    len[i] = std::min(sub[i], 1.0 - tau[i]);
}

// Whether the motion has ended; where rest of the ground follows, its jump to zero is passed.
ROCKING_KERNEL
bool Kernel<G, U, N, D, Z, L>::over(int i) {
    Lane& lane = lanes[i];
    if (idx[i] < last[i]) return false;
    if (!lane.still) return true;
    idx[i] += motions.stride();
    lane.first += motions.stride();  // the pair of samples counts as one instant
    last[i] = idx[i] + static_cast<double>(lane.still * motions.stride());
    lane.still = 0;
    return false;
}

ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::advance(int i, const double* V) {
    Lane& lane = lanes[i];
    const double u1 = end_u[i], v1 = end_v[i];
    if (u1 < 0.0) {
        double c[N + 2];
        c[0] = u[i];
        for (int k = 0; k <= N; ++k) c[k + 1] = V[k] / (k + 1);
        if (c[0] == 0.0) lane.over_time = now(i, 0.0);
        each_fall<N + 1>(c, [&](double at) { lane.over_time = now(i, at); });
    }
    u[i] = u1;
    v[i] = v1;
    fastest[i] = std::max(fastest[i], std::fabs(v1));
    move(i, tau[i] + len[i]);
    const bool ended = over(i);
    if (trace && tau[i] == 0.0) sample(i);
    if (u1 < 0.0) {
        const bool lies = alpha[i] - u1 >= kHalfPi && (!L || beyond_return(i));
        if (lies || (!set.to_the_ground && beyond_return(i))) return overturned(i);
        gate[i] = set.to_the_ground ? 0.0 : next_look(i);
    }
    if (ended) conclude(i);
}

}  // namespace ROCKING_ISA
}  // namespace rocking
