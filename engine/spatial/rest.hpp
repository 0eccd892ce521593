// Duration of rest: time at which the centre of pressure reaches the border of the base.
#pragma once
#include "contact.hpp"
#include "zeros.hpp"

namespace rocking::spatial {
namespace ROCKING_ISA {

// Accelerations as polynomials: data[stretch][power][axis]; the unit of time is the segment.
struct Motion {
    const double *times = nullptr, *data = nullptr;
    std::int64_t count = 0;
};

inline void shift(double* c, int order, double to, double width) {
    for (int k = 0; k < order; ++k)
        for (int j = order - 1; j >= k; --j) c[j] += to * c[j + 1];  // Eq. 51
    double power = 1.0;
    for (int k = 0; k <= order; ++k, power *= width) c[k] *= power;
}

struct Uplift {
    std::int64_t stretch = -1;
    double tau = 0.0;
    int edges = 0, first = -1, second = -1;  // edges that the centre of pressure crosses at that time
};

constexpr double kSame = 1e-11, kWhole = 1.0 - 1e-12;
constexpr int kMostHolds = 2 * (kDegrees - 1);

template <int D>
class Rest {
public:
    Rest(const Body& body, const Motion& motion, double scale, double gravity, Vec x, Vec y)
        : body_(body), motion_(motion), scale_(scale), gravity_(gravity), x_(x), y_(y) {
        order_ = body.round ? 2 * D : D;
        rows_ = body.round ? 2 : body.count;
        for (int e = 0; e < body.count; ++e) {
            const Vec n = body.inward[e], arm = body.centre - body.vertices[e];
            const double inside = arm.x * n.x + arm.y * n.y, tips = -body.centre.z;
            by_[e] = {tips * (n.x * x.x + n.y * x.y), tips * (n.x * y.x + n.y * y.y), inside};
        }
    }

    // First zero, after time tau of a segment, of functions that are positive at rest; segment -1 if there is no zero.
    Uplift next(std::int64_t stretch, double tau) const {
        for (; stretch < motion_.count; ++stretch, tau = 0.0) {
            if (tau == 0.0 && surely_held(stretch)) continue;
            const Uplift uplift = within(stretch, tau);
            if (uplift.stretch >= 0) return uplift;
        }
        return {};
    }

private:
    bool surely_held(std::int64_t stretch) const {
        if (body_.round) {
            double c[kMostHolds + 1];
            return low(stretch, 0, c) > 0.0 && low(stretch, 1, c) > 0.0;
        }
        const double* a = motion_.data + stretch * (D + 1) * 3;
        bool held = true;
        for (int e = 0; e < rows_; ++e) {
            double smallest = gravity_ * by_[e].z;
            for (int d = 0; d <= D; ++d) {
                const double c = scale_ * (by_[e].x * a[3 * d] + by_[e].y * a[3 * d + 1] + by_[e].z * a[3 * d + 2]);
                smallest += d == 0 ? c : lesser(c, 0.0);
            }
            held = held && smallest > 0.0;
        }
        return held;
    }

    double low(std::int64_t stretch, int row, double* c) const {
        fill(stretch, row, c);
        double smallest = c[0];
        for (int k = 1; k <= order_; ++k) smallest += lesser(c[k], 0.0);
        return smallest;
    }

    void fill(std::int64_t stretch, int row, double* c) const {
        const double* a = motion_.data + stretch * (D + 1) * 3;
        for (int k = 0; k <= order_; ++k) c[k] = 0.0;
        if (!body_.round) {
            for (int d = 0; d <= D; ++d)
                c[d] = scale_ * (by_[row].x * a[3 * d] + by_[row].y * a[3 * d + 1] + by_[row].z * a[3 * d + 2]);
            c[0] += gravity_ * by_[row].z;  // Eq. 94
            return;
        }
        double weight[D + 1], arm[2][D + 1];
        for (int d = 0; d <= D; ++d) {
            const double ax = scale_ * a[3 * d], ay = scale_ * a[3 * d + 1];
            weight[d] = scale_ * a[3 * d + 2] + (d == 0 ? gravity_ : 0.0);
            arm[0][d] = body_.centre.x * weight[d] - body_.centre.z * (x_.x * ax + y_.x * ay);
            arm[1][d] = body_.centre.y * weight[d] - body_.centre.z * (x_.y * ax + y_.y * ay);
            if (row == 1) c[d] = weight[d] * body_.size;  // the contact force must be compressive
        }
        const double square = body_.radius * body_.radius;
        for (int i = 0; row == 0 && i <= D; ++i)
            // Eq. 95
            for (int j = 0; j <= D; ++j) c[i + j] += square * weight[i] * weight[j] - arm[0][i] * arm[0][j] - arm[1][i] * arm[1][j];
    }

    static bool falls_at_once(const double* c, int order) {
        for (int k = 1; k <= order; ++k)
            if (c[k] != 0.0) return c[k] < 0.0;
        return false;
    }

    Uplift within(std::int64_t stretch, double tau) const {
        double c[kMostVertices][kMostHolds + 1], least = kFar, first = kFar;
        const double same = kSame * gravity_ * body_.size;
        Uplift uplift{stretch, tau, 0, -1, -1};
        for (int e = 0; e < rows_; ++e) {
            fill(stretch, e, c[e]);
            if (tau > 0.0) shift(c[e], order_, tau, 1.0 - tau);
            least = lesser(least, c[e][0]);
        }
        if (least < -same) return uplift;
        for (int e = 0; e < rows_; ++e) {
            const double at = c[e][0] > 0.0 ? first_fall(c[e], order_) : (falls_at_once(c[e], order_) ? 0.0 : kNone);
            if (at < kWhole) first = lesser(first, at);  // a zero at the end belongs to the next segment
        }
        if (first == kFar) return {};
        for (int e = 0; e < rows_ && !body_.round; ++e) {
            if (value_of(c[e], order_, first) > same) continue;
            if (uplift.edges < 2) (uplift.edges == 0 ? uplift.first : uplift.second) = e;
            ++uplift.edges;
        }
        uplift.tau = tau + (1.0 - tau) * first;
        return uplift;
    }

    const Body& body_;
    const Motion& motion_;
    double scale_, gravity_;
    Vec x_, y_, by_[kMostVertices];
    int order_, rows_;
};

// Contact set after uplift from rest; null if the force is tensile.
inline const Pivot* lifted(const Body& body, const State& s, const Uplift& uplift) {
    if (uplift.edges == 1) return &body.edge[uplift.first];
    if (uplift.edges == 2)
        return &body.vertex[(uplift.first + 1) % body.count == uplift.second ? uplift.second : uplift.first];
    return held(body, s, body.every(), nullptr).stance;
}

}  // namespace ROCKING_ISA
}  // namespace rocking::spatial
