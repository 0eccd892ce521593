// A body on two feet, described from its centre of mass, per unit of mass: x to the right, z upwards, theta clockwise.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace rocking::contact {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kHalfPi = 1.5707963267948966;
constexpr int kLeft = 1, kRight = 2, kBoth = 3;  // feet, as bits

enum Outcome : std::int64_t { kNoUplift, kRocked, kOverturned, kFailed, kSlid, kRockedAndSlid, kFlew };
enum Status : std::int64_t { kGood = 0, kInvalid = 1, kNotFinite = 2, kTooManyEvents = 3, kStuck = 6, kNoForce = 7 };
enum class Bounce : std::int64_t { newton, poisson, stronge };

// Sine and cosine for |x| <= pi / 2, as series that give the same bits on all processors.
struct Terms {
    double term[22] = {1.0, 1.0};
    constexpr Terms() {
        double factorial = 1.0;
        for (int k = 2; k <= 21; ++k) factorial *= k, term[k] = (k % 4 < 2 ? 1.0 : -1.0) / factorial;
    }
};
constexpr Terms kSeries;

inline void sine_cosine(double x, double& sine, double& cosine) {
    const double z = x * x;
    double s = kSeries.term[21], c = kSeries.term[20];
    for (int k = 18; k >= 2; k -= 2) s = s * z + kSeries.term[k + 1], c = c * z + kSeries.term[k];
    sine = x + x * (z * s), cosine = 1.0 + z * c;
}

struct Base {
    double inertia, height, lever[3];  // j = I_C / m; h; d of the left foot [1] and d of the right foot [2]
    double size, pace, slow, alpha[3];  // R, sqrt(g / R), speed that counts as zero, slenderness angles of both sides
    double width() const { return lever[kRight] - lever[kLeft]; }
};

struct State {
    double x = 0.0, rise = 0.0, rotation = 0.0, u = 0.0, w = 0.0, spin = 0.0;
    int touching = kBoth;
};

// Position of a foot relative to the centre of mass, and rise of the centre above rest while that foot is in contact.
struct Arm {
    double x, z, rise;
};

inline Arm arm(const Base& b, double lever, double rotation) {
    double sine, cosine;  // sine and cosine of half the rotation
    sine_cosine(0.5 * rotation, sine, cosine);
    const double turned = 2.0 * sine * cosine, lowered = 2.0 * sine * sine, upright = 1.0 - lowered;
    return {lever * upright - b.height * turned, -lever * turned - b.height * upright, lever * turned - b.height * lowered};  // Eq. 58, 59
}
inline double along(const State& s, Arm r) { return s.u + r.z * s.spin; }
inline double away(const State& s, Arm r) { return s.w - r.x * s.spin; }
inline double along(const Base& b, const State& s, int foot) { return along(s, arm(b, b.lever[foot], s.rotation)); }
inline double away(const Base& b, const State& s, int foot) { return away(s, arm(b, b.lever[foot], s.rotation)); }
inline double kinetic(const Base& b, const State& s) { return 0.5 * (s.u * s.u + s.w * s.w + b.inertia * s.spin * s.spin); }
inline double largest_speed(const Base& b, const State& s) {
    return std::max({std::fabs(s.u), std::fabs(s.w), b.size * std::fabs(s.spin)});
}
struct Mode {
    int feet, slip;
    bool operator==(const Mode& m) const { return feet == m.feet && slip == m.slip; }
};
constexpr Mode kRest{kBoth, 0}, kFlight{0, 0};

// The state, corrected to satisfy the contact conditions exactly.
inline State kept(const Base& b, State s, int feet, bool stick) {
    if (!feet) return s;
    if (feet == kBoth) {
        s.u = stick ? 0.0 : along(b, s, kLeft);
        s.rise = s.rotation = s.w = s.spin = 0.0;
        s.touching = kBoth;
        return s;
    }
    const Arm r = arm(b, b.lever[feet], s.rotation);
    s.rise = r.rise;
    if (stick) s.u = -(r.z * s.spin);
    s.w = r.x * s.spin;
    return s;
}

}  // namespace rocking::contact
