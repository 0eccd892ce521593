// The force of the ground on a rocking body: with q = m R^2 / I_o, e = (u' / p)^2 and M = u'' / p^2, over the weight m g
//     N = 1 + a_z / g - q (M S + e C),   s H = s a_x / g - q (M C - e S).
// N below zero would be a ground that pulls: the body loses contact. Both are looked at where steps start, so at every
// sample and after every uplift and impact, just before every impact, and where the motion ends, up to where a body that
// overturns passes over its foot for good, this instant included.
#pragma once
#include "kernel.hpp"

namespace rocking {
namespace ROCKING_ISA {

// Forces that are beyond those so far, times the square of p times the step.
ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::note_forces(int at, Mask where, Pack up, Pack along, Pack square) {
    const Pack ratio = select(up > Pack(0.0), abs(along) / up, Pack(std::numeric_limits<double>::infinity()));
    min(Pack::load(least + at), up / square).store_where(where, least + at);
    max(Pack::load(demand + at), ratio).store_where(where, demand + at);
}

// The same of one lane, at a speed per stretch, under a push s a_x / g and a weight 1 + a_z / g.
ROCKING_KERNEL
ROCKING_INLINE void Kernel<G, U, N, D, Z, L>::force_at(int i, double sine, double cosine, double speed, double push, double weight) {
    const double q = lanes[i].q[lanes[i].side < 0], square = kappa[i], spin = speed * speed;
    const double moment = square * (L ? weight * std::asin(sine) + push : weight * sine + push * cosine);
    const double up = square * weight - q * (moment * sine + spin * cosine);
    const double along = std::fabs(square * push - q * (moment * cosine - spin * sine));
    if ((up < least[i] * square) | (along > demand[i] * up)) note_force(i, up, along, square);
}

ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::note_force(int i, double up, double along, double square) {
    least[i] = std::min(least[i], up / square);
    demand[i] = up > 0.0 ? std::max(demand[i], along / up) : std::numeric_limits<double>::infinity();
}

// Just before an impact.
ROCKING_KERNEL
ROCKING_INLINE void Kernel<G, U, N, D, Z, L>::touch(int i, double speed, double push, double weight) {
    double sine = here(i).sine, cosine = here(i).cosine;
    if (L) sine_cosine(here(i).alpha, sine, cosine);
    force_at(i, sine, cosine, speed, push, weight);
}

// Push s a_x / g and weight 1 + a_z / g at a place within the stretch.
ROCKING_KERNEL
ROCKING_INLINE void Kernel<G, U, N, D, Z, L>::ground_at(int i, double to, double& push, double& weight) const {
    const double* a = motions.data + idx[i];
    constexpr int hop = D == 1 ? stride : 0;
    push = ca[i] * (D == 1 ? a[0] + (a[hop] - a[0]) * to : value_of<D>(a, to));
    weight = Z ? 1.0 + lanes[i].az * (a[1] + (a[hop + 1] - a[1]) * to) : 1.0;
}

// Where a body passes over its foot, at a place within the stretch: all that counts if it does so for good.
ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::pass_over(int i, double speed, double to) {
    double push, weight;
    ground_at(i, to, push, weight);
    force_at(i, 0.0, 1.0, speed, push, weight);
    forces_up_to_here(i);
}

// The last sample, where no step starts.
ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::force_at_end(int i) {
    const Lane& lane = lanes[i];
    const double* a = motions.data + idx[i];
    double s, c, push;
    sine_cosine(std::max(u[i], -kHalfPi), s, c);
    if (D == 1) push = a[0];
    else push = value_of<D>(a - stride, 1.0);
    force_at(i, s, c, v[i], ca[i] * push, Z ? 1.0 + lane.az * a[Z] : 1.0);
}

ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::forces_up_to_here(int i) {
    least_before[i] = least[i];
    demand_before[i] = demand[i];
}

}  // namespace ROCKING_ISA
}  // namespace rocking
