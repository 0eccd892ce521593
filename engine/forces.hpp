// The contact force on a rocking body, divided by the weight m g, with q = m R^2 / I_o, e = (u' / p)^2 and M = u'' / p^2:
//     N = 1 + a_z / g - q (M S + e C),   s H = s a_x / g - q (M C - e S).
// N < 0 is a tensile contact force: the body loses contact. N and H are evaluated at the start of every step (every
// sample, uplift and impact), just before every impact, and at the end of the motion. An overturning body is evaluated
// until its last passage over its foot, including this instant.
#pragma once
#include "kernel.hpp"

namespace rocking {
namespace ROCKING_ISA {

// Updates the extreme forces of the lanes that exceed them at the start of their last step.
ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::note_forces(int base, Bits beats) {
    const double *s = reinterpret_cast<double*>(sines), *c = reinterpret_cast<double*>(cosines);
    const double *h = reinterpret_cast<double*>(spans), *push = reinterpret_cast<double*>(b[0]), *lift = reinterpret_cast<double*>(z[0]);
    for (; beats; beats &= beats - 1) {
        const int k = lowest(beats), i = base + k;
        double sine = s[k], cosine = c[k];
        if (L) sine_cosine(std::max(sine, -kHalfPi), sine, cosine);
        const double square = kappa[i] * h[k] * h[k], spin = fresh[0][k] * fresh[0][k], half = 0.5 * lever[i];
        const double up = fma(half, fma(fresh[1][k], sine, spin * cosine), Z ? fma(lift[k], square, square) : square);
        const double along = fma(half, fma(fresh[1][k], cosine, -spin * sine), push[k] * square);
        note_force(i, up, std::fabs(along), square);
    }
}

// Updates the extreme forces of one lane, for a speed per segment, a push s a_x / g and a weight 1 + a_z / g.
ROCKING_KERNEL
ROCKING_INLINE void Kernel<G, U, N, D, Z, L>::force_at(int i, double sine, double cosine, double speed, double push, double weight) {
    const double half = 0.5 * lever[i], square = kappa[i], spin = speed * speed;
    const double moment = square * (L ? fma(weight, std::asin(sine), push) : fma(weight, sine, push * cosine));
    const double up = fma(square, weight, half * fma(moment, sine, spin * cosine));  // Eq. 33
    const double along = std::fabs(fma(square, push, half * fma(moment, cosine, -spin * sine)));  // Eq. 34
    if ((up < least[i] * square) | (along > demand[i] * up)) note_force(i, up, along, square);
}

ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::note_force(int i, double up, double along, double square) {
    least[i] = std::min(least[i], up / square);
    demand[i] = up > 0.0 ? std::max(demand[i], along / up) : std::numeric_limits<double>::infinity();  // Eq. 35
}

// Evaluates the force just before an impact.
ROCKING_KERNEL
ROCKING_INLINE void Kernel<G, U, N, D, Z, L>::touch(int i, double speed, double push, double weight) {
    force_at(i, sine_of[i], cosine_of[i], speed, push, weight);
}

// Push s a_x / g and weight 1 + a_z / g at a position within the segment.
ROCKING_KERNEL
ROCKING_INLINE void Kernel<G, U, N, D, Z, L>::ground_at(int i, double to, double& push, double& weight) const {
    const double* a = motions.data + idx[i];
    constexpr int hop = D == 1 ? stride : 0;
    push = ca[i] * (D == 1 ? a[0] + (a[hop] - a[0]) * to : value_of<D>(a, to));
    weight = Z ? 1.0 + cz[i] * (a[1] + (a[hop + 1] - a[1]) * to) : 1.0;
}

// Force when the body passes over its foot. For the last passage, later forces are ignored. to: position within the
// segment.
ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::pass_over(int i, double speed, double to) {
    double push, weight;
    ground_at(i, to, push, weight);
    force_at(i, 0.0, 1.0, speed, push, weight);
    forces_up_to_here(i);
}

// Evaluates the force at the last sample, where no step starts.
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
