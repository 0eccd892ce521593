// Events of single lanes: impacts, peaks, ends of motions, and all other exceptions from regular steps.
#pragma once
#include "kernel.hpp"

namespace rocking {
namespace ROCKING_ISA {

// Computes lanes that may touch the ground, in M registers.
ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::land(const int* who, int from, int count) {
    alignas(64) double zero[M * P], speed[M * P];
    Pack arcs[N + 2][M];
    for (int m = 0; m < M; ++m) arcs[0][m] = Pack::load(above + from + m * P);
    ROCKING_UNROLL
    for (int k = 0; k <= N; ++k)
        for (int m = 0; m < M; ++m) {
            const Pack term = Pack::load(&queued[k][from + m * P]);
            arcs[k + 1][m] = k > 0 ? term * Pack(-1.0 / (k + 1)) : Pack(0.0) - term;
        }
    SimpleRoots<N + 1, M> landings;
    const Bits landed = landings.solve(arcs) & ((Bits(1) << count) - 1);
    Bits rising = 0;
    if (landed) {
        ROCKING_UNROLL
        for (int m = 0; m < M; ++m) {
            landings.zero[m].store(zero + m * P);
            // a polynomial that starts on the ground may increase at first, even if it is concave after the division by
            // its zero
            const Pack most = arcs[0][m] + arcs[1][m] + max(arcs[2][m], Pack(0.0));
            const Mask rises = (arcs[1][m] > Pack(0.0)) & (most > Pack::load(floors + from + m * P));
            rising |= static_cast<Bits>(rises.bits()) << (m * P);
            max(Pack(0.0), Pack(0.0) - landings.slope[m] / Pack::load(span + from + m * P)).store(speed + m * P);
        }
    }
    // every operation covers all lanes, and no branch depends on a lane
    int settling[M * P], settlings = 0;
    for (Bits left = landed & rising; left; left &= left - 1) {
        const int s = lowest(left);
        keep_peak(who[s], {&queued[0][from + s], W + M * P}, zero[s], 0.0, true);
    }
    for (Bits left = landed; left; left &= left - 1) {
        const int s = lowest(left);
        settling[settlings] = who[s];
        settlings += bounce(who[s], zero[s], speed[s]);
    }
    for (int k = 0; k < settlings; ++k) settle(settling[k]);
    for (Bits left = ~landed & ((Bits(1) << count) - 1); left; left &= left - 1) {
        const int s = lowest(left);
        resolve_event(who[s], {&queued[0][from + s], W + M * P}, true);
    }
}

// Series of the height above the ground over the step.
ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::arc(int i, Step step, double* c) const {
    c[0] = alpha[i] - u[i];
    ROCKING_UNROLL
    for (int k = 0; k <= N; ++k) c[k + 1] = -step[k] * (1.0 / (k + 1));
}

ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::sample(int i) {
    const Lane& lane = lanes[i];
    const std::int64_t k = (idx[i] - lane.first) / stride;
    trace->rotation[k] = lane.side * (alpha[i] - u[i]);
    trace->velocity[k] = -lane.side * v[i] / lane.step;
}

ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::note(int i, EventKind kind, double time, double before, double after, double coefficient) {
    if (trace) trace->events.push_back({time, before, after, coefficient, kind, static_cast<std::int8_t>(lanes[i].side)});
}

ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::resolve_event(int i, Step step, bool near) {
    double sum = 0.0;
    for (int k = 0; k <= N; ++k) sum += std::fabs(step[k]);
    if (!(sum < 1e100)) return finish(i, kFailed, kNotFinite);
    double c[N + 2], zero = 2.0;
    if (near) {
        arc(i, step, c);
        zero = first_contact(c);
    }
    if (!(zero <= 1.0)) {
        // one term is larger than the sum of the others (from rest: of the terms after it), so there is no turning
        // point
        const bool comes_down = v_end[i] >= 0.0, none = 2.0 * std::fabs(step[0] != 0.0 ? step[0] : step[1]) > sum;
        if (!none || (step[0] < 0.0 && comes_down)) keep_peak(i, step, 1.0, alpha[i] - u_end[i], comes_down);
        return advance(i, step);
    }
    double slopes[N + 1];
    slopes_of<N + 1>(c, slopes);
    keep_peak(i, step, zero, 0.0, true);
    if (bounce(i, zero, std::max(0.0, -value_of<N>(slopes, zero) / length(i)))) settle(i);
}

// First return to y = 0. If a step starts there, the polynomial is divided by this known zero first.
ROCKING_KERNEL
double Kernel<G, U, N, D, Z, L>::first_contact(double* c) const {
    if (c[0] > 0.0) return first_zero<N + 1>(c);
    if (c[0] < 0.0) return 0.0;
    if (c[1] > 0.0) return first_zero<N>(c + 1);
    if (c[1] < 0.0) return 0.0;
    // at uplift the moment has just changed its sign, so a negative coefficient is a rounding error
    c[2] = std::max(c[2], 0.0);
    if (c[2] > 0.0) return first_zero<N - 1>(c + 2);
    if (c[3] > 0.0) return first_zero<N - 2>(c + 3);
    return 2.0;
}

// An impact at a position within the step. settle() decides whether further events follow. after: angular
// velocity after the impact [rad per stretch]; a segment is the interval between two samples.
ROCKING_KERNEL
bool Kernel<G, U, N, D, Z, L>::bounce(int i, double at, double speed) {
    Lane& lane = lanes[i];
    const int old = lane.side;
    fastest[i] = std::max(fastest[i], speed);
    const double to = tau[i] + at * length(i);
    double push, weight;
    ground_at(i, to, push, weight);
    touch(i, speed, push, weight);
    lane.side = -old;
    const Side& s = here(i);
    const double r = law.kind == LawKind::constant ? s.r : coefficient(i, speed), after = r * speed;  // Eq. 28
    ++lane.impacts;
    if (trace) note(i, kImpact, now(i, at), -old * speed / lane.step, r * (-old * speed / lane.step), r);
    stand(i);
    u[i] = s.alpha;
    v[i] = -after;
    const bool ends_stretch = to >= kWhole;
    idx[i] += ends_stretch ? stride : 0;
    tau[i] = ends_stretch ? 0.0 : to;
    if (trace && ends_stretch) sample(i);
    return (lane.impacts >= set.most_impacts) | (idx[i] >= last[i]) | (after <= s.calm);
}

// Consequences of an impact: too many impacts, end of the motion, rest.
ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::settle(int i) {
    const double after = -v[i];
    if (lanes[i].impacts >= set.most_impacts) return finish(i, kFailed, kTooManyEvents);
    if (over(i)) return conclude(i);
    if (!(after <= here(i).calm)) return;
    const std::int64_t block = block_at(i);  // used for a body near rest
    ROCKING_PREFETCH(motions.horizontal.within.data() + block);
    ROCKING_PREFETCH(motions.horizontal.later.data() + block);
    if (comes_to_rest(i, after)) {
        note(i, kRest, now(i, 0.0), 0.0, 0.0, 0.0);
        rest(i);
    }
}

ROCKING_KERNEL
double Kernel<G, U, N, D, Z, L>::coefficient(int i, double speed) const {  // [rad per stretch]
    const Lane& lane = lanes[i];
    const double r = here(i).r;
    const int side = lane.side < 0;
    if (law.kind == LawKind::of_speed) return r * interpolated(law.at, law.value[side], speed / lane.step);
    if (law.kind == LawKind::random) {
        const double drawn = uniform(law.seed, rows.key[lane.row], lane.impacts);
        return r * interpolated(law.at, law.value[side], rows.share[side][lane.row] * drawn);  // Eq. 41
    }
    return r;
}

// Largest coefficient of restitution of landings on a side.
ROCKING_KERNEL
double Kernel<G, U, N, D, Z, L>::largest(int i, int side) const {
    const double r = lanes[i].sides[side].r;
    if (law.kind == LawKind::constant) return r;
    if (law.kind == LawKind::of_speed) return r * law.largest[side];
    return r * interpolated(law.at, law.value[side], rows.share[side][lanes[i].row]);
}

// Sets the lane variables that depend on the side of contact.
ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::stand(int i) {
    const Side& s = here(i);
    alpha[i] = s.alpha;
    kappa[i] = s.kappa;
    ca[i] = s.push;
    lever[i] = -2.0 * lanes[i].q[lanes[i].side < 0];
    sine_of[i] = s.sine;
    cosine_of[i] = s.cosine;
    if (L) sine_cosine(s.alpha, sine_of[i], cosine_of[i]);
}

ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::move(int i, double to) {
    if (to >= kWhole) {
        idx[i] += stride;
        tau[i] = 0.0;
    } else {
        tau[i] = to;
    }
}

// True if the motion has ended; if the ground then rests, the jump to zero is skipped.
ROCKING_KERNEL
bool Kernel<G, U, N, D, Z, L>::over(int i) {
    Lane& lane = lanes[i];
    if (idx[i] < last[i]) return false;
    if (!lane.still) return true;
    force_at_end(i);
    idx[i] += stride;
    lane.first += stride;  // the two samples of the jump count as one instant
    last[i] = idx[i] + lane.still * stride;
    lane.still = 0;
    return false;
}

ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::advance(int i, Step step) {
    Lane& lane = lanes[i];
    const double u1 = u_end[i], v1 = v_end[i];
    if (u1 < 0.0) {
        double c[N + 2], slopes[N + 1], passing = u[i] == 0.0 ? 0.0 : -1.0;
        c[0] = u[i];
        for (int k = 0; k <= N; ++k) {
            slopes[k] = step[k];
            c[k + 1] = slopes[k] / (k + 1);
        }
        each_fall<N + 1>(c, [&](double at) { passing = at; });
        if (passing >= 0.0) {
            lane.over_time = now(i, passing);
            pass_over(i, value_of<N>(slopes, passing) / length(i), tau[i] + passing * length(i));
        }
    }
    u[i] = u1;
    v[i] = v1;
    fastest[i] = std::max(fastest[i], std::fabs(v1));
    move(i, tau[i] + length(i));
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
