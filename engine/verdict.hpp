// Overturning: the point of no return, and the energy at the end of the motion.
#pragma once
#include "kernel.hpp"

namespace rocking {
namespace ROCKING_ISA {

ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::overturned(int i) {
    finish(i, kOverturned, kGood);
}

// True if no later ground motion can bring the body back: the body is beyond equilibrium, moves outwards, and
// accelerates outwards even under the largest remaining acceleration and the smallest remaining weight.
ROCKING_KERNEL
bool Kernel<G, U, N, D, Z, L>::beyond_return(int i) const {
    if (!(v[i] <= 0.0)) return false;
    if (idx[i] >= last[i]) return true;
    double back, weight;
    still_to_come(i, back, weight);
    if (L) return weight * -u[i] > back && weight > 0.0;
    if (!(u[i] > -kHalfPi)) return true;
    double s, c;
    sine_cosine(-u[i], s, c);
    return weight * s > back * c && weight > 0.0;  // Eq. 36
}

// Angle at which a body before the point of no return is checked again: the equilibrium under the strongest remaining
// motion, or the ground, but at least 0.001 rad further out.
ROCKING_KERNEL
double Kernel<G, U, N, D, Z, L>::next_look(int i) const {
    double back, weight;
    still_to_come(i, back, weight);
    const double out = L ? (weight > 0.0 ? back / weight : kHalfPi) : std::atan2(back, weight);
    return std::min(std::max(-out, alpha[i] - kHalfPi), u[i] - 0.001);
}

ROCKING_KERNEL
std::int64_t Kernel<G, U, N, D, Z, L>::block_at(int i) const {
    const Lane& lane = lanes[i];
    const std::int64_t k = (idx[i] - lane.first) / stride;
    return lane.block + k / kBlock;
}

// For the remaining motion, divided by gravity: largest push of the ground against the rotation, and smallest weight.
ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::still_to_come(int i, double& back, double& weight) const {
    const std::int64_t block = block_at(i);
    const Range across = motions.horizontal.later[block], lift = up(motions.vertical.later, block);
    back = std::max({0.0, ca[i] * across.low, ca[i] * across.high});
    weight = 1.0 + std::min({0.0, lanes[i].az * lift.low, lanes[i].az * lift.high});
}

// After the motion the energy decides: e = u'^2 / (2 p^2) + cos u - cos alpha; e = 1 - cos alpha at the equilibrium.
ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::conclude(int i) {
    Lane& lane = lanes[i];
    if (has_peaks(i)) find_peaks();  // in order, so that the first of equal peaks is recorded
    raise_peak(i, alpha[i] - u[i], now(i, 0.0));
    if (idx[i] >= last[i]) force_at_end(i);
    const double speed = v[i] / lane.step;
    const double e = energy(here(i), u[i], speed);
    const bool inward = speed > 0.0, passes = e > energy(here(i), 0.0, 0.0);
    if (u[i] < 0.0 && !(inward && passes)) {
        if (!(lane.over_time >= 0.0)) forces_up_to_here(i);
        return overturns(i, lane.over_time >= 0.0 ? lane.over_time : now(i, 0.0));
    }
    // on resting ground the force increases from here to equilibrium, unless it is tensile or q < 0.3
    if (!inward && passes) {
        double s, c;
        sine_cosine(u[i], s, c);
        force_at(i, s, c, v[i], 0.0, 1.0);
        forces_up_to_here(i);
        return overturns(i, now(i, 0.0));
    }
    if (!inward) raise_peak(i, height(here(i), e), now(i, 0.0));
    double arrival = here(i).p * std::sqrt(2.0 * std::max(e, 0.0));
    fastest[i] = std::max(fastest[i], arrival * lane.step);
    // every later contact with a side has less energy than the previous contact
    for (int flight = 0; flight < 2; ++flight) {
        touch(i, arrival * lane.step, 0.0, 1.0);
        lane.side = -lane.side;
        stand(i);
        arrival *= coefficient(i, arrival * lane.step);
        ++lane.impacts;
        const double f = 0.5 * arrival * arrival / (here(i).p * here(i).p);
        touch(i, arrival * lane.step, 0.0, 1.0);
        if (f > energy(here(i), 0.0, 0.0)) {
            forces_up_to_here(i);
            return overturns(i, now(i, 0.0));
        }
        raise_peak(i, height(here(i), f), now(i, 0.0));
    }
    lane.impacts -= 2;  // later impacts are counted only if the body overturns
    const std::int64_t row = lane.row;
    finish(i, kRocked, kGood);
    rows.still[row] = rows.outcome[row] == kRocked;
}

ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::overturns(int i, double when) {
    lanes[i].over_time = when;
    finish(i, kOverturned, kGood);
}

// Energy / (m g R), relative to rest. The form 2 sin^2(x / 2) of 1 - cos x avoids loss of digits.
ROCKING_KERNEL
double Kernel<G, U, N, D, Z, L>::energy(const Side& s, double u_, double speed) {
    const double kinetic = 0.5 * speed * speed / (s.p * s.p);
    if (L) return kinetic + 0.5 * (s.alpha * s.alpha - u_ * u_);  // Eq. 30
    double a, b, c;
    sine_cosine(0.5 * (s.alpha + u_), a, c);
    sine_cosine(0.5 * (s.alpha - u_), b, c);
    return kinetic + 2.0 * a * b;  // Eq. 17
}

// Rotation |theta| at which a body with energy e reverses.
ROCKING_KERNEL
double Kernel<G, U, N, D, Z, L>::height(const Side& s, double e) {
    if (L) return s.alpha - std::sqrt(std::max(0.0, s.alpha * s.alpha - 2.0 * e));
    const double half = std::sin(0.5 * s.alpha);
    return s.alpha - 2.0 * std::asin(std::sqrt(std::max(0.0, half * half - 0.5 * e)));  // Eq. 32
}

}  // namespace ROCKING_ISA
}  // namespace rocking
