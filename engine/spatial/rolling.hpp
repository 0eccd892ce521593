// Rolling of a round base on its rim without slip. n: direction of the horizontal part of Z; h: 1 / length of this
// part. The lowest point of the rim is s = -b n, and rho = C - s changes during rolling:
//     I_s w' = -w x I_s w - m rho x (w x rho') + m rho x R^T G,  rho' = b n',  n' = h (t . Z') t,  h' = -h^2 (n . Z'),
// with the inertia I_s about the contact and t = (-n_y, n_x).
#pragma once
#include "release.hpp"

namespace rocking::spatial {
namespace ROCKING_ISA {

class Rolling {
public:
    // Computes the series of a step from the axes of the ground and the velocity at its start.
    Rolling(const Body& body, const Vec* axes, Vec velocity, int order, Step& step) : body_(body), step_(step), length_(step.length) {
        for (int i = 0; i < 3; ++i) axis_[i][0] = axes[i];
        w_[0] = velocity;
        const double sine = std::sqrt(axes[2].x * axes[2].x + axes[2].y * axes[2].y);
        n_[0] = {axes[2].x / sine, axes[2].y / sine, 0.0};
        h_[0] = 1.0 / sine;
        for (int k = 0; k < order; ++k) {
            contact(k);
            dynamics(k);
            const double factor = length_ / (k + 1);
            for (auto& a : axis_) a[k + 1] = factor * crossed(a, w_, k);
            w_[k + 1] = factor * spin_[k];
            n_[k + 1] = factor * bend_[k];
            h_[k + 1] = -factor * flattening(k);
        }
        write(order);
    }

private:
    using Line = Vec[kMostOrder + 1];
    using Numbers = double[kMostOrder + 1];

    static Vec crossed(const Line& a, const Line& b, int k) {
        Vec total;
        for (int j = 0; j <= k; ++j) total = total + cross(a[j], b[k - j]);
        return total;
    }
    static double product(const double* a, const double* b, int k) {
        double total = 0.0;
        for (int j = 0; j <= k; ++j) total += a[j] * b[k - j];
        return total;
    }

    // Speed of the lowest point along the rim.
    void contact(int k) {
        rise_[k] = crossed(axis_[2], w_, k);
        slip_[k] = toward_[k] = 0.0;
        for (int j = 0; j <= k; ++j) {
            slip_[k] += n_[j].x * rise_[k - j].y - n_[j].y * rise_[k - j].x;
            toward_[k] += n_[j].x * rise_[k - j].x + n_[j].y * rise_[k - j].y;
        }
        drift_[k] = product(slip_, h_, k);  // Eq. 99
        bend_[k] = {};
        for (int j = 0; j <= k; ++j) bend_[k] = bend_[k] + drift_[k - j] * Vec{-n_[j].y, n_[j].x, 0.0};
        arm_[k] = body_.radius * n_[k] + (k == 0 ? body_.centre : Vec{});
        moved_[k] = body_.radius * bend_[k];
    }

    double flattening(int k) {
        square_[k] = product(h_, h_, k);
        return product(square_, toward_, k);
    }

    void dynamics(int k) {
        speed_[k] = crossed(w_, arm_, k);
        momentum_[k] = body_.inertia * w_[k] + body_.mass * crossed(arm_, speed_, k);
        weight_[k] = -1.0 * crossed(w_, moved_, k);
        for (int j = 0; j <= k; ++j) {
            const double* f = step_.field[j];
            weight_[k] = weight_[k] + f[0] * axis_[0][k - j] + f[1] * axis_[1][k - j] + f[2] * axis_[2][k - j];
        }
        double square = 0.0;
        Mat spread;
        for (int j = 0; j <= k; ++j) {
            square += dot(arm_[j], arm_[k - j]);
            spread = spread + outer(arm_[j], arm_[k - j]);
        }
        inertia_[k] = body_.mass * (diagonal(square) - spread);
        if (k == 0) inertia_[0] = inertia_[0] + body_.inertia, solve_ = inverse(inertia_[0]);
        Vec torque = body_.mass * crossed(arm_, weight_, k) - crossed(w_, momentum_, k);
        for (int j = 1; j <= k; ++j) torque = torque - inertia_[j] * spin_[k - j];  // Eq. 23
        spin_[k] = solve_ * torque;
    }

    void write(int order) {
        Series& s = step_.s;
        s.order = order;
        for (int k = 0; k <= order; ++k)
            s.x[k] = packed(axis_[0][k]), s.y[k] = packed(axis_[1][k]), s.z[k] = packed(axis_[2][k]), s.w[k] = packed(length_ * w_[k]);
    }

    const Body& body_;
    Step& step_;
    double length_;
    Line axis_[3], w_, n_, rise_, bend_, arm_, moved_, speed_, momentum_, weight_, spin_;
    Numbers h_, slip_, toward_, drift_, square_;
    Mat inertia_[kMostOrder + 1], solve_;
};

// Quantities of the series of a rolling step: height of the centre of mass, Z . C + b sin(tilt), and cosine of the tilt.
inline void read_rolling(const Body& body, Step& step) {
    double root[kMostOrder + 1];
    for (int k = 0; k <= step.s.order; ++k) {
        double residual = 0.0;
        for (int j = 0; j <= k; ++j) residual += step.s.z[j][0] * step.s.z[k - j][0] + step.s.z[j][1] * step.s.z[k - j][1];
        for (int j = 1; j < k; ++j) residual -= root[j] * root[k - j];
        root[k] = k == 0 ? std::sqrt(residual) : residual / (2.0 * root[0]);
        const double height = dot(step.up(k), body.centre) + body.radius * root[k];
        step.c[k] = Four{height, height, height, step.s.z[k][2]};
    }
}

// True if the tilt is so small that loss of contact is negligible. Contact then persists, and `held` counts its
// duration.
inline bool nearly_flat(const Body& body, Vec up) {
    return std::sqrt(up.x * up.x + up.y * up.y) * body.centre.z < 0.01 * body.radius;
}

// Time at which a round base starts to roll, passes kLanding, or is flat. landing: true if the base falls flat.
inline double rim_event(const Body& body, const Pivot& stance, const Step& step, bool landing) {
    double lean[kMostOrder + 1], steep[kMostOrder + 1];
    const int order = step.s.order;
    const Vec first = step.up(0);
    const double sine = std::sqrt(first.x * first.x + first.y * first.y);
    const bool rolls = stance.contact == kRolling;
    const double x = rolls ? first.x / sine : -stance.at.x / body.radius, y = rolls ? first.y / sine : -stance.at.y / body.radius;
    for (int k = 0; k <= order; ++k) lean[k] = step.s.z[k][0] * x + step.s.z[k][1] * y, steep[k] = -lean[k];
    if (rolls) {
        lean[0] -= sine > kLanding * (1.0 + 1e-6) ? kLanding : kStopRolling;
        return first_zero(lean, order, false, 0.0);
    }
    steep[0] += landing ? 2.0 * kLanding : kStartRolling;
    // after uplift from rest the tilt grows with the cube of time; coefficients of lower powers are rounding errors
    const double pull = norm({step.field[0][0], step.field[0][1], step.field[0][2]});
    const double floor = 0.25 * kSlowOpening * pull * step.length * step.length / body.radius;
    return lesser(first_zero(lean, order, std::fabs(lean[0]) < kNothing, floor), first_zero(steep, order, false, 0.0));
}

}  // namespace ROCKING_ISA
}  // namespace rocking::spatial
