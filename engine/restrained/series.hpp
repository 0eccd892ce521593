// Taylor series of a body with restraints over one step; x = t / h is from 0 to 1.
#pragma once
#include "laws.hpp"

namespace rocking::restrained {

constexpr int kMost = 30, kGround = 8, kDevices = 64;

struct Equation {
    double side, alpha, p, inertia, top_sine, top_cosine;
    bool linear;
};

inline double value(const double* c, int n, double x) {
    double total = 0.0;
    for (int k = n; k-- > 0;) total = total * x + c[k];
    return total;
}
inline double slope(const double* c, int n, double x) {
    double total = 0.0;
    for (int k = n - 1; k > 0; --k) total = total * x + k * c[k];
    return total;
}
inline double product(const double* a, const double* b, int k) {  // coefficient of x^k
    double total = 0.0;
    for (int j = 0; j <= k; ++j) total += a[j] * b[k - j];
    return total;
}

// Series of one restraint.
struct Terms {
    double elongation[kMost + 1], slope[kMost + 1], rate[kMost + 1], viscous[kMost + 1], root[kMost + 1];
    bool is_viscous;
};

class Series {
  public:
    double theta[kMost + 1];
    // number of terms of theta; restraints and elongations of straight restraints have n - 1 terms
    int n = 0;
    bool ended = false;    // the last terms are below rounding
    Terms items[kDevices];

    explicit Series(double tolerance) : small_(1e-4 * tolerance) {}

    // push: a_x / g, weight: 1 + a_z / g, over the step.
    void expand(const Equation& q, double rotation, double velocity, double h, const double* push, const double* weight, int terms, const Device* devices, int count) {
        const int at = q.side > 0.0 ? 0 : 1;
        bool halves = false, ends_early = true;
        for (int i = 0; i < count; ++i) {
            const bool active = devices[i].law.coefficient != 0.0 && items[i].is_viscous;
            halves |= devices[i].levers[at].length == 0.0;
            ends_early &= !(active && devices[i].law.exponent != 1.0);
        }
        theta[0] = rotation, theta[1] = velocity * h;
        const double floor = small_ * std::max(q.alpha, std::fabs(rotation)), h2 = h * h, p2 = q.p * q.p, per_inertia = 1.0 / q.inertia;
        ended = false;
        double steps[kMost + 1];  // (j + 1) theta[j + 1]
        for (int k = 0; k < kMost - 1; ++k) {
            steps[k] = (k + 1) * theta[k + 1];
            trigonometry(k, rotation, steps, halves);
            const double sine = sines_[k], cosine = cosines_[k];
            falls_[k] = q.linear ? (k ? 0.0 : q.side * q.alpha) - theta[k] : q.top_sine * cosine - q.top_cosine * sine;
            arms_[k] = q.linear ? (k ? 0.0 : 1.0) : q.top_cosine * cosine + q.top_sine * sine;
            double moment = 0.0;
            for (int j = 0; j < terms && j <= k; ++j) moment += weight[j] * falls_[k - j] + push[j] * arms_[k - j];
            double acceleration = -p2 * moment;
            for (int i = 0; i < count; ++i) acceleration -= per_inertia * moment_of(k, devices[i].law, devices[i].levers[at], items[i], steps, h);
            theta[k + 2] = h2 * acceleration / ((k + 1) * (k + 2));  // Eq. 346
            n = k + 3;
            if (ends_early && k >= terms && std::fabs(theta[k + 2]) <= floor && std::fabs(theta[k + 1]) <= 100.0 * floor) {
                ended = true;
                return;
            }
        }
    }

  private:
    void trigonometry(int k, double rotation, const double* steps, bool halves) {
        if (k == 0) {
            const double s = half_sines_[0] = std::sin(0.5 * rotation), c = half_[0] = std::cos(0.5 * rotation);
            sines_[0] = 2.0 * s * c, cosines_[0] = 1.0 - 2.0 * s * s;
            return;
        }
        const double per = 1.0 / k;
        sines_[k] = per * product(steps, cosines_, k - 1), cosines_[k] = -per * product(steps, sines_, k - 1);
        if (halves) half_sines_[k] = 0.5 * per * product(steps, half_, k - 1), half_[k] = -0.5 * per * product(steps, half_sines_, k - 1);
    }

    double moment_of(int k, const Law& law, const Lever& lever, Terms& t, const double* steps, double h) const {
        const Phase& phase = law.phase;
        double moment;
        if (lever.linear) {
            t.slope[k] = k ? 0.0 : lever.at_rest, t.elongation[k] = lever.at_rest * theta[k];
            moment = lever.at_rest * (phase.stiffness * t.elongation[k] + (k ? 0.0 : phase.constant));
        } else {
            const double along = lever.along * sines_[k] - lever.across * cosines_[k];
            t.elongation[k] = k ? t.rate[k - 1] / k : lever.elongation(half_sines_[0], half_[0]);
            if (lever.parallel) {
                t.slope[k] = along;
            } else if (lever.length != 0.0) {
                double past = 0.0;
                for (int j = 1; j <= k; ++j) past += t.elongation[j] * t.slope[k - j];
                t.slope[k] = (along - past) / (lever.length + t.elongation[0]);  // Eq. 345
            } else {
                t.slope[k] = lever.radius * half_[k];
            }
            if (lever.parallel) moment = phase.constant * along + (phase.stiffness != 0.0 ? phase.stiffness * product(t.elongation, t.slope, k) : 0.0);
            else moment = (phase.constant - phase.stiffness * lever.length) * t.slope[k] + phase.stiffness * along;  // Eq. 347
        }
        t.rate[k] = product(steps, t.slope, k);
        if (law.coefficient == 0.0 || !t.is_viscous) return moment;
        if (law.exponent == 1.0) {
            t.viscous[k] = law.coefficient * t.rate[k] / h;
        } else {
            if (k == 0) {
                t.root[0] = std::pow(std::fabs(t.rate[0] / h), law.exponent);
            } else {
                double total = 0.0;
                for (int j = 1; j <= k; ++j) total += (law.exponent * j - (k - j)) * t.rate[j] * t.root[k - j];
                t.root[k] = total / (k * t.rate[0]);  // Eq. 348
            }
            t.viscous[k] = std::copysign(law.coefficient, t.rate[0]) * t.root[k];
        }
        return moment + product(t.viscous, t.slope, k);
    }

    double small_;  // size of the last terms / angle
    double sines_[kMost + 1], cosines_[kMost + 1], half_sines_[kMost + 1], half_[kMost + 1], falls_[kMost + 1], arms_[kMost + 1];
};

}  // namespace rocking::restrained
