// A body on the vertices of its hull, the ground under it, and what both are to the equations.
#pragma once
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "../spatial/vectors.hpp"
#include "few.hpp"

namespace rocking::hull {
using namespace rocking::spatial::ROCKING_ISA;

constexpr int kInterval = 35, kPowers = 8;
constexpr double kInfinite = std::numeric_limits<double>::infinity(), kNan = std::numeric_limits<double>::quiet_NaN();

using Points = Few<int>;
using Vecs = Few<Vec>;
using Numbers = Few<double>;
using List = std::vector<int>;

inline Vec unit(Vec a) {
    const double size = norm(a);
    return size > 0.0 ? 1.0 / size * a : Vec{};
}

struct Body {
    double mass = 0.0, size = 0.0;
    Mat inertia, inverse;
    std::vector<Vec> points;           // vertices, from the centre of mass
    std::vector<Mat> soft, stiff;      // acceleration of each vertex by a force there, and its inverse
    std::vector<Vec> facets;           // outward normals over distances from the centre
    List poses, first, beside;         // of each facet: pose to which it leads, its neighbours
    List first_corner, corners;         // of each facet
    const double* positions = nullptr; // intervals of azimuth, with the coefficients of k over each
    int intervals = 0;
    bool usable = false;

    void prepare() {
        inverse = spatial::ROCKING_ISA::inverse(inertia);
        for (const Vec& p : points) {
            size = greater(size, norm(p));
            const Mat turn{cross(p, {1.0, 0.0, 0.0}), cross(p, {0.0, 1.0, 0.0}), cross(p, {0.0, 0.0, 1.0})};  // columns of [r]
            Mat made = diagonal(1.0 / mass);
            const Vec turned[3] = {inverse * turn.a, inverse * turn.b, inverse * turn.c};
            made.a = made.a + Vec{dot(turn.a, turned[0]), dot(turn.a, turned[1]), dot(turn.a, turned[2])};
            made.b = made.b + Vec{dot(turn.b, turned[0]), dot(turn.b, turned[1]), dot(turn.b, turned[2])};
            made.c = made.c + Vec{dot(turn.c, turned[0]), dot(turn.c, turned[1]), dot(turn.c, turned[2])};
            soft.push_back(made), stiff.push_back(spatial::ROCKING_ISA::inverse(made));
        }
    }

    // Acceleration of a vertex by a force at a point.
    Mat yielding(int i, Vec by) const {
        const Vec at = points[i];
        const auto answer = [&](Vec f) { return 1.0 / mass * f + cross(inverse * cross(by, f), at); };
        const Vec x = answer({1.0, 0.0, 0.0}), y = answer({0.0, 1.0, 0.0}), z = answer({0.0, 0.0, 1.0});
        return {{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}};
    }

    // The facet through which the vertical through the centre leaves, downward: from a facet to better neighbours.
    int under(Vec up, int from) const {
        for (double least = dot(facets[from], up);;) {
            const int before = from;
            for (int k = first[before]; k < first[before + 1]; ++k) {
                const double found = dot(facets[beside[k]], up);  // Eq. 258
                if (found < least) least = found, from = beside[k];
            }
            if (from == before) return from;
        }
    }
};

struct State {
    Vec place;              // of the centre, axes of the ground
    double q[4] = {1.0};    // attitude
    Vec velocity, spin;     // axes of the ground, and of the body
};

// Axes of the ground in those of the body.
inline Mat frame(const double* q) {
    const double s = q[0], x = q[1], y = q[2], z = q[3];
    return {{s * s + x * x - y * y - z * z, 2.0 * (x * y - s * z), 2.0 * (x * z + s * y)},  // Eq. 79
            {2.0 * (x * y + s * z), s * s - x * x + y * y - z * z, 2.0 * (y * z - s * x)},
            {2.0 * (x * z - s * y), 2.0 * (y * z + s * x), s * s - x * x - y * y + z * z}};
}

inline void normalise(double* q) {
    const double size = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int k = 0; k < 4; ++k) q[k] /= size;
}

struct Motion {
    const double* times = nullptr;  // ends of the stretches
    const double* rows = nullptr;   // accelerations by stretch, power and axis
    std::int64_t count = 0;
    int degree = 0;
};

// Gravity less the acceleration of the ground, in axes of the plane, by powers of the share of a step.
struct Field {
    Vec power[kPowers];
    int degree = 0;
    Vec at(double share) const {
        Vec total;
        for (int k = degree; k >= 0; --k) total = power[k] + share * total;
        return total;
    }
};

struct Ground {
    const Motion* motion = nullptr;
    double scale = 1.0, gravity = 0.0;
    Mat level = diagonal(1.0);      // to axes of the plane
    double shelf[2] = {kInfinite, kInfinite};
    Vec weight;

    double end() const { return motion->count ? motion->times[motion->count] : 0.0; }
    double time(std::int64_t stretch) const { return motion->times[stretch]; }

    void field(std::int64_t stretch, double start, double span, Field& made) const {
        made.degree = 0, made.power[0] = weight;
        if (stretch >= motion->count) return;
        const int n = motion->degree;
        const double whole = motion->times[stretch + 1] - motion->times[stretch];
        const double to = (start - motion->times[stretch]) / whole, width = span / whole;
        const double* row = motion->rows + stretch * (n + 1) * 3;
        Vec c[kPowers];
        for (int k = 0; k <= n; ++k) c[k] = {row[3 * k], row[3 * k + 1], row[3 * k + 2]};
        for (int k = 0; k < n; ++k)
            for (int j = n - 1; j >= k; --j) c[j] = c[j] + to * c[j + 1];
        double power = 1.0;
        for (int k = 0; k <= n; ++k, power *= width) {
            const Vec a = (-scale * power) * (level * c[k]);
            made.power[k] = k ? a : weight + a;
        }
        made.degree = n;
    }

    double inside(Vec place) const { return lesser(shelf[0] - std::fabs(place.x), shelf[1] - std::fabs(place.y)); }
    bool ends() const { return shelf[0] < kInfinite || shelf[1] < kInfinite; }
};

}  // namespace rocking::hull
