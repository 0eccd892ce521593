// Points that stay on the ground: complementarity, by trial of the few contact sets that are possible for a convex
// base.
#pragma once
#include "law.hpp"

namespace rocking::spatial {
namespace ROCKING_ISA {

constexpr double kRounding = 1e-9, kClosed = 1e-12, kFar = 1e300;
constexpr double kStartRolling = 1e-11, kStopRolling = 1e-13;
// sines of the tilt of a falling rim: the smallest tilt of the passage is predicted at kLanding; below kFlat it is a
// landing
constexpr double kLanding = 1e-3, kFlat = 1e-6;

struct Choice {
    const Pivot* stance = nullptr;
    Vec velocity;
    double push = 0.0;  // the smallest support; negative for a tensile force
};

// Calls `attempt` for the possible contact sets, larger sets first, until it accepts a set.
template <class Attempt>
inline bool any_candidate(const Body& body, std::uint64_t touching, Attempt attempt) {
    if (touching == body.every() && attempt(body.face)) return true;
    for (int i = 0; i < body.count; ++i)
        if ((touching & body.edge[i].points) == body.edge[i].points && attempt(body.edge[i])) return true;
    for (int i = 0; i < body.count; ++i)
        if ((touching & bit(i)) && attempt(body.vertex[i])) return true;
    return false;
}

// The smallest support of a contact force with a moment about the pivot; negative for a tensile force.
inline double least_support(const Body& body, const Pivot& stance, Vec force, Vec moment, Vec up) {
    const double normal = dot(force, up);
    const Vec arms = cross(up, moment);
    if (stance.contact == kEdge) {
        const double second = dot(arms, stance.axis) / stance.length;  // Eq. 92
        return lesser(normal - second, second);
    }
    if (stance.contact != kRest) return normal;
    const Vec pressure = arms + normal * stance.at;  // Eq. 93
    if (body.round) return (normal * body.radius - std::sqrt(pressure.x * pressure.x + pressure.y * pressure.y)) / body.size;
    double smallest = normal;
    for (int i = 0; i < body.count; ++i) {
        const Vec arm = pressure - normal * body.vertices[i];
        smallest = lesser(smallest, (arm.x * body.inward[i].x + arm.y * body.inward[i].y) / body.size);
    }
    return smallest;
}

inline double impulse_support(const Body& body, const State& s, const Pivot& stance, Vec velocity) {
    const Vec push = body.mass * (cross(velocity, stance.arm) - cross(s.velocity, body.centre - s.pivot));  // Eq. 90
    return least_support(body, stance, push, body.inertia * (velocity - s.velocity) + cross(stance.arm, push), s.up);
}

// Smallest opening speed of the touching points outside the contact set.
inline double opening_speed(const Body& body, const Pivot& stance, Vec velocity, Vec up, std::uint64_t touching) {
    double slowest = kFar;
    for (int i = 0; i < body.count; ++i)
        if ((touching & bit(i)) && !(stance.points & bit(i)))
            slowest = lesser(slowest, dot(cross(velocity, body.vertices[i] - stance.at), up));
    return slowest;
}

inline Vec plastic_after(const Body& body, const State& s, const Pivot& stance) {
    return stance.contact == kRest ? Vec{} : projected(body, s, stance);
}

// The largest contact set without tensile impulse or penetration; if there is none, the set with the smallest tensile
// impulse.
inline Choice landed(const Body& body, const State& s, std::uint64_t touching, int law, double coefficient) {
    Choice choice;
    const double scale = largest(s.velocity) * body.size;
    const auto takes = [&](const Pivot& stance) {
        const Vec plastic = plastic_after(body, s, stance);
        const double push = impulse_support(body, s, stance, plastic);
        if (push < -kRounding * body.mass * scale) return false;
        const Vec after = stance.contact == kRest ? plastic : velocity_after(body, s, stance, law, coefficient);
        if (!(opening_speed(body, stance, after, s.up, touching) >= -kRounding * scale)) return false;
        choice = {&stance, after, push};
        return true;
    };
    if (any_candidate(body, touching, takes)) return choice;
    any_candidate(body, touching, [&](const Pivot& stance) {
        const Vec after = plastic_after(body, s, stance);
        const double opening = opening_speed(body, stance, after, s.up, touching & ~stance.points);
        const double push = impulse_support(body, s, stance, after);
        const bool sinks = opening < -kRounding * largest(after) * body.size;
        if (!sinks && (!choice.stance || push > choice.push)) choice = {&stance, after, push};
        return false;
    });
    return choice;
}

struct Forces {
    Vec rate;  // angular acceleration
    double support = 0.0;
};

inline Forces forces(const Body& body, const Pivot& stance, Vec velocity, Vec up, Vec field) {
    const Vec gyroscopic = cross(velocity, stance.inertia * velocity), weight = body.mass * cross(stance.arm, field);
    const Vec rate = stance.contact == kRest ? Vec{} : with_momentum(stance, weight - gyroscopic);
    const Vec moment = stance.inertia * rate + gyroscopic - weight;
    const Vec force = body.mass * (cross(rate, stance.arm) + cross(velocity, cross(velocity, stance.arm)) - field);  // Eq. 91
    return {rate, least_support(body, stance, force, moment, up)};
}

// The first contact set that remains if no gap has an opening speed; `first` is tried before the other sets.
inline Choice held(const Body& body, const State& s, std::uint64_t touching, const Pivot* first) {
    Choice choice;
    const double scale = norm(s.field);
    const auto holds = [&](const Pivot& stance) {
        const Vec velocity = plastic_after(body, s, stance);
        const Forces reaction = forces(body, stance, velocity, s.up, s.field);
        if (reaction.support < -kRounding * body.mass * scale) return false;
        for (int i = 0; i < body.count; ++i) {
            if (!(touching & bit(i)) || (stance.points & bit(i))) continue;
            const Vec arm = body.vertices[i] - stance.at;
            if (!(dot(cross(reaction.rate, arm) + cross(velocity, cross(velocity, arm)), s.up) >= -kRounding * scale)) return false;
        }
        choice = {&stance, velocity, reaction.support};
        return true;
    };
    if (first && holds(*first)) return choice;
    any_candidate(body, touching, [&](const Pivot& stance) { return !(first && first->points == stance.points) && holds(stance); });
    return choice;
}

// Contact set in which points that would close again immediately stay closed.
inline Choice settled(const Body& body, const State& s, const Choice& choice, std::uint64_t touching, double slow, bool weak) {
    if (body.round) {
        const bool flat = weak || choice.stance->contact == kRest;
        return flat && forces(body, body.face, {}, s.up, s.field).support >= 0.0 ? Choice{&body.face, {}, choice.push} : choice;
    }
    std::uint64_t near = weak ? body.every() : choice.stance->points & touching;
    for (int i = 0; i < body.count && !weak; ++i)
        if ((touching & bit(i)) && dot(cross(choice.velocity, body.vertices[i] - choice.stance->at), s.up) <= slow) near |= bit(i);
    const Choice next = held(body, s, near, choice.stance);
    return next.stance ? next : choice;
}

// The initial contact set: the touching points with the lowest velocity stay on the ground.
inline const Pivot* started(const Body& body, Vec velocity, Vec up, std::uint64_t& touching) {
    double height[kMostVertices], rate[kMostVertices], low = kFar, slowest = kFar;
    for (int i = 0; i < body.count; ++i) {
        height[i] = dot(body.vertices[i], up);
        rate[i] = dot(cross(velocity, body.vertices[i]), up);
        low = lesser(low, height[i]);
    }
    touching = 0;
    for (int i = 0; i < body.count; ++i)
        if (height[i] - low <= kClosed * body.size) touching |= bit(i), slowest = lesser(slowest, rate[i]);
    const double size = largest(velocity);
    if (size == 0.0 && touching == body.every()) return &body.face;
    std::uint64_t lowest = 0;
    for (int i = 0; i < body.count; ++i)
        if ((touching & bit(i)) && rate[i] <= slowest + kClosed * size * body.size) lowest |= bit(i);
    for (int i = 0; i < body.count; ++i) {
        const Vec along = body.edges[i];
        const bool alone = largest(velocity - dot(along, velocity) * along) <= kClosed * size;
        if ((lowest & body.edge[i].points) == body.edge[i].points && alone) return &body.edge[i];
    }
    for (int i = 0; i < body.count; ++i)
        if (lowest & bit(i)) return &body.vertex[i];
    return &body.vertex[0];
}

}  // namespace ROCKING_ISA
}  // namespace rocking::spatial
