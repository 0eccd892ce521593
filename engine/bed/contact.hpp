// The bed: state of each contact point, and the force of all points on the body.
#pragma once
#include <cmath>
#include <cstdint>
#include <vector>

#include "radau.hpp"

// The compiler makes two versions of a loop over points, if the choice between them is possible at run time.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__GLIBC__)
#define ROCKING_BED_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define ROCKING_BED_CLONES
#endif

namespace rocking::bed {

enum Law : int { kKelvinVoigt = 0, kHuntCrossley = 1, kPlastic = 2 };
enum Friction : int { kSticking = 0, kCoulomb = 1, kRegularised = 2 };
// Modes of a point. away: no contact. pressing: loading. lagging: no force, since the bed recovers slower than the body
// rises. spring: unloading.
enum class Mode : std::uint8_t { away, pressing, lagging, spring };

struct Points {  // at: positions, positive towards the new foot. share: weights of the points in the contact law.
    std::int64_t count = 0;
    const double *at = nullptr, *height = nullptr, *share = nullptr;
};

struct Problem {
    double mass, inertia, height, gravity, push;  // push: horizontal ground acceleration
    double stiffness, damping, exponent, viscosity, rebound, friction, creep;
    Law law;
    Friction kind;
    bool exact;
    Points points;
};

// y, theta: height and rotation of the base centre; u, w, omega: velocities along and across the base, rotation rate
using State = Vector<5>;
enum { kY, kTheta, kU, kW, kOmega };

struct Place {  // position of the base: gap of a point = y - s sigma + zeta kappa, and its rate
    double y, sigma, kappa, dy, dsigma, dkappa, sine, cosine;
    double gap(double s, double zeta) const { return y - s * sigma + zeta * kappa; }  // Eq. 122
    double rate(double s, double zeta) const { return dy - s * dsigma + zeta * dkappa; }
};

inline void sine_and_cosine(double angle, double& s, double& c) {
    const double q = angle * angle;
    if (q < 0.01) {  // rotations in an impact are smaller; the omitted terms are below 1e-19
        s = angle * (1.0 + q * (-1.0 / 6.0 + q * (1.0 / 120.0 + q * (-1.0 / 5040.0 + q * (1.0 / 362880.0 - q / 39916800.0)))));
        c = 1.0 + q * (-0.5 + q * (1.0 / 24.0 + q * (-1.0 / 720.0 + q * (1.0 / 40320.0 - q / 3628800.0))));
        return;
    }
    s = std::sin(angle);
    c = std::cos(angle);
}

inline Place place(const State& x, bool exact) {
    double s, c;
    sine_and_cosine(x[kTheta], s, c);
    if (!exact) return {x[kY], x[kTheta], 1.0, x[kW], x[kOmega], 0.0, s, c};
    return {x[kY], s, c, x[kW] * c - x[kU] * s, c * x[kOmega], -s * x[kOmega], s, c};
}

// Sums over all points. With them the cost of a linear law does not depend on the number of points.
struct Sums {
    double one = 0, s = 0, ss = 0, z = 0, sz = 0, zz = 0;
    void add(double k, double at, double height) {
        one += k;
        s += k * at;
        ss += k * at * at;
        z += k * height;
        sz += k * at * height;
        zz += k * height * height;
    }
    double product(double y, double g, double k, double y2, double g2, double k2) const {
        return one * y * y2 + ss * g * g2 + zz * k * k2 - s * (y * g2 + y2 * g) + z * (y * k2 + y2 * k) - sz * (g * k2 + g2 * k);
    }
};

struct Load {  // resultant, its moments with s and zeta, power lost in the bed, and for power laws the stored energy
    double force = 0, moment = 0, tilt = 0, loss = 0, stored = 0;
};

// Touching points of a power law, in columns. pressing: 1, or 0 if the point is lagging.
struct Touching {
    static constexpr std::size_t kLanes = 8;
    std::vector<double> at, height, stiffness, pressing;
    std::size_t size() const { return at.size(); }
    void clear() {
        for (auto* column : {&at, &height, &stiffness, &pressing}) column->clear();
    }
    void add(double s, double z, double k, double on) {
        at.push_back(s), height.push_back(z), stiffness.push_back(k), pressing.push_back(on);
    }
};

// Computes several points at a time. Every lane has its own sum. Therefore all instruction sets give the same bits.
ROCKING_BED_CLONES inline Load sum_of_powers(const Touching& t, const Place& x, double viscosity) {
    constexpr std::size_t n = Touching::kLanes;
    double force[n] = {}, moment[n] = {}, tilt[n] = {}, loss[n] = {}, stored[n] = {};
    const double *at = t.at.data(), *height = t.height.data(), *stiffness = t.stiffness.data(), *pressing = t.pressing.data();
    for (std::size_t i = 0; i < t.size(); i += n)
        for (std::size_t j = 0; j < n; ++j) {
            const double s = at[i + j], z = height[i + j];
            const double gap = x.y - s * x.sigma + z * x.kappa, v = s * x.dsigma - x.dy - z * x.dkappa;
            const double d = gap < 0.0 ? -gap : 0.0, spring = stiffness[i + j] * d * std::sqrt(d);
            const double f = pressing[i + j] * spring * (1.0 + viscosity * v);
            force[j] += f;
            moment[j] += f * s;
            tilt[j] += f * z;
            loss[j] += (f - spring) * v;
            stored[j] += 0.4 * spring * d;
        }
    Load l;
    for (std::size_t j = 0; j < n; ++j) {
        l.force += force[j];
        l.moment += moment[j];
        l.tilt += tilt[j];
        l.loss += loss[j];
        l.stored += stored[j];
    }
    return l;
}

class Bed {
public:
    explicit Bed(const Problem& p) : p_(p), mode(p.points.count, Mode::away), deepest(p.points.count, 0.0) {
        for (std::int64_t i = 0; i < p.points.count; ++i) flat = flat && p.points.height[i] == 0.0;
        affine = flat && p.law != kPlastic;
    }

    bool linear() const { return p_.law != kHuntCrossley; }
    double gap(std::int64_t i, const Place& x) const { return x.gap(p_.points.at[i], p_.points.height[i]); }
    double rate(std::int64_t i, const Place& x) const { return x.rate(p_.points.at[i], p_.points.height[i]); }
    double set(std::int64_t i) const { return p_.law == kPlastic ? (1.0 - p_.rebound * p_.rebound) * deepest[i] : 0.0; }

    void gather() {  // required after every switch
        elastic_ = viscous_ = lost_ = Sums{};
        offset_ = offset_s_ = offset_z_ = 0.0;
        pressing = 0;
        touching_.clear();
        middle_s_ = middle_z_ = 0.0;
        for (std::int64_t i = p_.points.count; linear() && i-- > 0;)
            if (mode[i] != Mode::away) middle_s_ = p_.points.at[i], middle_z_ = p_.points.height[i];
        for (std::int64_t i = 0; i < p_.points.count; ++i) {
            const double share = p_.points.share[i], k = p_.stiffness * share;
            if (mode[i] == Mode::pressing || mode[i] == Mode::spring) ++pressing;
            const double s = p_.points.at[i] - middle_s_, z = p_.points.height[i] - middle_z_;
            if (!linear()) {
                if (mode[i] != Mode::away) touching_.add(s, z, k, mode[i] == Mode::pressing ? 1.0 : 0.0);
                continue;
            }
            if (mode[i] == Mode::lagging) lost_.add(-k, s, z);
            if (mode[i] == Mode::pressing) {
                elastic_.add(k, s, z);
                if (p_.law == kKelvinVoigt) viscous_.add(p_.damping * share, s, z);
                if (p_.law == kPlastic) lost_.add((1.0 - p_.rebound * p_.rebound) * k, s, z);
            }
            if (mode[i] == Mode::spring) {
                const double hard = k / (p_.rebound * p_.rebound), back = hard * set(i);
                elastic_.add(hard, s, z);
                offset_ += back;
                offset_s_ += back * s;
                offset_z_ += back * z;
            }
        }
        while (touching_.size() % Touching::kLanes != 0) touching_.add(0.0, 0.0, 0.0, 0.0);
    }

    Load load(const Place& x) const {
        if (!linear()) return sum_over_points(x);
        const auto of = [](const Sums& a, double y, double g, double k, double& f, double& m, double& t) {
            f -= a.one * y - a.s * g + a.z * k;
            m -= a.s * y - a.ss * g + a.sz * k;
            t -= a.z * y - a.sz * g + a.zz * k;
        };
        const double y = x.gap(middle_s_, middle_z_), dy = x.rate(middle_s_, middle_z_);
        Load l{-offset_, -offset_s_, -offset_z_, 0.0};
        of(elastic_, y, x.sigma, x.kappa, l.force, l.moment, l.tilt);
        of(viscous_, dy, x.dsigma, x.dkappa, l.force, l.moment, l.tilt);
        l.moment += middle_s_ * l.force;
        l.tilt += middle_z_ * l.force;
        l.loss = viscous_.product(dy, x.dsigma, x.dkappa, dy, x.dsigma, x.dkappa) +
                 lost_.product(y, x.sigma, x.kappa, dy, x.dsigma, x.dkappa);
        return l;
    }

    double force(std::int64_t i, const Place& x) const {
        if (mode[i] == Mode::away || mode[i] == Mode::lagging) return 0.0;
        const double share = p_.points.share[i], d = -gap(i, x), v = -rate(i, x);
        if (mode[i] == Mode::spring) return p_.stiffness * share / (p_.rebound * p_.rebound) * (d - set(i));  // Eq. 120
        if (p_.law == kPlastic) return p_.stiffness * share * d;
        if (p_.law == kKelvinVoigt) return share * (p_.stiffness * d + p_.damping * v);  // Eq. 117
        return d > 0.0 ? share * p_.stiffness * power(d) * (1.0 + p_.viscosity * v) : 0.0;  // Eq. 118
    }

    double stored(std::int64_t i, const Place& x) const {
        const double share = p_.points.share[i], d = -gap(i, x);
        if (mode[i] == Mode::away || d <= 0.0) return 0.0;
        if (p_.law == kPlastic) {
            const double f = force(i, x);
            return p_.rebound > 0.0 ? 0.5 * f * f * p_.rebound * p_.rebound / (p_.stiffness * share) : 0.0;
        }
        if (p_.law == kKelvinVoigt) return 0.5 * share * p_.stiffness * d * d;
        return share * p_.stiffness * power(d) * d / (p_.exponent + 1.0);  // Eq. 121
    }

    // Margin `which` (0 or 1) of point i: positive as long as the mode of the point remains valid.
    double margin(std::int64_t i, int which, const Place& x) const {
        const double d = -gap(i, x);
        switch (mode[i]) {
            case Mode::away: return which == 0 ? set(i) - d : 1.0;
            case Mode::pressing:
                if (p_.law == kPlastic) return which == 0 ? -rate(i, x) : 1.0;
                if (which == 1) return p_.law == kHuntCrossley ? d : 1.0;
                return push(d, -rate(i, x));
            case Mode::lagging: return which == 0 ? -push(d, -rate(i, x)) : d;
            default: return which == 0 ? deepest[i] - d : d - set(i);
        }
    }

    // Margins of point i at the start and the nodes of a step; returns their number.
    template <std::size_t K>
    int margins(std::int64_t i, const Place (&x)[K], double (&g)[2][K]) const {
        const double s = p_.points.at[i], z = p_.points.height[i];
        if (mode[i] == Mode::away) {
            const double from = set(i);
            for (std::size_t k = 0; k < K; ++k) g[0][k] = from + x[k].gap(s, z);
            return 1;
        }
        const bool is_single = mode[i] == Mode::pressing && p_.law != kHuntCrossley;
        if (is_single && p_.law == kKelvinVoigt) {
            for (std::size_t k = 0; k < K; ++k) g[0][k] = -(p_.stiffness * x[k].gap(s, z) + p_.damping * x[k].rate(s, z));
            return 1;
        }
        for (int which = 0; which < (is_single ? 1 : 2); ++which)
            for (std::size_t k = 0; k < K; ++k) g[which][k] = margin(i, which, x[k]);
        return is_single ? 1 : 2;
    }

    // changes the mode of point i after its margin `which` has reached zero
    void change(std::int64_t i, int which, const Place& x) {
        switch (mode[i]) {
            case Mode::away: mode[i] = p_.law == kPlastic && deepest[i] > 0.0 && p_.rebound > 0.0 ? Mode::spring : Mode::pressing; break;
            case Mode::pressing:
                if (p_.law == kPlastic) {
                    deepest[i] = std::max(deepest[i], -gap(i, x));
                    mode[i] = p_.rebound > 0.0 ? Mode::spring : Mode::away;
                } else {
                    const bool slow = p_.law == kKelvinVoigt ? p_.damping > 0.0 : which == 0;
                    mode[i] = slow ? Mode::lagging : Mode::away;
                }
                break;
            case Mode::lagging: mode[i] = which == 0 ? Mode::pressing : Mode::away; break;
            default: mode[i] = which == 0 ? Mode::pressing : Mode::away;
        }
    }

    void begin(const Place& x) {
        for (std::int64_t i = 0; i < p_.points.count; ++i) {
            const double d = -gap(i, x), v = -rate(i, x);
            mode[i] = Mode::away;
            if (d < 0.0 || (d == 0.0 && v <= 0.0)) continue;
            mode[i] = Mode::pressing;
            if (p_.law == kPlastic && v <= 0.0) {
                deepest[i] = d;
                mode[i] = p_.rebound > 0.0 ? Mode::spring : Mode::away;
            } else if (p_.law != kPlastic && push(d, v) <= 0.0) {
                mode[i] = Mode::lagging;
            }
        }
    }

private:
    const Problem& p_;
    Sums elastic_, viscous_, lost_;
    double offset_ = 0.0, offset_s_ = 0.0, offset_z_ = 0.0;
    // sums refer to a touching point; about the base centre the rounding errors would be larger than the gaps
    double middle_s_ = 0.0, middle_z_ = 0.0;

    double power(double d) const { return p_.exponent == 1.5 ? d * std::sqrt(d) : std::pow(d, p_.exponent); }
    double push(double d, double v) const {
        return p_.law == kKelvinVoigt ? p_.stiffness * d + p_.damping * v : 1.0 + p_.viscosity * v;
    }
    Load sum_over_points(const Place& x) const {
        if (p_.exponent == 1.5) return sum_of_powers(touching_, x, p_.viscosity);
        Load l;
        for (std::size_t i = 0; i < touching_.size(); ++i) {
            const double at = touching_.at[i], height = touching_.height[i], pressing = touching_.pressing[i];
            const double d = -x.gap(at, height), v = -x.rate(at, height);
            if (d <= 0.0) continue;
            const double spring = touching_.stiffness[i] * power(d), f = pressing * spring * (1.0 + p_.viscosity * v);
            l.force += f;
            l.moment += f * at;
            l.tilt += f * height;
            l.loss += (f - spring) * v;
            l.stored += spring * d / (p_.exponent + 1.0);
        }
        return l;
    }

    Touching touching_;

public:
    std::vector<Mode> mode;
    std::vector<double> deepest;
    std::int64_t pressing = 0;
    bool flat = true, affine = true;  // true if the margins of points of the same mode are linear along the base
};

}  // namespace rocking::bed
