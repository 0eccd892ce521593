// Motion, forces and heights of the feet in one mode, as power series of the time. The time interval is scaled to 0 ...
// 1.
#pragma once
#include "base.hpp"

namespace rocking::contact {

constexpr int kMost = 24, kTerms = kMost + 1, kGround = 8;

// a_x and g + a_z over a unit of time; small: size below which the terms of a series are negligible
struct Ground {
    double push[kGround] = {}, lift[kGround] = {}, unit = 0.0, small = 1e-16;
    int terms = 1;
    double weight() const { return std::max(std::fabs(lift[0]) + std::fabs(push[0]), 1e-3); }
};

struct Series {
    double unit, stiff;
    int n;            // number of terms
    bool converged;   // true if the truncation error is below rounding
    double rotation[kTerms], x[kTerms], rise[kTerms], tangential[kTerms], sliding[kTerms], normal[3][kTerms], gap[3][kTerms];
};

inline double value(const double* c, int n, double at) {
    double total = 0.0;
    for (int k = n; k-- > 0;) total = total * at + c[k];
    return total;
}
inline double slope(const double* c, int n, double at) {
    double total = 0.0;
    for (int k = n - 1; k > 0; --k) total = total * at + k * c[k];
    return total;
}

// Series of a position from its acceleration, with the value and the rate at the start.
inline void twice(const double* a, int n, double start, double rate, double unit, double* result) {
    result[0] = start, result[1] = rate * unit;
    for (int k = 2; k < n; ++k) result[k] = a[k - 2] * unit * unit / (k * (k - 1.0));
}

inline void flat(const Base& b, const State& s, Mode m, const Ground& g, double mu, Series& c) {
    const int n = c.n = g.terms + 2;
    double a[kTerms] = {};
    for (int k = 0; k < n; ++k) {
        const double push = k < g.terms ? g.push[k] : 0.0, weight = k < g.terms ? g.lift[k] : 0.0;
        c.tangential[k] = m.slip ? -m.slip * mu * weight : push;
        a[k] = c.tangential[k] - push;
        const double turn = c.tangential[k] * b.height;
        c.normal[kLeft][k] = (weight * b.lever[kRight] + turn) / b.width();    // Eq. 63
        c.normal[kRight][k] = (weight * -b.lever[kLeft] - turn) / b.width();  // Eq. 63
        c.rotation[k] = c.rise[k] = c.x[k] = c.sliding[k] = 0.0;
    }
    c.x[0] = s.x, c.stiff = 1.0, c.converged = true;
    if (!m.slip) return;
    twice(a, n, s.x, s.u, g.unit, c.x);
    for (int k = 0; k + 1 < n; ++k) c.sliding[k] = (k + 1) * c.x[k + 1] / g.unit;
}

inline void flight(const Base& b, const State& s, const Ground& g, int order, Series& c) {
    double a[kTerms] = {}, up[kTerms] = {}, sine, cosine, half, unused;
    for (int k = 0; k < g.terms; ++k) a[k] = -g.push[k], up[k] = -g.lift[k];
    sine_cosine(s.rotation, sine, cosine), sine_cosine(0.5 * s.rotation, half, unused);
    const double turns[4] = {sine, cosine, -sine, -cosine}, lowers[4] = {-cosine, sine, cosine, -sine};
    double power = 1.0, sines[kTerms], lowered[kTerms];
    const int forcing_terms = g.terms + 2;
    int n = 0;
    c.converged = false;
    for (; n <= order; ++n) {
        if (n) power *= s.spin * g.unit / n;
        sines[n] = power * turns[n % 4], lowered[n] = power * lowers[n % 4];
        if (n >= forcing_terms && std::fabs(power) < 0.01 * g.small) {
            c.converged = true, ++n;
            break;
        }
    }
    c.n = n, c.stiff = 1.0;
    lowered[0] = 2.0 * half * half;
    twice(a, n, s.x, s.u, g.unit, c.x), twice(up, n, s.rise, s.w, g.unit, c.rise);  // Eq. 64
    for (int foot : {kLeft, kRight}) {
        for (int k = 0; k < n; ++k) c.gap[foot][k] = c.rise[k] - b.lever[foot] * sines[k] + b.height * lowered[k];  // Eq. 65
        if (s.touching & foot) c.gap[foot][0] = 0.0, c.gap[foot][1] = away(b, s, foot) * g.unit;
    }
    for (int k = 0; k < n; ++k) c.rotation[k] = c.tangential[k] = c.sliding[k] = 0.0;
    c.rotation[0] = s.rotation, c.rotation[1] = s.spin * g.unit;
}

// One foot in contact, sticking or sliding: recursions for the arm and the rotation.
inline void pivoting(const Base& b, const State& s, Mode m, const Ground& g, double mu, int order, Series& c) {
    const double j = b.inertia, unit2 = g.unit * g.unit, pull = m.slip * mu;
    const Arm r = arm(b, b.lever[m.feet], s.rotation);
    double x[kTerms], z[kTerms], turn[kTerms], level[kTerms], stiff[kTerms], square[kTerms], force[kTerms], found[kTerms];
    x[0] = r.x, z[0] = r.z, turn[0] = s.spin * g.unit;
    c.rotation[0] = s.rotation, c.rotation[1] = turn[0];
    c.stiff = m.slip ? (r.x * (r.x + pull * r.z) + j) / (j + r.x * r.x) : 1.0;
    const double compliance = unit2 / (j + r.x * r.x + r.z * r.z), nothing = g.small * g.weight() * unit2 / b.size;
    int small = 0, k = 0;
    c.converged = false;
    for (; k + 2 <= order; ++k) {
        const int most = std::min(k, g.terms - 1);
        if (!m.slip) {
            double moment = 0.0;
            for (int i = 0; i <= most; ++i) moment += g.lift[i] * x[k - i] - g.push[i] * z[k - i];
            found[k] = -moment * compliance;  // Eq. 66
        } else {
            level[k] = x[k] + pull * z[k];
            double product = k ? 0.0 : j, twofold = 0.0, down = k < g.terms ? g.lift[k] * unit2 : 0.0, known = 0.0;
            for (int i = 0; i <= k; ++i) product += x[i] * level[k - i], twofold += turn[i] * turn[k - i];
            stiff[k] = product, square[k] = twofold;
            for (int i = 0; i <= k; ++i) down += z[i] * square[k - i];
            force[k] = down;
            for (int i = 0; i <= k; ++i) known += level[i] * force[k - i];
            for (int i = 1; i <= k; ++i) known += stiff[i] * found[k - i];
            found[k] = -known / stiff[0];  // Eq. 67
        }
        turn[k + 1] = found[k] / (k + 1);
        c.rotation[k + 2] = turn[k + 1] / (k + 2);
        double right = 0.0, up = 0.0;
        for (int i = 0; i <= k; ++i) right += turn[i] * z[k - i], up += turn[i] * x[k - i];
        x[k + 1] = right / (k + 1), z[k + 1] = -up / (k + 1);  // Eq. 68
        small = std::fabs(found[k]) <= nothing && k >= g.terms ? small + 1 : 0;
        if (small == 2) {
            c.converged = true;
            ++k;
            break;
        }
    }
    const int n = c.n = k + 2;  // the rotation has coefficients 0 to k + 1, the arm has 0 to k
    x[k + 1] = z[k + 1] = 0.0;
    double* normal = c.normal[m.feet];
    double a[kTerms];
    for (int i = 0; i < n; ++i) {
        const double push = i < g.terms ? g.push[i] : 0.0, lift = i < g.terms ? g.lift[i] : 0.0;
        const double scale = (i + 1.0) * (i + 2.0) / unit2;
        c.rise[i] = -z[i];
        normal[i] = lift - (i + 2 <= k ? scale * z[i + 2] : 0.0);
        c.tangential[i] = m.slip ? -pull * normal[i] : push - (i + 2 <= k ? scale * x[i + 2] : 0.0);
        c.x[i] = -x[i], c.sliding[i] = 0.0;
        a[i] = c.tangential[i] - push;
        c.gap[kBoth - m.feet][i] = m.feet == kRight ? c.rotation[i] : -c.rotation[i];
    }
    c.rise[0] = s.rise, c.x[0] = s.x;
    if (!m.slip) return;
    twice(a, n, s.x, s.u, g.unit, c.x);
    for (int i = 0; i + 1 < n; ++i) c.sliding[i] = (i + 1) * (c.x[i + 1] + x[i + 1]) / g.unit;
    c.sliding[0] = along(b, s, m.feet);
}

inline void series_of(const Base& b, const State& s, Mode m, const Ground& g, double mu, int order, Series& c) {
    c.unit = g.unit;
    if (!m.feet) return flight(b, s, g, order, c);
    if (m.feet == kBoth) return flat(b, s, m, g, mu, c);
    pivoting(b, s, m, g, mu, order, c);
}

}  // namespace rocking::contact
