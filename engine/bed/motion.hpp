// The body on the bed: accelerations, friction, energy. Velocities are resolved along and across the base line.
#pragma once
#include "contact.hpp"

namespace rocking::bed {

struct Rates {
    State slope;
    double normal, shear, moment, tilt, bed_loss, friction_loss, travel, stored;
};

class Motion {
public:
    Motion(const Problem& p, Bed& bed) : p_(p), bed_(bed) {}

    int slip = 0;  // Coulomb: 0 sticking, +1 or -1 sliding in this direction

    Rates rates(const State& x) const { return rates(x, place(x, p_.exact)); }

    Rates rates(const State& x, const Place& at) const {
        const Load l = bed_.load(at);
        const double m = p_.mass, h = p_.height, u = x[kU], w = x[kW], omega = x[kOmega];
        const double c = p_.exact ? at.cosine : 1.0, s = p_.exact ? at.sigma : 0.0;
        double along = -m * p_.push * c + s * (m * p_.gravity - l.force), across = c * (l.force - m * p_.gravity) - s * m * p_.push;
        double turning = m * h * (p_.gravity * at.sine - p_.push * at.cosine) - l.moment * c - l.tilt * s;
        if (p_.exact) {
            along -= m * w * omega;
            across += m * (u + h * omega) * omega;
            turning -= m * h * w * omega;
        }
        Rates r;
        r.normal = l.force;
        r.moment = l.moment;
        r.tilt = l.tilt;
        r.bed_loss = l.loss;
        r.stored = l.stored;
        const bool held = p_.kind == kSticking || (p_.kind == kCoulomb && slip == 0);
        if (held) {
            const double turn = turning / (p_.inertia + m * h * h);  // Eq. 123
            r.shear = m * h * turn - along;
            r.slope = {at.dy, omega, 0.0, across / m, turn};
        } else {
            // Eq. 124
            r.shear = p_.kind == kCoulomb ? -slip * p_.friction * l.force : -p_.friction * l.force * u / std::hypot(u, p_.creep);
            along += r.shear;
            const double turn = (turning - h * along) / p_.inertia;
            r.slope = {at.dy, omega, along / m - h * turn, across / m, turn};
        }
        r.friction_loss = held ? 0.0 : -r.shear * u;
        r.travel = p_.exact ? u * c + w * s : u;
        return r;
    }

    State operator()(const State& x) const { return rates(x).slope; }

    double energy(const State& x, double travel) const {
        const Place at = place(x, p_.exact);
        return energy(x, at, travel, stored(at));
    }
    // Derivatives of a state with known rates.
    double energy(const State& x, const Place& at, double travel, const Rates& rates) const {
        return energy(x, at, travel, bed_.linear() ? stored(at) : rates.stored);
    }

    // Kinetic, potential and elastic energy.
    double energy(const State& x, const Place& at, double travel, double elastic) const {
        const double u = x[kU] + p_.height * x[kOmega], w = x[kW], omega = x[kOmega];
        const double fall = at.sine * at.sine / (1.0 + at.cosine);
        // Eq. 125
        return 0.5 * p_.mass * (u * u + w * w) + 0.5 * p_.inertia * omega * omega + p_.mass * p_.gravity * (x[kY] - p_.height * fall) +
               p_.mass * p_.push * (travel + p_.height * at.sine) + elastic;
    }
    double stored(const Place& at) const {
        double sum = 0.0;
        for (std::int64_t i = 0; i < p_.points.count; ++i) sum += bed_.stored(i, at);
        return sum;
    }

    // Positive as long as the friction state remains valid.
    double friction_margin(const State& x) const {
        if (p_.kind != kCoulomb) return 1.0;
        return slip != 0 ? slip * x[kU] : friction_margin(x, rates(x));
    }
    double friction_margin(const State& x, const Rates& r) const {
        if (p_.kind != kCoulomb) return 1.0;
        return slip != 0 ? slip * x[kU] : p_.friction * r.normal - std::abs(r.shear);
    }

    // New friction state after a switch: sticking if possible, otherwise sliding in one direction.
    void settle_friction(const State& x, bool at_rest, bool leaves = false) {
        if (p_.kind != kCoulomb || (slip != 0 && !at_rest)) return;
        slip = 0;
        const Rates r = rates(x);
        if (leaves || std::abs(r.shear) > p_.friction * r.normal) slip = r.shear > 0.0 ? -1 : 1;
    }

private:
    const Problem& p_;
    Bed& bed_;
};

}  // namespace rocking::bed
