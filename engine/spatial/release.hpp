// Loss of contact: forces at a point and at both ends of an edge, as series of the time in a step.
#pragma once
#include "contact.hpp"
#include "zeros.hpp"

namespace rocking::spatial {
namespace ROCKING_ISA {

// A step with series: coefficients of the gaps of two vertices, of the height of the centre of mass, and of the cosine of the
// tilt.
struct Step {
    double length = 0.0;
    Series s;
    Four c[kMostOrder + 1];
    double field[kMostOrder + 1][3];  // gravity minus the acceleration of the ground, by power, axes of the ground
    Vec heading;                      // direction of the edge on the ground
    double least_normal = 0.0;        // lower bound of the vertical force per unit mass

    Vec up(int k) const { return vec(s.z[k]); }
    double spin(int k, Vec axis) const { return dot(vec(s.w[k]), axis) / length; }
};

inline void multiply(const double* a, const double* b, int order, double* product) {
    for (int k = 0; k <= order; ++k) {
        product[k] = 0.0;
        for (int j = 0; j <= k; ++j) product[k] += a[j] * b[k - j];
    }
}

// Vertical force per unit mass; its order is that of the series minus two.
inline void normal_force(const Step& step, double* force) {
    const double rate = 1.0 / (step.length * step.length);
    for (int k = 0; k + 2 <= step.s.order; ++k) force[k] = (k + 2) * (k + 1) * rate * step.c[k + 2][2] - step.field[k][2];  // Eq. 96
}

// Vertical force per unit mass at the second end of an edge.
inline void second_force(const Pivot& edge, const Step& step, double* force) {
    const int n = step.s.order, top = n - 2;
    double spin[kMostOrder + 1], rate[kMostOrder + 1], square[kMostOrder + 1], a[kMostOrder + 1], b[kMostOrder + 1];
    double height[kMostOrder + 1], push[kMostOrder + 1], part[3][kMostOrder + 1];
    for (int k = 0; k <= n; ++k) spin[k] = step.spin(k, edge.axis);
    for (int k = 0; k <= top; ++k) {
        const Four z = step.s.z[k], ends = edge.ends[0] * all_of<0>(z) + edge.ends[1] * all_of<1>(z) + edge.ends[2] * all_of<2>(z);
        rate[k] = (k + 1) * spin[k + 1] / step.length;
        a[k] = ends[0], b[k] = ends[1], height[k] = step.c[k][2];
        push[k] = step.heading.x * step.field[k][0] + step.heading.y * step.field[k][1] + step.heading.z * step.field[k][2];
    }
    multiply(spin, spin, top, square);
    multiply(a, rate, top, part[0]);
    multiply(b, square, top, part[1]);
    multiply(height, push, top, part[2]);
    for (int k = 0; k <= top; ++k)
        force[k] = (part[2][k] - part[0][k] - part[1][k] - step.field[k][2] * edge.along) / edge.length;  // Eq. 97
}

// Acceleration of the gap of one end of an edge, if the body rotated about the other end only.
inline void opening_of(const Body& body, const Pivot& edge, const Step& step, int which, double* opening) {
    const int top = step.s.order - 2;
    const Vec stays = which ? edge.at : edge.at + edge.length * edge.axis, arm = body.centre - stays;
    const Vec leaves = (which ? edge.length : -edge.length) * edge.axis, across{-step.heading.y, step.heading.x, 0.0};
    const Mat inertia = body.about(stays), solve = inverse(inertia);
    const Vec spun = cross(edge.axis, inertia * edge.axis);
    double spin[kMostOrder + 1], square[kMostOrder + 1];
    for (int k = 0; k <= top; ++k) spin[k] = step.spin(k, edge.axis), opening[k] = 0.0;
    multiply(spin, spin, top, square);
    Vec torque[kMostOrder + 1], lever[kMostOrder + 1];
    for (int k = 0; k <= top; ++k) {
        Vec field = dot(step.heading, {step.field[k][0], step.field[k][1], step.field[k][2]}) * edge.axis;
        for (int j = 0; j <= k; ++j) {
            const double* f = step.field[k - j];
            field = field + f[2] * step.up(j) + (across.x * f[0] + across.y * f[1]) * cross(step.up(j), edge.axis);
        }
        torque[k] = body.mass * cross(arm, field) - square[k] * spun;
        lever[k] = solve * cross(leaves, step.up(k));
    }
    for (int k = 0; k <= top; ++k)
        for (int j = 0; j <= k; ++j) opening[k] += dot(lever[j], torque[k - j]);  // Eq. 98
}

struct Release {
    double at = kNone;
    int which = -1;  // end of the edge, -1 if all contact is lost
};

// Time at which the force at an end is tensile while the gap of the end opens.
inline double opens(const Body& body, const Pivot& edge, const Step& step, int which, const double* force) {
    const int top = step.s.order - 2;
    double opening[kMostOrder + 1];
    const double at = first_zero(force, top, false, 0.0);
    if (at > 1.0) return kNone;
    opening_of(body, edge, step, which, opening);
    if (value_of(opening, top, at) > 0.0) return at;
    for (int k = 0; k <= top; ++k) opening[k] = -opening[k];
    const double later = first_zero(opening, top, false, 0.0);
    return later <= 1.0 && later > at && value_of(force, top, later) < 0.0 ? later : kNone;
}

inline Release first_release(const Body& body, const Pivot& stance, const Step& step) {
    const int top = step.s.order - 2;
    double normal[kMostOrder + 1], force[2][kMostOrder + 1];
    normal_force(step, normal);
    Release release{first_zero(normal, top, false, 0.0), -1};
    if (stance.contact != kEdge) return release;
    second_force(stance, step, force[1]);
    for (int k = 0; k <= top; ++k) force[0][k] = normal[k] - force[1][k];
    for (int which = 0; which < 2; ++which) {
        double lower_bound = force[which][0];
        for (int k = 1; k <= top; ++k) lower_bound -= std::fabs(force[which][k]);
        if (lower_bound > 0.0) continue;
        const double at = opens(body, stance, step, which, force[which]);
        if (at < release.at) release = {at, which};
    }
    return release;
}

}  // namespace ROCKING_ISA
}  // namespace rocking::spatial
