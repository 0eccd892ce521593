// Bodies on each other, and the corners in contact at each joint: gap and displacement along the face, exact for any rotation.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace rocking::stack {

constexpr double kHalfPi = 1.5707963267948966;

struct Vector {
    double x = 0.0, z = 0.0;
};
inline Vector operator+(Vector a, Vector b) { return {a.x + b.x, a.z + b.z}; }
inline Vector operator-(Vector a, Vector b) { return {a.x - b.x, a.z - b.z}; }
inline double dot(Vector a, Vector b) { return a.x * b.x + a.z * b.z; }

// Rotation of a body. The series has the same bits on every processor; its error is a rounding error up to a quarter turn.
struct Turn {
    double s = 0.0, c = 1.0;
    Turn() = default;
    explicit Turn(double x) {
        const double q = x * x;
        double odd = 1.0, even = 1.0;
        for (int k = 22; k > 1; k -= 2) {
            even = 1.0 - q / (k * (k - 1)) * even;
            odd = 1.0 - q / (k * (k + 1)) * odd;
        }
        s = x * odd, c = even;
    }
    Vector of(Vector v) const { return {v.x * c + v.z * s, v.z * c - v.x * s}; }    // clockwise
    Vector back(Vector v) const { return {v.x * c - v.z * s, v.z * c + v.x * s}; }  // into the axes of the body
};

// A body: corners from its centre of mass, in its axes. A body below the lowest body is the ground.
struct Body {
    double inverse_mass, inverse_inertia;
    double left, right, base, top_left, top_right, top;
};

struct State {
    Vector at;
    double angle = 0.0;
};

// A corner in contact: a corner of the upper body on the face of the lower body, or the reverse.
struct Corner {
    bool above;   // true for a corner of the upper body
    Vector own;   // corner in the axes of its body
    double face;  // height of the face in the axes of the other body
};

struct Measure {
    double gap, along;
};

// Directions of a corner: the row of the upper body is (x, z, moment), that of the lower body its negative with its own moment.
struct Row {
    double x = 0.0, z = 0.0, upper = 0.0, lower = 0.0;
};

inline Measure measure(const Corner& k, const State& upper, const Turn& tu, const State& lower, const Turn& tl) {
    if (k.above) {
        const Vector d = tl.back(upper.at + tu.of(k.own) - lower.at);
        return {d.z - k.face, d.x};
    }
    const Vector d = tu.back(lower.at + tl.of(k.own) - upper.at);
    return {k.face - d.z, -d.x};
}

inline std::array<Row, 2> rows_of(const Corner& k, const State& upper, const Turn& tu, const State& lower, const Turn& tl) {
    const Turn& face = k.above ? tl : tu;
    const Vector point = k.above ? upper.at + tu.of(k.own) : lower.at + tl.of(k.own);
    const Vector a = point - upper.at, b = point - lower.at;
    const auto row = [&](Vector d) { return Row{d.x, d.z, a.z * d.x - a.x * d.z, b.z * d.x - b.x * d.z}; };
    return {row({face.s, face.c}), row({face.c, -face.s})};
}

}  // namespace rocking::stack
