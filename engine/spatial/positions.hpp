// Position k of the impulse at a landing of the complete base, as a function of the azimuth of the step.
#pragma once
#include <cmath>

#include "vectors.hpp"

namespace rocking::spatial {
namespace ROCKING_ISA {

constexpr int kInterval = 35;  // numbers per interval: first and last azimuth, Chebyshev coefficients

// List of intervals of azimuth; empty if the model cannot be applied.
struct Positions {
    const double* rows = nullptr;
    int intervals = 0;

    double at(Vec step) const {
        double angle = std::atan2(step.y, step.x);
        const double* p = rows;
        if (angle < p[0]) angle += 2.0 * 3.141592653589793;
        for (int i = 1; i < intervals && angle >= rows[i * kInterval]; ++i) p += kInterval;
        const double x = (2.0 * angle - p[0] - p[1]) / (p[1] - p[0]);
        double current = 0.0, two = 0.0;
        for (int k = kInterval - 1; k > 2; --k) {
            const double sum = 2.0 * x * current - two + p[k];
            two = current, current = sum;
        }
        return x * current - two + p[2];
    }
};

}  // namespace ROCKING_ISA
}  // namespace rocking::spatial
