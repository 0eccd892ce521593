// Half cycles of bodies on a foot that may slide, each with its own initial state. In each step the ground acceleration
// is linear. The bodies are mirrored: rotations are positive. Forces are per unit of mass.
#pragma once
#include <algorithm>
#include <cmath>

namespace rocking::contact {

struct Tilted {
    double rotation, velocity, slip;  // [rad, rad/s, m/s]
};

class SlidingFoot {
  public:
    SlidingFoot(double alpha, double p, double size, double friction, double gravity)
        : alpha_(alpha), size_(size), mu_(friction), g_(gravity), inertia_(size * (gravity / (p * p) - size)), whole_(inertia_ + size * size) {}

    // One step. push, lift: acceleration of the ground, and gravity plus vertical acceleration, at both ends of the
    // step [m/s2].
    Tilted step(Tilted s, double h, const double (&push)[2], const double (&lift)[2], double& direction) const {
        double x = 0.0;
        for (int piece = 0; piece < kParts && x < 1.0; ++piece) {
            const Line a = between(push, x), b = between(lift, x);
            const double left = (1.0 - x) * h;
            if (s.slip == 0.0 && direction == 0.0 && over(s, a.begin, b.begin, direction) <= 0.0) direction = 0.0;
            const bool slides = s.slip != 0.0 || direction != 0.0;
            if (s.slip != 0.0) direction = s.slip > 0.0 ? 1.0 : -1.0;
            const Tilted end = moved(s, left, a, b, 1.0, slides ? direction : 0.0);
            double ignored = 0.0;
            const double before = slides ? s.slip * direction : -over(s, a.begin, b.begin, ignored), after = slides ? end.slip * direction : -over(end, a.end, b.end, ignored);
            if (after >= 0.0 || piece + 1 == kParts) {
                if (piece + 1 == kParts && slides && after < 0.0) direction = 0.0;
                s = end, x = 1.0;
                if (slides && after < 0.0) s.slip = 0.0;
                break;
            }
            double low = 0.0, high = 1.0, at = before / (before - after), low_value = before, high_value = after;
            for (int k = 0; k < kRefined; ++k) {  // false position
                const Tilted middle = moved(s, left * at, a, b, at, slides ? direction : 0.0);
                const double value = slides ? middle.slip * direction : -over(middle, a.at(at), b.at(at), ignored);
                (value > 0.0 ? low : high) = at, (value > 0.0 ? low_value : high_value) = value;
                at = low_value > high_value ? low + (high - low) * low_value / (low_value - high_value) : 0.5 * (low + high);
            }
            s = moved(s, left * at, a, b, at, slides ? direction : 0.0);
            x += at * (1.0 - x), direction = 0.0;
            if (slides) s.slip = 0.0;
            else over(s, between(push, x).begin, between(lift, x).begin, direction);
        }
        return s;
    }

  private:
    static constexpr int kParts = 6, kRefined = 3;
    static constexpr double kHolds = 1e6;  // no foot slides if the friction is at least this large
    struct Line {
        double begin, end;
        double at(double x) const { return begin + x * (end - begin); }
    };
    static Line between(const double (&ends)[2], double x) { return {ends[0] + x * (ends[1] - ends[0]), ends[1]}; }

    struct Rates {
        double turning, sliding;
    };

    // direction: direction of sliding; zero if the foot sticks
    Rates rates(double y, double v, double push, double lift, double direction) const {
        const double sine = std::sin(alpha_ - y), cosine = std::cos(alpha_ - y);
        if (direction == 0.0) return {-size_ / whole_ * (lift * sine + push * cosine), 0.0};  // Eq. 14
        const double ratio = -mu_ * direction, lever = sine + ratio * cosine;
        const double turning = -size_ * lever * (lift - size_ * cosine * v * v) / (inertia_ + size_ * size_ * sine * lever);  // Eq. 285
        const double along = push + size_ * (cosine * turning + sine * v * v), across = lift + size_ * (sine * turning - cosine * v * v);  // Eq. 18
        return {turning, ratio * across - along};
    }

    // Difference between friction demand and available friction of the foot; sets the direction of sliding.
    double over(const Tilted& s, double push, double lift, double& direction) const {
        if (mu_ >= kHolds) return -1.0;
        const double sine = std::sin(alpha_ - s.rotation), cosine = std::cos(alpha_ - s.rotation), v2 = s.velocity * s.velocity;
        const double turning = -size_ / whole_ * (lift * sine + push * cosine);
        const double along = push + size_ * (cosine * turning + sine * v2), across = lift + size_ * (sine * turning - cosine * v2);
        direction = along > 0.0 ? -1.0 : 1.0;
        return std::fabs(along) - mu_ * across;
    }

    // Runge-Kutta step of order 4 over a fraction of the remaining step.
    Tilted moved(const Tilted& s, double h, const Line& push, const Line& lift, double fraction, double direction) const {
        const double half = 0.5 * h, pm = push.at(0.5 * fraction), lm = lift.at(0.5 * fraction);
        const Rates a = rates(s.rotation, s.velocity, push.begin, lift.begin, direction);
        const double v2 = s.velocity + half * a.turning;
        const Rates b = rates(s.rotation + half * s.velocity, v2, pm, lm, direction);
        const double v3 = s.velocity + half * b.turning;
        const Rates c = rates(s.rotation + half * v2, v3, pm, lm, direction);
        const double v4 = s.velocity + h * c.turning;
        const Rates d = rates(s.rotation + h * v3, v4, push.at(fraction), lift.at(fraction), direction);
        return {s.rotation + h / 6.0 * (s.velocity + 2.0 * (v2 + v3) + v4), s.velocity + h / 6.0 * (a.turning + 2.0 * (b.turning + c.turning) + d.turning),
                s.slip + h / 6.0 * (a.sliding + 2.0 * (b.sliding + c.sliding) + d.sliding)};
    }

    double alpha_, size_, mu_, g_, inertia_, whole_;
};

}  // namespace rocking::contact
