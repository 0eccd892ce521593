// Force laws of restraints, as sequences of phases, and elongation of restraints as a function of the rotation.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace rocking::restrained {

constexpr double kInf = std::numeric_limits<double>::infinity(), kNan = std::numeric_limits<double>::quiet_NaN();

enum class Kind { bilinear, viscous, friction, spring, wall };
// In the order of the names in Python.
enum Name : int { kElastic, kYieldsInTension, kYieldsInCompression, kSlack, kBroken, kViscous, kSticks, kSlipsInTension, kSlipsInCompression, kOpen, kTension, kCompression, kContactPhase, kReleased };

// A smooth phase: the force is n + K e between two elongations.
struct Phase {
    int name = kElastic;
    double constant = 0.0, stiffness = 0.0, low = -kInf, high = kInf;
    int direction = 0;  // sign of e' throughout the phase; 0 for any
    double force(double e) const { return constant + stiffness * e; }
    double work(double from, double to) const { return (constant + 0.5 * stiffness * (from + to)) * (to - from); }
};

struct Law {
    Kind kind = Kind::bilinear;
    double stiffness = 0.0, prestress = 0.0, limit = kInf, rupture = kInf, hardening = 0.0;
    bool symmetric = false, in_tension = true, in_compression = true;
    double coefficient = 0.0, exponent = 1.0, slip_force = 0.0, gap = 0.0;
    double damping = 0.0, rebound = kNan;  // of a wall; rebound: coefficient of restitution at a rigid wall
    Phase phase;
    double plastic = 0.0, lost = 0.0;
    std::int64_t yields = 0;

    // Kind and constants, in the order of `row` in Python.
    static Law of(const double* c) {
        Law a;
        a.kind = static_cast<Kind>(static_cast<int>(c[0]));
        if (a.kind == Kind::bilinear) {
            a.stiffness = c[1], a.prestress = c[2], a.limit = c[3], a.rupture = c[5], a.symmetric = c[6] != 0.0;
            a.hardening = c[4] * c[1] / (1.0 - c[4]);
            a.phase = a.elastic();
        } else if (a.kind == Kind::viscous) {
            a.coefficient = c[1], a.exponent = c[2], a.phase.name = kViscous;
        } else if (a.kind == Kind::friction) {
            a.slip_force = c[1], a.phase.name = kSticks;
        } else if (a.kind == Kind::wall) {
            a.stiffness = c[1], a.damping = c[2], a.gap = c[3], a.rebound = c[4] != 0.0 ? c[5] : kNan;
            a.touch(kOpen);
        } else {
            a.stiffness = c[1], a.gap = c[2], a.in_tension = c[3] != 0.0, a.in_compression = c[4] != 0.0;
            a.phase = a.in_tension && a.in_compression && a.gap == 0.0 ? Phase{kElastic, 0.0, a.stiffness, -kInf, kInf, 0} : a.open();
        }
        return a;
    }

    bool touches() const { return phase.name == kContactPhase; }
    bool broken() const { return phase.name == kBroken; }
    bool is_power() const { return coefficient != 0.0 && exponent != 1.0; }

    // Selects the phase for a direction of e', after uplift, impact, turning point or reversal of the lever.
    void settle(double e, int direction) {
        if (kind == Kind::bilinear && phase.direction * direction < 0) {
            flow(e);
            phase = elastic();
        } else if (kind == Kind::friction && direction) {
            phase = {direction > 0 ? kSlipsInTension : kSlipsInCompression, direction * slip_force, 0.0, -kInf, kInf, direction};
        } else if (kind == Kind::wall) {
            if (direction < 0 && e <= phase.low) cross(e, false);
            else if (direction > 0 && e >= -gap && phase.name != kOpen) touch(kOpen);
        } else if (kind == Kind::spring && direction > 0 && e >= phase.high) {
            cross(e, true);
        } else if (kind == Kind::spring && direction < 0 && e <= phase.low) {
            cross(e, false);
        }
    }

    // Selects the phase beyond a limit of the present phase.
    void cross(double e, bool upwards) {
        if (kind == Kind::spring) {
            const Phase tension{kTension, -stiffness * gap, stiffness, gap, kInf, 0}, compression{kCompression, stiffness * gap, stiffness, -kInf, -gap, 0};
            phase = phase.name == kOpen ? (upwards ? tension : compression) : open();
            return;
        }
        if (kind == Kind::wall) {
            const bool released = upwards && touches() && damping != 0.0;
            return touch(released ? kReleased : upwards ? kOpen : kContactPhase);
        }
        flow(e);
        if (rupture < kInf && (upwards ? phase.high : -phase.low) == rupture) {
            lost = stored(e);
            phase = {};
            phase.name = kBroken;
        } else if (phase.name == kSlack) {
            phase = elastic();
        } else if (upwards || symmetric) {
            ++yields;
            phase = flowing(upwards ? 1 : -1);
        } else {
            phase = bounded({kSlack, 0.0, 0.0, -kInf, at(0.0), 0});
        }
    }

    double stored(double e) {
        if (broken() || stiffness == 0.0) return 0.0;
        if (kind == Kind::bilinear) flow(e);
        if (kind == Kind::wall) return 0.5 * stiffness * std::min(e + gap, 0.0) * std::min(e + gap, 0.0);
        const double f = phase.force(e);
        return 0.5 * f * f / stiffness + 0.5 * hardening * plastic * plastic;
    }

  private:
    // Selects a phase of a wall. In the phase kReleased, the point of the body is inside the wall without a force.
    void touch(int name) {
        coefficient = name == kContactPhase ? damping : 0.0;
        if (name == kContactPhase) phase = {name, stiffness * gap, stiffness, -kInf, kInf, 0};
        else if (name == kReleased) phase = {name, 0.0, 0.0, -kInf, -gap, 0};
        else phase = {name, 0.0, 0.0, stiffness != 0.0 ? -gap : -kInf, kInf, 0};
    }
    Phase open() const { return {kOpen, 0.0, 0.0, in_compression ? -gap : -kInf, in_tension ? gap : kInf, 0}; }
    Phase bounded(Phase p) const {
        p.low = std::max(p.low, symmetric ? -rupture : -kInf), p.high = std::min(p.high, rupture);
        return p;
    }
    // Elongation in the elastic phase at a given force.
    double at(double force) const {
        if (stiffness == 0.0) return force > prestress ? kInf : -kInf;
        return plastic + (force - prestress) / stiffness;
    }
    Phase elastic() const {
        const double middle = hardening * plastic;
        return bounded({kElastic, prestress - stiffness * plastic, stiffness, symmetric ? at(middle - limit) : at(0.0), at(middle + limit), 0});
    }
    Phase flowing(int sign) const {
        const double total = stiffness + hardening, constant = sign * limit + hardening * (prestress - sign * limit) / total;
        return bounded({sign > 0 ? kYieldsInTension : kYieldsInCompression, constant, stiffness * hardening / total, -kInf, kInf, sign});
    }
    void flow(double e) {
        if (phase.direction && kind == Kind::bilinear) plastic = (prestress + stiffness * e - phase.direction * limit) / (stiffness + hardening);
    }
};

// Distance of two points about a foot: L^2 = L0^2 + 4 s (B s - C c), with s and c of half the rotation. An infinite L0
// is a fixed direction parallel to the floor; B and C are then divided by L0.
struct Lever {
    double length, along, across, radius, at_rest;
    bool linear, parallel;

    Lever(const double* c, int side, bool is_linear)
        : length(c[0]), along(c[1]), across(c[2]), radius(side * std::sqrt(c[1])), linear(is_linear), parallel(c[0] == kInf) {
        at_rest = parallel ? -across : length != 0.0 ? -across / length : radius;
    }
    double elongation(double rotation) const {
        return linear ? at_rest * rotation : elongation(std::sin(0.5 * rotation), std::cos(0.5 * rotation));
    }
    double elongation(double s, double c) const {  // s, c: sine and cosine of half the rotation
        if (length == 0.0) return 2.0 * radius * s;  // Eq. 344
        const double change = 4.0 * s * (along * s - across * c);
        if (parallel) return 0.5 * change;  // Eq. 364
        return change / (length + std::sqrt(length * length + change));  // Eq. 343
    }
    double slope(double rotation) const {
        if (linear) return at_rest;
        if (length == 0.0) return radius * std::cos(0.5 * rotation);
        const double arm = along * std::sin(rotation) - across * std::cos(rotation);
        return parallel ? arm : arm / (length + elongation(rotation));  // Eq. 345
    }
};

struct Device {
    Law law;
    Lever levers[2];  // about the right foot, about the left foot
    double work = 0.0, elongation = 0.0, rate = 0.0, largest_force = -kInf, smallest_force = kInf, largest_elongation = 0.0, smallest_elongation = 0.0, start_energy;

    Device(const double* c, bool linear) : law(Law::of(c)), levers{Lever(c + 7, 1, linear), Lever(c + 10, -1, linear)}, start_energy(law.stored(0.0)) {}

    double force() const {
        const double viscous = law.coefficient != 0.0 ? law.coefficient * (law.exponent == 1.0 ? std::fabs(rate) : std::pow(std::fabs(rate), law.exponent)) : 0.0;
        return law.phase.force(elongation) + std::copysign(viscous, rate);
    }
    void note() {
        note_force(force());
        largest_elongation = std::max(largest_elongation, elongation), smallest_elongation = std::min(smallest_elongation, elongation);
    }
    void note_force(double f) {
        if (law.touches()) f = std::min(f, 0.0);  // without rounding at the end of the contact
        largest_force = std::max(largest_force, f), smallest_force = std::min(smallest_force, f);
    }
    void move(double e, double v) {
        work += law.phase.work(elongation, e);
        elongation = e, rate = v;
        note();
    }
    // Changes from the upright state to the initial state, without dynamics.
    void load(double e) {
        const bool up = e > 0.0;
        if (e != 0.0) law.settle(0.0, up ? 1 : -1);
        while (!(law.phase.low <= e && e <= law.phase.high)) law.cross(up ? law.phase.high : law.phase.low, up);
        elongation = e, start_energy = law.stored(e);
        note();
    }
    double dissipated() { return start_energy + work - law.stored(elongation) - law.lost; }
};

}  // namespace rocking::restrained
