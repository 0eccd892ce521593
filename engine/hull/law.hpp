// Impulse position of a landing, on the line from the old support to the landing point.
#pragma once
#include "body.hpp"

namespace rocking::hull {

enum Code : int { kHousner = 0, kPosition = 1, kCoefficient = 2, kKed = 3, kCalibrated = 4 };
constexpr double kFlat = 1e-7;

struct Law {
    int code = kHousner, base = 0;
    double coefficient = 0.0;

    // Position k of a step within the base, at most 1 unless a coefficient states a larger loss; 1 for other steps.
    double at(const Body& b, Vec old, Vec now) const {
        const double height = 1.0 / norm(b.facets[base]);
        const Vec down = height * b.facets[base], step = now - old;
        if (code == kHousner || height - dot(down, old) > kFlat * b.size || height - dot(down, now) > kFlat * b.size) return 1.0;
        if (code == kPosition) return coefficient;
        // a stated energy loss may be larger than that of Housner
        if (code == kCoefficient) return greater(by_coefficient(b, step, down, height), 0.0);
        if (code == kCalibrated) return greater(b.calibrated.at(step), 0.0);
        return lesser(greater(b.ked.at(step), 0.0), 1.0);
    }

    Vec place(const Body& b, Vec old, Vec now) const {
        const Vec step = now - old;
        return norm(step) > 0.0 ? now - 0.5 * (1.0 - at(b, old, now)) * step : now;  // Eq. 254
    }

  private:
    double by_coefficient(const Body& b, Vec step, Vec down, double height) const {
        const Vec up = -1.0 * down, along = unit(step - dot(step, up) * up), edge = cross(up, along);
        double ahead = -kInfinite, behind = kInfinite;
        for (int k = b.first_corner[base]; k < b.first_corner[base + 1]; ++k) {
            const double reach = dot(along, b.points[b.corners[k]]);
            ahead = greater(ahead, reach), behind = lesser(behind, reach);
        }
        const double over_foot = dot(edge, b.inertia * edge) / b.mass + height * height;
        const double lever = over_foot * (1.0 - coefficient) / (coefficient * ahead - behind);  // Eq. 4
        return (2.0 * lever - (ahead + behind)) / (ahead - behind);  // Eq. 104
    }
};

// Nearest point of a vertex, an edge or the border of a facet to another point.
inline Vec nearest(const Body& b, const Points& stood, Vec to) {
    const std::size_t n = stood.size();
    Vec best = b.points[stood[0]];
    for (std::size_t k = 0; n > 1 && k < n; ++k) {
        const Vec a = b.points[stood[k]], along = b.points[stood[(k + 1) % n]] - a;
        const Vec candidate = a + lesser(greater(dot(to - a, along) / dot(along, along), 0.0), 1.0) * along;
        if (dot(candidate - to, candidate - to) < dot(best - to, best - to)) best = candidate;
    }
    return best;
}

}  // namespace rocking::hull
