// Restitution laws, one per function. Every law returns the angular velocity about the new pivot.
#pragma once
#include <limits>

#include "body.hpp"

namespace rocking::spatial {
namespace ROCKING_ISA {

enum Law : int { kHousner = 0, kHorizontal = 1, kFixed = 2, kKed = 3, kKedPoint = 4, kCalibrated = 5 };

// State of a body in body axes: a point at rest on the ground, angular velocity, vertical direction, gravity minus the
// acceleration of the ground; for a body on an edge, the vector to the other end of the edge.
struct State {
    Vec pivot, velocity, up, field, along;
};

// Angular velocity with a given angular momentum about a pivot; for an edge, only the component along the edge is used.
inline Vec with_momentum(const Pivot& onto, Vec momentum) {
    if (onto.contact == kEdge) return dot(onto.axis, momentum) / onto.about_axis * onto.axis;  // Eq. 89
    return onto.inverse * momentum;
}

// Plastic impact without slip: projection of the velocities in the kinetic metric.
inline Vec projected(const Body& body, const State& s, const Pivot& onto) {
    const Vec speed = cross(s.velocity, body.centre - s.pivot);
    return with_momentum(onto, body.inertia * s.velocity + body.mass * cross(onto.arm, speed));  // Eq. 88
}

// Impact after which the particles keep only their horizontal velocities.
inline Vec level_only(const Body& body, const State& s, const Pivot& onto) {
    const double half = 0.5 * (body.inertia.a.x + body.inertia.b.y + body.inertia.c.z);
    const Mat second = diagonal(half) - body.inertia;  // integral of x x^T about the centre of mass
    const Vec speed = cross(s.velocity, body.centre - s.pivot), level = speed - dot(s.up, speed) * s.up;
    const Vec momentum = body.inertia * s.velocity + cross(s.up, second * cross(s.up, s.velocity));
    return with_momentum(onto, momentum + body.mass * cross(onto.arm, level));  // Eq. 102
}

// Twice the energy after the three stages of KED, from the moments of the landing stance in body axes.
inline double twice_kept(const State& s, const Pivot& onto) {
    const Vec jump = cross(s.velocity, onto.at - s.pivot), drift = jump - dot(s.up, jump) * s.up;
    const double u[3] = {drift.x, drift.y, drift.z}, z[3] = {s.up.x, s.up.y, s.up.z};
    const double w[3][3] = {{0.0, -s.velocity.z, s.velocity.y}, {s.velocity.z, 0.0, -s.velocity.x}, {-s.velocity.y, s.velocity.x, 0.0}};
    double v[3][3], total = 0.0;  // horizontal part of the cross product with the velocity
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) v[i][j] = w[i][j] - z[i] * (z[0] * w[0][j] + z[1] * w[1][j] + z[2] * w[2][j]);
    const double *second = onto.kept, *third = onto.kept + 9, *fourth = onto.kept + 36;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            total += u[i] * second[3 * i + j] * u[j];
            for (int k = 0; k < 3; ++k) {
                total += 2.0 * u[i] * third[9 * i + 3 * j + k] * v[j][k];
                for (int l = 0; l < 3; ++l) total += v[i][k] * v[j][l] * fourth[27 * i + 9 * j + 3 * k + l];  // Eq. 106
            }
        }
    }
    return total;
}

inline Vec scaled_to(const Pivot& onto, Vec direction, double twice) {
    const double left = dot(direction, onto.inertia * direction);
    return left > 0.0 ? std::sqrt(greater(twice, 0.0) / left) * direction : direction;  // Eq. 21
}

// Angular velocity from the momentum about the impulse point, which is (1 - k)/2 of the step behind the new pivot.
inline Vec about_impulse(const Body& body, const State& s, const Pivot& onto, Vec step, double k) {
    const Vec back = 0.5 * (1.0 - k) * body.mass * step, speed = cross(s.velocity, body.centre - s.pivot);
    const Vec momentum = body.inertia * s.velocity + body.mass * cross(onto.arm, speed) + cross(back, speed);
    if (onto.contact == kEdge) return dot(onto.axis, momentum) / (onto.about_axis + dot(back, onto.arm)) * onto.axis;
    return inverse(onto.inertia + diagonal(dot(back, onto.arm)) - outer(onto.arm, back)) * momentum;  // Eq. 103
}

// highest: largest k; k = 1 is the new pivot, and for larger k the contact force would be tensile.
inline Vec by_position(const Body& body, const State& before, const Pivot& onto, const Positions& positions, double highest) {
    State s = before;
    const double length = dot(s.along, s.along);
    if (length > 0.0) {  // for an edge, use the point of the edge nearest to the new stance
        const Vec way = onto.at + 0.5 * onto.length * onto.axis - s.pivot;
        s.pivot = s.pivot + lesser(greater(dot(way, s.along) / length, 0.0), 1.0) * s.along;
    }
    Vec step = onto.at - s.pivot;
    if (onto.contact == kEdge) step = step - dot(step, onto.axis) * onto.axis;
    const Vec speed = cross(s.velocity, body.centre - s.pivot);
    // 1 if the step has no length
    const double k = largest(step) > 1e-12 * body.size ? lesser(positions.at(step), highest) : 1.0;
    Vec velocity = about_impulse(body, s, onto, step, k);
    if (k < 1.0 && dot(s.up, cross(velocity, onto.arm) - speed) < 0.0) velocity = about_impulse(body, s, onto, step, 1.0);
    const double first = dot(s.velocity, body.inertia * s.velocity) + body.mass * dot(speed, speed), left = dot(velocity, onto.inertia * velocity);
    return left > first ? std::sqrt(first / left) * velocity : velocity;
}

inline Vec velocity_after(const Body& body, const State& s, const Pivot& onto, int law, double coefficient) {
    if (law == kHorizontal) return level_only(body, s, onto);
    if (law == kKed) return by_position(body, s, onto, body.ked, 1.0);
    if (law == kCalibrated) return by_position(body, s, onto, body.calibrated, std::numeric_limits<double>::infinity());
    if (law == kKedPoint) return scaled_to(onto, level_only(body, s, onto), twice_kept(s, onto));
    const Vec plastic = projected(body, s, onto);
    if (law == kHousner) return plastic;
    const double before = dot(s.velocity, body.about(s.pivot) * s.velocity), size = dot(plastic, plastic);
    const double left = size > 0.0 ? dot(plastic, onto.inertia * plastic) / size : 0.0;
    return scaled_to(onto, plastic, lesser(coefficient * coefficient * dot(s.velocity, s.velocity) * left, before));  // Eq. 101
}

}  // namespace ROCKING_ISA
}  // namespace rocking::spatial
