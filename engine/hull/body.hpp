// A body represented by the vertices of its convex hull, the ground, and the quantities of the equations of motion.
#pragma once
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "../spatial/positions.hpp"
#include "few.hpp"

namespace rocking::hull {
using namespace rocking::spatial::ROCKING_ISA;

constexpr int kPowers = 8, kAcross = 8;
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
    std::vector<Vec> points;           // vertices, relative to the centre of mass
    // acceleration of every vertex per unit force at this vertex, and the inverse matrix
    std::vector<Mat> soft, stiff;
    std::vector<Vec> facets;           // outward unit normals / distance of the facet from the centre of mass
    List poses, first, beside;         // by facet: final pose, index of the first neighbour; list of the neighbours
    List first_corner, corners;         // by facet: index of the first corner; list of the corners
    Positions ked, calibrated;         // impulse position k of a landing on the base, for two models
    bool usable = false;

    void prepare() {
        inverse = spatial::ROCKING_ISA::inverse(inertia);
        for (const Vec& p : points) {
            size = greater(size, norm(p));
            const Mat turn{cross(p, {1.0, 0.0, 0.0}), cross(p, {0.0, 1.0, 0.0}), cross(p, {0.0, 0.0, 1.0})};  // columns of [r]
            Mat matrix = diagonal(1.0 / mass);
            const Vec turned[3] = {inverse * turn.a, inverse * turn.b, inverse * turn.c};
            matrix.a = matrix.a + Vec{dot(turn.a, turned[0]), dot(turn.a, turned[1]), dot(turn.a, turned[2])};
            matrix.b = matrix.b + Vec{dot(turn.b, turned[0]), dot(turn.b, turned[1]), dot(turn.b, turned[2])};
            matrix.c = matrix.c + Vec{dot(turn.c, turned[0]), dot(turn.c, turned[1]), dot(turn.c, turned[2])};
            soft.push_back(matrix), stiff.push_back(spatial::ROCKING_ISA::inverse(matrix));
        }
    }

    // Acceleration of a vertex per unit force at another point.
    Mat yielding(int i, Vec by) const {
        const Vec at = points[i];
        const auto answer = [&](Vec f) { return 1.0 / mass * f + cross(inverse * cross(by, f), at); };
        const Vec x = answer({1.0, 0.0, 0.0}), y = answer({0.0, 1.0, 0.0}), z = answer({0.0, 0.0, 1.0});
        return {{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}};
    }

    // Facet below the centre of mass, found by moving from a facet to a neighbour.
    int under(Vec up, int from) const {
        for (double lowest = dot(facets[from], up);;) {
            const int before = from;
            for (int k = first[before]; k < first[before + 1]; ++k) {
                const double height = dot(facets[beside[k]], up);  // Eq. 258
                if (height < lowest) lowest = height, from = beside[k];
            }
            if (from == before) return from;
        }
    }
};

struct State {
    Vec place;              // position of the centre of mass, axes of the ground
    double q[4] = {1.0};    // attitude (quaternion)
    Vec velocity, spin;     // velocity in axes of the ground, angular velocity in axes of the body
};

// Axes of the ground, expressed in axes of the body.
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
    const double* times = nullptr;  // end times of the segments
    const double* rows = nullptr;   // accelerations by segment, power and axis
    std::int64_t count = 0;
    int degree = 0;
};

// Gravity minus the acceleration of the ground, in axes of the plane, as polynomial of the fraction of a step.
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
    Mat level = diagonal(1.0);      // rotation to the axes of the plane
    double shelf[2] = {kInfinite, kInfinite};
    Vec weight;

    double end() const { return motion->count ? motion->times[motion->count] : 0.0; }
    double time(std::int64_t stretch) const { return motion->times[stretch]; }

    void field(std::int64_t stretch, double start, double span, Field& field) const {
        field.degree = 0, field.power[0] = weight;
        if (stretch >= motion->count) return;
        const int n = motion->degree;
        const double duration = motion->times[stretch + 1] - motion->times[stretch];
        const double to = (start - motion->times[stretch]) / duration, width = span / duration;
        const double* row = motion->rows + stretch * (n + 1) * 3;
        Vec c[kPowers];
        for (int k = 0; k <= n; ++k) c[k] = {row[3 * k], row[3 * k + 1], row[3 * k + 2]};
        for (int k = 0; k < n; ++k)
            for (int j = n - 1; j >= k; --j) c[j] = c[j] + to * c[j + 1];
        double power = 1.0;
        for (int k = 0; k <= n; ++k, power *= width) {
            const Vec a = (-scale * power) * (level * c[k]);
            field.power[k] = k ? a : weight + a;
        }
        field.degree = n;
    }

    // The field over several linear segments, as a cubic with the moments of the motion. Up to the fourth order, the
    // end of a step depends on these moments only. Returns the largest distance from the samples in the step.
    double across(std::int64_t stretch, double start, double span, Field& result) const {
        const double end = start + span;
        const std::int64_t first = stretch;
        Vec moments[4], at[kAcross];
        double shares[kAcross], from = 0.0;
        int inner = 0;
        for (; stretch < motion->count && from < 1.0; ++stretch) {
            const double* t = motion->times + stretch;
            const double* row = motion->rows + stretch * 6;
            const double to = t[1] < end && inner < kAcross ? (t[1] - start) / span : 1.0, pace = span / (t[1] - t[0]);
            const Vec rise = pace * Vec{row[3], row[4], row[5]}, base = Vec{row[0], row[1], row[2]} + (start - t[0]) / span * rise;
            double low = from, high = to;
            for (int k = 0; k < 4; ++k, low *= from, high *= to) {
                const double first_moment = (high - low) / (k + 1), two = (high * to - low * from) / (k + 2);
                moments[k] = moments[k] + first_moment * base + two * rise;
            }
            if (to < 1.0) shares[inner] = to, at[inner++] = base + to * rise;
            from = to;
        }
        static constexpr double inverse[4][4] = {  // inverse of Hilbert's matrix
            {16.0, -120.0, 240.0, -140.0}, {-120.0, 1200.0, -2700.0, 1680.0}, {240.0, -2700.0, 6480.0, -4200.0}, {-140.0, 1680.0, -4200.0, 2800.0}};
        Vec powers[4];
        for (int k = 0; k < 4; ++k)
            for (int j = 0; j < 4; ++j) powers[k] = powers[k] + inverse[k][j] * moments[j];
        double beside = 0.0;
        for (int k = 0; k < inner; ++k) {
            const double s = shares[k];
            beside = greater(beside, largest(powers[0] + s * (powers[1] + s * (powers[2] + s * powers[3])) - at[k]));
        }
        if (!inner) return field(first, start, span, result), 0.0;
        result.degree = 3;
        for (int k = 0; k < 4; ++k) result.power[k] = -scale * (level * powers[k]);
        result.power[0] = result.power[0] + weight;
        return scale * beside;
    }

    double inside(Vec position) const { return lesser(shelf[0] - std::fabs(position.x), shelf[1] - std::fabs(position.y)); }
    bool ends() const { return shelf[0] < kInfinite || shelf[1] < kInfinite; }
};

}  // namespace rocking::hull
