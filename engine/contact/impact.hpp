// Impacts. Newton's law uses complementarity on both feet. Poisson's and Stronge's laws use an impulse that grows at
// one point (Routh). There are also an imposed coefficient, and the shock of a sliding foot without a possible contact
// force (Painleve).
#pragma once
#include "base.hpp"

namespace rocking::contact {

constexpr double kRounding = 1e-13;

struct Law {
    // mu, e, coefficients for landing left [1] and right [2]; NaN if there is no coefficient
    double friction, bounce, imposed[3];
    Bounce kind;
};

struct Struck {
    State state;
    double normal[3] = {}, tangential = 0.0;
    int slip = 0;
};

class Impact {
  public:
    Impact(const Base& base, const State& before, const Law& law) : b_(base), s_(before), law_(law) {
        for (int foot : {kLeft, kRight}) arm_[foot] = arm(b_, b_.lever[foot], s_.rotation), away_[foot] = away(s_, arm_[foot]);
        speed_ = largest_speed(b_, s_);
    }

    // Impact with coefficient e of each foot; stands_in becomes true if another law replaces the requested law.
    bool resolve(const double (&bounce)[3], Struck& struck, bool& stands_in) const {
        stands_in = false;
        if (law_.kind == Bounce::newton ? newton(bounce, struck, true) : grown(bounce, law_.kind, struck)) return true;
        stands_in = true;
        return grown(bounce, Bounce::stronge, struck);
    }

    // A foot slides, and no force satisfies Coulomb's law: the impulse of the foot grows until the foot sticks.
    bool shock(Struck& struck) const {
        for (int foot : {kLeft, kRight}) {
            if (!(s_.touching & foot) || away_[foot] != 0.0) continue;
            const double speed = along(s_, arm_[foot]);
            const Delassus a = at(arm_[foot]);
            const int slip = speed > 0.0 ? 1 : -1;
            if (speed == 0.0 || a.nn - slip * law_.friction * a.nt > 1e-6) continue;
            struck = grow(arm_[foot], foot, law_.kind == Bounce::newton ? 0.0 : law_.bounce, law_.kind, true);
            if (dissipates(struck) && leaves(struck)) return true;
            struck = grow(arm_[foot], foot, 0.0, Bounce::stronge, true);
            return dissipates(struck) && leaves(struck);
        }
        return false;
    }

    // Imposes theta_dot_after / theta_dot_before on a rocking impact; false if the impulse would be tensile or energy
    // would increase.
    bool imposed(int foot, double r, Struck& struck) const {
        const double j = b_.inertia, h = b_.height, d = b_.lever[foot];
        const double arm = (foot == kRight ? 1.0 : -1.0) * (1.0 - r) * (j + h * h) / (std::fabs(b_.lever[kBoth - foot]) + r * std::fabs(d));  // Eq. 4
        const double slack = 1e-12 * (std::fabs(away_[foot]) + std::fabs(along(s_, arm_[foot])));
        double spin = (j * s_.spin + h * s_.u + arm * s_.w) / (j + h * h + arm * d);  // Eq. 74
        if (std::fabs(spin) <= 1e-12 * std::fabs(s_.spin)) spin = 0.0;
        struck.state = s_, struck.state.u = h * spin, struck.state.w = d * spin, struck.state.spin = spin;
        struck.slip = 0, struck.tangential = struck.state.u - s_.u;
        double total = struck.state.w - s_.w;
        if (std::fabs(struck.tangential) > law_.friction * total + slack) {
            int valid = 0;
            Struck slid;
            for (int slip : {1, -1}) {
                const double pull = slip * law_.friction, turn = (pull * h - arm) / j, stiff = 1.0 - d * turn;
                if (!(stiff > 0.0)) continue;
                const double normal = (d * s_.spin - s_.w) / stiff;  // Eq. 75
                Struck candidate;
                candidate.state = s_, candidate.state.spin = s_.spin + turn * normal;
                candidate.state.u = s_.u - pull * normal, candidate.state.w = d * candidate.state.spin;
                candidate.tangential = -(pull * normal), candidate.slip = slip;
                if (slip * along(candidate.state, arm_[foot]) >= -slack) slid = candidate, total = normal, ++valid;
            }
            if (valid != 1) return false;
            struck = slid;
        }
        share(struck, arm, total);
        if (total < -slack || away(struck.state, arm_[kBoth - foot]) < -slack) return false;
        return !(kinetic(b_, struck.state) > kinetic(b_, s_) * (1.0 + 1e-12));
    }

  private:
    struct Delassus {
        double nn, nt, tt;
    };
    Delassus at(Arm r) const { return {1.0 + r.x * r.x / b_.inertia, -r.x * r.z / b_.inertia, 1.0 + r.z * r.z / b_.inertia}; }

    void share(Struck& s, double arm, double normal) const {
        s.normal[kLeft] = normal * (b_.lever[kRight] - arm) / b_.width();
        s.normal[kRight] = normal * (arm - b_.lever[kLeft]) / b_.width();
    }
    bool dissipates(const Struck& s) const { return !(kinetic(b_, s.state) > kinetic(b_, s_) * (1.0 + 10.0 * kRounding)); }
    bool leaves(const Struck& s) const {
        for (int foot : {kLeft, kRight})
            if ((s_.touching & foot) && away(s.state, arm_[foot]) < -kRounding * speed_) return false;
        return true;
    }

    // Newton's law: all combinations of feet and sliding directions are tested. If `single` is true, the function
    // returns false for two different solutions.
    bool newton(const double (&bounce)[3], Struck& struck, bool single) const {
        double target[3];
        for (int foot : {kLeft, kRight}) target[foot] = -bounce[foot] * away_[foot];  // Eq. 70
        bool any = false;
        for (int slip : {0, 1, -1})
            for (int feet : {kLeft, kRight, kBoth}) {
                Struck candidate;
                if ((s_.touching & feet) != feet || !solution(feet, slip, target, candidate) || !valid(candidate, feet, target)) continue;  // Eq. 20
                if (!any) {
                    struck = candidate, any = true;
                    if (!single) return true;
                    continue;
                }
                const State &p = struck.state, &q = candidate.state;
                if (std::max({std::fabs(p.u - q.u), std::fabs(p.w - q.w), b_.height * std::fabs(p.spin - q.spin)}) > 1e-8 * speed_) return false;
            }
        return any && dissipates(struck);
    }

    bool solution(int feet, int slip, const double (&target)[3], Struck& candidate) const {
        const double j = b_.inertia, pull = slip * law_.friction;
        State& a = candidate.state;
        a = s_, candidate.slip = slip;
        if (feet == kBoth) {
            const double left = -b_.lever[kLeft], right = b_.lever[kRight], width = b_.width();
            a.spin = (target[kLeft] - target[kRight]) / width;  // Eq. 73
            a.w = (target[kLeft] * right + target[kRight] * left) / width;
            const double total = a.w - s_.w;
            a.u = slip ? s_.u - pull * total : b_.height * a.spin;
            candidate.tangential = a.u - s_.u;
            const double turn = candidate.tangential * b_.height + j * (a.spin - s_.spin);
            candidate.normal[kLeft] = (total * right + turn) / width, candidate.normal[kRight] = (total * left - turn) / width;  // Eq. 73
            return true;
        }
        const Arm r = arm_[feet];
        if (!slip) {
            a.spin = (j * s_.spin - r.z * s_.u + r.x * (s_.w - target[feet])) / (j + r.x * r.x + r.z * r.z);  // Eq. 71
            a.u = -(r.z * a.spin), a.w = target[feet] + r.x * a.spin;
            candidate.normal[feet] = a.w - s_.w, candidate.tangential = a.u - s_.u;
            return true;
        }
        const double level = r.x + pull * r.z, stiff = 1.0 + r.x * level / j;
        if (!(stiff > 0.0)) return false;
        const double normal = (target[feet] - away_[feet]) / stiff;  // Eq. 72
        a.spin = s_.spin - normal * level / j, a.u = s_.u - pull * normal, a.w = target[feet] + r.x * a.spin;
        candidate.normal[feet] = normal, candidate.tangential = -(pull * normal);
        return true;
    }

    bool valid(const Struck& candidate, int feet, const double (&target)[3]) const {
        const double slack = kRounding * speed_;
        double total = 0.0;
        for (int foot : {kLeft, kRight}) {
            if ((feet & foot) && !(candidate.normal[foot] >= -slack)) return false;
            if ((s_.touching & foot) && !(away(candidate.state, arm_[foot]) >= target[foot] - slack)) return false;
            if (feet & foot) total += candidate.normal[foot];
        }
        if (candidate.slip) return candidate.slip * along(candidate.state, arm_[feet == kBoth ? kLeft : feet]) >= -slack;
        return std::fabs(candidate.tangential) <= law_.friction * total + slack * (1.0 + law_.friction);
    }

    // Poisson's or Stronge's law at the landing foot. If this presses the other foot into the ground, the impulse acts
    // between the feet, at the resultant of the plastic impact. If this also presses a foot into the ground, the impact
    // is plastic.
    bool grown(const double (&bounce)[3], Bounce kind, Struck& struck) const {
        const bool falls[3] = {false, (s_.touching & kLeft) && away_[kLeft] < 0.0, (s_.touching & kRight) && away_[kRight] < 0.0};
        if (falls[kLeft] != falls[kRight]) {
            const int foot = falls[kRight] ? kRight : kLeft;
            struck = grow(arm_[foot], foot, bounce[foot], kind);
            if (leaves(struck)) return dissipates(struck);
        }
        const double none[3] = {0.0, 0.0, 0.0};
        Struck plastic;
        if (!newton(none, plastic, false)) return false;
        struck = plastic;
        const double left = plastic.normal[kLeft], right = plastic.normal[kRight], e = std::max(bounce[kLeft], bounce[kRight]);
        if (!(left > 0.0 && right > 0.0)) return dissipates(struck);
        const double arm = (left * b_.lever[kLeft] + right * b_.lever[kRight]) / (left + right);
        const Struck both = grow({arm, -b_.height, 0.0}, 0, e, kind);
        if (e > 0.0 && leaves(both)) struck = both, share(struck, arm, both.normal[0]);
        return dissipates(struck);
    }

    // The impulse at one point grows, with sliding or sticking, to the end of compression, then to the end of
    // restitution.
    Struck grow(Arm r, int foot, double e, Bounce kind, bool shocked = false) const {
        const Delassus a = at(r);
        const double mu = law_.friction;
        double vn = away(s_, r), vt = along(s_, r), normal = 0.0, tangential = 0.0, taken = 0.0, left = 0.0;
        if (std::fabs(vt) <= kRounding * speed_) vt = 0.0;
        int slip = 0;
        bool restitution = false;
        for (int phase = 0; phase < 8; ++phase) {
            slip = vt > 0.0 ? 1 : vt < 0.0 ? -1 : std::fabs(a.nt) <= mu * a.tt ? 0 : a.nt > 0.0 ? 1 : -1;
            const double pull = slip ? -slip * mu : -a.nt / a.tt, up = a.nn + pull * a.nt, right = slip ? a.nt + pull * a.tt : 0.0;  // Eq. 236
            const double stops = vt * right < 0.0 ? -vt / right : HUGE_VAL;
            double ends = up > 0.0 && !(shocked && phase == 0) ? -vn / up : HUGE_VAL;
            if (restitution && kind == Bounce::poisson) ends = left;
            if (restitution && kind != Bounce::poisson) ends = 2.0 * left / (vn + std::sqrt(vn * vn + 2.0 * up * left));  // Eq. 238
            const bool is_complete = !(stops < ends);
            const double p = is_complete ? ends : stops;
            if (!std::isfinite(p)) break;
            const double work = (vn + 0.5 * up * p) * p;
            normal += p, tangential += pull * p, vn += up * p, vt = is_complete ? vt + right * p : 0.0;
            if (restitution) left -= kind == Bounce::poisson ? p : work;
            else taken -= work;
            if (!is_complete) continue;
            left = kind == Bounce::poisson ? e * normal : e * e * taken;  // Eq. 237, 238
            if (restitution || !(left > 0.0)) break;
            restitution = true, vn = 0.0;
        }
        Struck struck;
        struck.state = s_, struck.slip = slip;
        struck.state.u += tangential, struck.state.w += normal, struck.state.spin += (tangential * r.z - normal * r.x) / b_.inertia;
        struck.normal[foot] = normal, struck.tangential = tangential;
        return struck;
    }

    const Base& b_;
    const State& s_;
    const Law& law_;
    Arm arm_[3];
    double away_[3] = {}, speed_;
};

// The state after an impact, without rounding errors in velocities that are zero.
inline State cleaned(const Base& b, const State& s, double stop) {
    int resting = 0;
    for (int foot : {kLeft, kRight})
        if ((s.touching & foot) && std::fabs(away(b, s, foot)) <= stop) resting |= foot;
    if (!resting) return s;
    const bool stick = std::fabs(along(b, s, resting & kLeft ? kLeft : kRight)) <= stop;
    State after = kept(b, s, resting, stick);
    after.touching = s.touching;
    return after;
}

}  // namespace rocking::contact
