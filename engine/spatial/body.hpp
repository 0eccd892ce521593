// A body in 3D, and precomputed data of every possible edge and vertex of contact.
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "positions.hpp"

namespace rocking::spatial {
namespace ROCKING_ISA {

enum Contact : int { kRest = 0, kEdge = 1, kVertex = 2, kRolling = 3 };

constexpr int kMostVertices = 64, kKept = 117;

// Points in contact: the face, an edge, a vertex, or a point of a rim.
struct Pivot {
    int contact = kRest, number = -1;
    std::uint64_t points = 0;
    Vec at, axis, arm;
    double length = 0.0, about_axis = 0.0;
    Mat inertia, inverse;
    // contributions to the angular acceleration: of the field, and of products of velocities
    Four torque[3], gyro[6];
    int watched[2] = {-1, -1};            // vertices whose gaps may close first
    // gaps: coefficients of both gaps, of the height of the centre of mass and of the cosine; ends: of the ends of an edge
    Four gaps[3] = {}, ends[3] = {};
    double along = 0.0;                   // component of the arm along the edge
    Vec level, lever;                     // for an edge: part of the arm perpendicular to it, and axis x arm
    // skew: products of inertia about the middle of an edge / mass; they cause different forces at both ends
    // from_middle: distance along the edge from its middle to the projection of the centre of mass
    double skew = 0.0, from_middle = 0.0;
    const double* kept = nullptr;         // moments after stage 2 of KED
};

struct Body {
    double mass = 0.0, p = 0.0, size = 0.0, lift = 0.0, radius = 0.0;
    Vec centre;
    Mat inertia;
    int count = 0;
    bool round = false, usable = false;
    std::vector<Vec> vertices, edges, inward;
    Positions ked, calibrated;            // k of a landing of the complete base, for two models
    Pivot face;
    std::vector<Pivot> vertex, edge;

    Mat about(Vec point) const {
        const Vec arm = centre - point;
        return inertia + mass * (diagonal(dot(arm, arm)) - outer(arm, arm));  // Eq. 83
    }
    std::uint64_t every() const { return count == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << count) - 1; }
};

inline std::uint64_t bit(int i) { return std::uint64_t{1} << i; }

// Euler's equations about a fixed point or edge as linear maps: I w' = arm x m field - w x I w.
inline void equations(const Body& body, Pivot& p) {
    p.arm = body.centre - p.at;
    p.inertia = body.about(p.at);
    p.inverse = inverse(p.inertia);
    p.about_axis = p.contact == kEdge ? dot(p.axis, p.inertia * p.axis) : 0.0;
    const Mat mobility = p.contact == kEdge ? 1.0 / p.about_axis * outer(p.axis, p.axis) : p.inverse;
    const Vec unit[3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
    const auto spun = [&](Vec w) { return -1.0 * (mobility * cross(w, p.inertia * w)); };
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        p.torque[i] = packed(mobility * cross(body.mass * p.arm, unit[i]));
        p.gyro[i] = packed(spun(unit[i]));
        p.gyro[3 + i] = packed(spun(unit[i] + unit[j]) - spun(unit[i]) - spun(unit[j]));
    }
    Vec gap[2];
    for (int i = 0; i < 2; ++i) gap[i] = p.watched[i] < 0 ? p.arm : body.vertices[p.watched[i]] - p.at;
    p.gaps[0] = Four{gap[0].x, gap[1].x, p.arm.x, 0.0};
    p.gaps[1] = Four{gap[0].y, gap[1].y, p.arm.y, 0.0};
    p.gaps[2] = Four{gap[0].z, gap[1].z, p.arm.z, 1.0};
    if (p.contact == kEdge) {
        const Vec about = 1.0 / body.mass * (p.inertia * p.axis), a = cross(p.axis, about), b = cross(p.axis, a);
        p.ends[0] = Four{a.x, b.x, 0.0, 0.0};
        p.ends[1] = Four{a.y, b.y, 0.0, 0.0};
        p.ends[2] = Four{a.z, b.z, 0.0, 0.0};
        p.along = dot(p.axis, p.arm);
        p.level = p.arm - p.along * p.axis, p.lever = cross(p.axis, p.arm);
        p.skew = norm(cross(p.axis, 1.0 / body.mass * (body.about(p.at + 0.5 * p.length * p.axis) * p.axis)));
        p.from_middle = std::fabs(p.along - 0.5 * p.length);
    }
}

inline Pivot rim_point(const Body& body, double x, double y) {
    Pivot pivot;
    const double s = body.radius / std::sqrt(x * x + y * y);
    pivot.contact = kVertex;
    pivot.at = {s * x, s * y, 0.0};
    equations(body, pivot);
    return pivot;
}

// Computes edges, face and vertices; `kept` has the moments of every vertex, then those of every edge.
inline void prepare(Body& body, const double* kept) {
    const int n = body.count;
    body.edges.resize(n), body.inward.resize(n), body.vertex.resize(n), body.edge.resize(n);
    body.face.at = n ? body.vertices[0] : Vec{};
    body.face.points = body.every();
    for (int i = 0; i < n; ++i) {
        const Vec along = body.vertices[(i + 1) % n] - body.vertices[i];
        body.edges[i] = 1.0 / norm(along) * along;
        body.inward[i] = {-body.edges[i].y, body.edges[i].x, 0.0};
    }
    for (int i = 0; i < n; ++i) {
        Pivot &v = body.vertex[i], &e = body.edge[i];
        v.contact = kVertex, e.contact = kEdge;
        v.number = e.number = i;
        v.at = e.at = body.vertices[i];
        v.points = bit(i), e.points = bit(i) | bit((i + 1) % n);
        e.axis = body.edges[i];
        e.length = norm(body.vertices[(i + 1) % n] - body.vertices[i]);
        v.watched[0] = (i + n - 1) % n, v.watched[1] = (i + 1) % n;
        int far = 0;
        const auto distance = [&](int k) { return dot(body.vertices[k] - e.at, body.inward[i]); };
        for (int k = 1; k < n; ++k)
            if (distance(k) > distance(far)) far = k;
        e.watched[0] = e.watched[1] = far;
        equations(body, v), equations(body, e);
        if (kept) v.kept = kept + i * kKept, e.kept = kept + (n + i) * kKept;
    }
    equations(body, body.face);
}

// Positive if the centre of mass is beyond the contact, in the direction of tilt.
inline double leaning_over(const Body& body, Vec up, Vec pivot) {
    const Vec arm = body.centre - pivot;
    return arm.z - dot(up, arm) * up.z;  // Eq. 87
}

// Rise of the centre of mass above rest.
inline double rise(const Body& body, Vec up, Vec pivot) {
    const Vec arm = body.centre - pivot;
    const double level2 = up.x * up.x + up.y * up.y, sunk = up.z > 0.0 ? level2 / (1.0 + up.z) : 1.0 - up.z;
    return up.x * arm.x + up.y * arm.y - sunk * arm.z;  // Eq. 86
}

}  // namespace ROCKING_ISA
}  // namespace rocking::spatial
