// Taylor series of a step about a fixed point or edge. About a point, with the axes of the ground in axes of the body, X, Y, Z, and
// G(t) = (Gx, Gy, Gz) gravity less the acceleration of the ground,
//     X' = X x w, Y' = Y x w, Z' = Z x w,      I_A w' = rho x m (Gx X + Gy Y + Gz Z) - w x I_A w,
// The equations are quadratic: each coefficient follows from earlier coefficients by sums of products, three components
// per register. About an edge e, the rotation angle phi since the start of the step follows from the plane equation
//     I_e phi'' = m (P(t) cos phi - Q(t) sin phi),      P = (e x rho) . G, Q = (rho - e (e . rho)) . G,
// with G in body axes at the start.
#pragma once
#include "body.hpp"

namespace rocking::spatial {
namespace ROCKING_ISA {

constexpr int kMostOrder = 16, kDegrees = 8;

// Coefficients by power. The unit of time is the step. Velocities are in radians per step.
struct Series {
    int order = 0;
    Four x[kMostOrder + 1], y[kMostOrder + 1], z[kMostOrder + 1], w[kMostOrder + 1];
};

// Coefficient k of a x w, with its components shifted by one. The newest coefficients are used last, so that no
// operation waits.
template <int N>
inline Four turned(const Four* a, const Four* ar, const Four* w, const Four* wr, int k, double inverse) {
    if (k == 0) return a[0] * wr[0] - ar[0] * w[0];
    Four plus = four(0.0), minus = four(0.0);
    ROCKING_EACH_TERM
    for (int j = 1; j < k; ++j) {
        plus = plus + a[j] * wr[k - j];
        minus = minus + ar[j] * w[k - j];
    }
    plus = plus + a[0] * wr[k] + a[k] * wr[0];
    minus = minus + ar[0] * w[k] + ar[k] * w[0];
    return (plus - minus) * four(inverse);
}

// `field`: coefficients of G by power and axis, over the step; `state`: X, Y, Z and the velocity times the step.
template <int N, int D>
inline void series(const Pivot& pivot, const Four* state, double length, const double (*field)[3], Series& s) {
    Four x[N + 1], y[N + 1], z[N + 1], w[N + 1], xr[N + 1], yr[N + 1], zr[N + 1], wr[N + 1];
    x[0] = state[0], y[0] = state[1], z[0] = state[2], w[0] = state[3];
    xr[0] = next_of(x[0]), yr[0] = next_of(y[0]), zr[0] = next_of(z[0]), wr[0] = next_of(w[0]);
    const Four square = four(length * length);
    const Four t0 = pivot.torque[0] * square, t1 = pivot.torque[1] * square, t2 = pivot.torque[2] * square;
    ROCKING_EACH_TERM
    for (int k = 0; k < N; ++k) {
        const double inverse = 1.0 / (k + 1);
        Four g = four(0.0), h = four(0.0);
        ROCKING_EACH_TERM
        for (int j = k < D ? k : D; j >= 0; --j) {
            g = g + four(field[j][0]) * x[k - j] + four(field[j][1]) * y[k - j];
            h = h + four(field[j][2]) * z[k - j];
        }
        g = g + h;
        Four rate = t0 * all_of<0>(g) + t1 * all_of<1>(g) + t2 * all_of<2>(g);
        Four same = four(0.0), other = four(0.0);
        ROCKING_EACH_TERM
        for (int j = 1; j < k; ++j) {
            same = same + w[j] * w[k - j];
            other = other + w[j] * wr[k - j];
        }
        same = same + four(k == 0 ? 1.0 : 2.0) * w[0] * w[k];
        other = other + w[0] * wr[k];
        if (k > 0) other = other + w[k] * wr[0];
        rate = rate + pivot.gyro[0] * all_of<0>(same) + pivot.gyro[1] * all_of<1>(same);
        Four remainder = pivot.gyro[2] * all_of<2>(same) + pivot.gyro[3] * all_of<0>(other);
        remainder = remainder + pivot.gyro[4] * all_of<1>(other) + pivot.gyro[5] * all_of<2>(other);
        rate = rate + remainder;  // Eq. 22
        const Four a = turned<N>(x, xr, w, wr, k, inverse), b = turned<N>(y, yr, w, wr, k, inverse);
        const Four c = turned<N>(z, zr, w, wr, k, inverse);
        x[k + 1] = next_of(a), xr[k + 1] = mixed<2, 0, 1, 3>(a);
        y[k + 1] = next_of(b), yr[k + 1] = mixed<2, 0, 1, 3>(b);
        z[k + 1] = next_of(c), zr[k + 1] = mixed<2, 0, 1, 3>(c);
        w[k + 1] = rate * four(inverse), wr[k + 1] = next_of(w[k + 1]);
    }
    s.order = N;
    ROCKING_EACH_TERM
    for (int k = 0; k <= N; ++k) s.x[k] = x[k], s.y[k] = y[k], s.z[k] = z[k], s.w[k] = w[k];
}

// Coefficients of cos phi, sin phi and phi' (radians per step).
struct Turn {
    double cosine[kMostOrder + 1], sine[kMostOrder + 1], rate[kMostOrder + 1];
};

// `push` and `weight`: P and Q by power, times mass * step^2 / I_e.
template <int N, int D>
inline void turn(double rate, const double* push, const double* weight, Turn& t) {
    t.cosine[0] = 1.0, t.sine[0] = 0.0, t.rate[0] = rate;
    ROCKING_EACH_TERM
    for (int k = 0; k < N; ++k) {
        const double inverse = 1.0 / (k + 1);
        double bend = 0.0, c = 0.0, s = 0.0;
        ROCKING_EACH_TERM
        for (int j = k < D ? k : D; j >= 0; --j) bend += push[j] * t.cosine[k - j] - weight[j] * t.sine[k - j];
        ROCKING_EACH_TERM
        for (int j = 1; j < k; ++j) {
            c += t.rate[k - j] * t.sine[j];
            s += t.rate[k - j] * t.cosine[j];
        }
        c += t.rate[0] * t.sine[k];
        s += t.rate[0] * t.cosine[k];
        if (k > 0) s += t.rate[k];  // times the initial cosine, 1; the initial sine is zero
        t.rate[k + 1] = bend * inverse, t.cosine[k + 1] = -c * inverse, t.sine[k + 1] = s * inverse;
    }
}

inline Four value_at(const Four* c, int order, double at) {
    Four total = c[order];
    for (int k = order - 1; k >= 0; --k) total = total * four(at) + c[k];
    return total;
}

// Changes the unit of time to a part of the step; velocities are then in radians per part.
inline void shorten(Series& s, double fraction) {
    double power = 1.0;
    for (int k = 0; k <= s.order; ++k, power *= fraction) {
        s.x[k] = s.x[k] * four(power), s.y[k] = s.y[k] * four(power), s.z[k] = s.z[k] * four(power);
        s.w[k] = s.w[k] * four(power * fraction);
    }
}

}  // namespace ROCKING_ISA
}  // namespace rocking::spatial
