// Linear oscillators under accelerations that are linear between samples: states and peak responses. With the
// complex rate s the state z = u' - conj(s) u obeys z' = s z - a (Eq. 150).
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace rocking::motions {

// Wider registers change only the computing time: products and sums are never fused.
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__)
#define ROCKING_WIDER __attribute__((target_clones("avx2", "default")))
#else
#define ROCKING_WIDER
#endif

constexpr double kPi = 3.14159265358979323846;
using Complex = std::complex<double>;

static inline Complex times(Complex a, Complex b) {
    return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

// State after a time, and response to a ground acceleration that starts at one and rises by one per step (Eqs. 151,
// 152).
struct Stretch {
    Complex decay, level, rise;
    Stretch(Complex rate, double t, double step) {
        const Complex x = rate * t;
        decay = std::exp(x);
        Complex first, second;
        if (std::abs(x) <= 1.0) {
            second = 0.0;
            double factorial = 2432902008176640000.0;  // 20!
            for (int k = 20; k > 1; --k) {
                second = 1.0 / factorial + times(x, second);
                factorial /= k;
            }
            first = 1.0 + times(x, second);
        } else {
            first = (decay - 1.0) / x;
            second = (first - 1.0) / x;
        }
        level = -t * first;
        rise = -(t * t / step) * second;
    }
    Complex after(Complex z, double ground, double more) const { return times(decay, z) + level * ground + rise * more; }
};

// Displacement, velocity and absolute acceleration, each with its rate of change.
struct Feels {
    double value[3], change[3];
    Feels(Complex z, double ground, Complex s) {
        const double friction = -2.0 * s.real(), omega2 = std::norm(s);
        const double u = z.imag() / s.imag(), v = z.real() + s.real() * u, absolute = -friction * v - omega2 * u;
        value[0] = u, value[1] = change[0] = v, value[2] = absolute;
        change[1] = absolute - ground, change[2] = -friction * change[1] - omega2 * v;
    }
};

// Largest magnitude of the cubic with given values and slopes at both ends of a segment; the start value is excluded.
static inline double cubic_peak(double y, double d, double z, double e, double best) {
    best = std::max(best, std::abs(z));
    // a cubic exceeds its end values by at most 4/27 of its slopes, so most segments need no closer examination
    if (std::max(std::abs(y), std::abs(z)) + 4.0 / 27.0 * (std::abs(d) + std::abs(e)) <= best) return best;
    const double bend = d + e - 2.0 * (z - y), turn = 3.0 * (z - y) - 2.0 * d - e;
    const double inside = turn * turn - 3.0 * bend * d;
    if (inside < 0.0) return best;
    const double q = -(turn + std::copysign(std::sqrt(inside), turn));
    for (const double t : {q / (3.0 * bend), d / q})
        if (t > 0.0 && t < 1.0) best = std::max(best, std::abs(y + t * (d + t * (turn + t * bend))));
    return best;
}

constexpr int kTogether = 4;  // oscillators that are computed in parallel

struct Lanes {
    double decay_r[kTogether] = {}, decay_i[kTogether] = {}, before_r[kTogether] = {}, before_i[kTogether] = {},
           after_r[kTogether] = {}, after_i[kTogether] = {}, inverse[kTogether] = {}, real[kTogether] = {},
           friction[kTogether] = {}, omega2[kTogether] = {};
    double top[3][kTogether] = {};
};

// States at the samples, from rest at the first sample, and the largest magnitudes at the samples.
ROCKING_WIDER void follow(const double* a, std::size_t n, Lanes& with, double* re, double* im) {
    double x[kTogether] = {}, y[kTogether] = {}, top[3][kTogether] = {};
    for (int i = 0; i < kTogether; ++i) re[i] = im[i] = 0.0;
    for (std::size_t k = 1; k < n; ++k) {
        const double before = a[k - 1], after = a[k];
        for (int i = 0; i < kTogether; ++i) {
            const double p = with.before_r[i] * before + with.after_r[i] * after;
            const double q = with.before_i[i] * before + with.after_i[i] * after;
            const double was = x[i];
            x[i] = (with.decay_r[i] * was - with.decay_i[i] * y[i]) + p;
            y[i] = (with.decay_r[i] * y[i] + with.decay_i[i] * was) + q;
            re[k * kTogether + i] = x[i];
            im[k * kTogether + i] = y[i];
            const double u = y[i] * with.inverse[i], v = x[i] + with.real[i] * u;
            const double absolute = with.friction[i] * v + with.omega2[i] * u;
            top[0][i] = std::max(top[0][i], std::abs(u));
            top[1][i] = std::max(top[1][i], std::abs(v));
            top[2][i] = std::max(top[2][i], std::abs(absolute));
        }
    }
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < kTogether; ++i) with.top[j][i] = top[j][i];
}

// In a step a state changes by at most the integral of the ground acceleration. The bound uses both ends.
ROCKING_WIDER void reaches(const double* push, std::size_t steps, const double* shrink, const double* re, const double* im,
                           const double* needed, std::vector<std::uint8_t>& close) {
    double size[kTogether] = {};
    for (std::size_t k = 0; k < steps; ++k) {
        std::uint8_t is_close = 0;
        for (int i = 0; i < kTogether; ++i) {
            const double x = re[(k + 1) * kTogether + i], y = im[(k + 1) * kTogether + i], next = std::sqrt(x * x + y * y);
            is_close |= static_cast<std::uint8_t>((size[i] + shrink[i] * (next + push[k]) > needed[i]) << i);
            size[i] = next;
        }
        close[k] = is_close;
    }
}

// Data of a group of consecutive oscillators for `follow`.
static Lanes lanes(const Complex* rates, std::size_t group_size, double step) {
    Lanes with;
    for (std::size_t i = 0; i < group_size; ++i) {
        const Complex s = rates[i];
        const Stretch stretch(s, step, step);
        with.decay_r[i] = stretch.decay.real(), with.decay_i[i] = stretch.decay.imag();
        with.before_r[i] = (stretch.level - stretch.rise).real(), with.before_i[i] = (stretch.level - stretch.rise).imag();
        with.after_r[i] = stretch.rise.real(), with.after_i[i] = stretch.rise.imag();
        with.inverse[i] = 1.0 / s.imag(), with.real[i] = s.real();
        with.friction[i] = -2.0 * s.real(), with.omega2[i] = std::norm(s);
    }
    return with;
}

static void states_of(const double* a, std::size_t n, double step, const Complex* rates, std::size_t count, Complex* states) {
    std::vector<double> re(n * kTogether), im(n * kTogether);
    for (std::size_t first = 0; first < count; first += kTogether) {
        const std::size_t group_size = std::min<std::size_t>(kTogether, count - first);
        Lanes with = lanes(rates + first, group_size, step);
        follow(a, n, with, re.data(), im.data());
        for (std::size_t i = 0; i < group_size; ++i)
            for (std::size_t k = 0; k < n; ++k) states[(first + i) * n + k] = {re[k * kTogether + i], im[k * kTogether + i]};
    }
}

// Largest displacement, velocity and absolute acceleration, one row per oscillator. `reach` contains the largest
// values of these three quantities over all states of magnitude one. `parts` is the number of parts of a step, and
// `points` the number of points in free vibration.
static void peaks_of(const double* a, std::size_t n, double step, const Complex* rates, std::size_t count,
                     const double* reach, const std::int64_t* parts, double margin, std::int64_t points, double* peaks) {
    std::vector<double> re(n * kTogether), im(n * kTogether), push(n);
    std::vector<std::uint8_t> close(n);
    for (std::size_t k = 0; k + 1 < n; ++k) push[k] = step * std::max(std::abs(a[k]), std::abs(a[k + 1]));
    for (std::size_t first = 0; first < count; first += kTogether) {
        const std::size_t group_size = std::min<std::size_t>(kTogether, count - first);
        Lanes with = lanes(rates + first, group_size, step);
        follow(a, n, with, re.data(), im.data());
        double shrink[kTogether] = {}, needed[kTogether];
        std::fill(needed, needed + kTogether, std::numeric_limits<double>::infinity());
        std::vector<Stretch> stretches[kTogether];
        for (std::size_t i = 0; i < group_size; ++i) {
            const Complex s = rates[first + i];
            Complex z{re[(n - 1) * kTogether + i], im[(n - 1) * kTogether + i]};
            const Complex turn = std::exp(s * (kPi / s.imag() / static_cast<double>(points - 1)));
            for (std::int64_t k = 0; k < points; ++k, z = times(z, turn)) {
                const Feels free(z, 0.0, s);
                for (int j = 0; j < 3; ++j) with.top[j][i] = std::max(with.top[j][i], std::abs(free.value[j]));
            }
            shrink[i] = std::exp(-s.real() * step);
            for (int j = 0; j < 3; ++j)
                needed[i] = std::min(needed[i], with.top[j][i] / reach[3 * (first + i) + j] / (0.5 * margin));
            const std::int64_t number = parts[first + i];
            for (std::int64_t k = 1; k <= number; ++k)
                stretches[i].emplace_back(s, static_cast<double>(k) * step / static_cast<double>(number), step);
        }
        reaches(push.data(), n - 1, shrink, re.data(), im.data(), needed, close);
        for (std::size_t k = 0; k + 1 < n; ++k)
            for (std::size_t i = 0; close[k] >> i; ++i) {
                if (!(close[k] >> i & 1)) continue;
                const Complex s = rates[first + i], start{re[k * kTogether + i], im[k * kTogether + i]};
                const double rise = a[k + 1] - a[k], count_of = static_cast<double>(stretches[i].size());
                Feels left(start, a[k], s);
                for (std::size_t index = 0; index < stretches[i].size(); ++index) {
                    const double at = static_cast<double>(index + 1) / count_of, width = step / count_of;
                    const Feels right(stretches[i][index].after(start, a[k], rise), a[k] + at * rise, s);
                    for (int j = 0; j < 3; ++j)
                        with.top[j][i] = cubic_peak(left.value[j], width * left.change[j], right.value[j],
                                                    width * right.change[j], with.top[j][i]);
                    left = right;
                }
            }
        for (std::size_t i = 0; i < group_size; ++i)
            for (int j = 0; j < 3; ++j) peaks[3 * (first + i) + j] = with.top[j][i];
    }
}

// Largest extent of a path in every direction, and an inscribed ellipse of similar shape.
struct Outline {
    const double *cosine, *sine;
    std::size_t count;
    std::vector<double> best;
    // a point inside the ellipse has a smaller quadratic form than `inside`, and does not change the extent
    double xx, xy, yy, inside = 0.0;

    ROCKING_WIDER static void raise_by(double x, double y, const double* cosine, const double* sine, std::size_t count,
                                       double* best) {
        for (std::size_t i = 0; i < count; ++i) best[i] = std::max(best[i], std::abs(x * cosine[i] + y * sine[i]));
    }
    double form(double x, double y) const { return xx * x * x + 2.0 * xy * x * y + yy * y * y; }
    double form(Complex z, Complex w) const { return form(z.real(), w.real()) + form(z.imag(), w.imag()); }
    void settle() {
        inside = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < count; ++i) {
            const double c = cosine[i], s = sine[i], reach = yy * c * c - 2.0 * xy * c * s + xx * s * s;
            if (reach > 0.0) inside = std::min(inside, best[i] * best[i] * (xx * yy - xy * xy) / reach);
        }
    }
    bool beyond(double x, double y) const { return form(x, y) > inside; }
    void raise(double x, double y) {
        if (beyond(x, y)) raise_by(x, y, cosine, sine, count, best.data());
    }
};

// Largest displacement in every direction under two components, one row per oscillator.
static void directions_of(const double* a, const double* b, std::size_t n, double step, const Complex* rates, std::size_t count,
                          const double* cosine, const double* sine, std::size_t directions, const std::int64_t* parts,
                          std::int64_t points, double* peaks) {
    std::vector<double> re(n * kTogether), im(n * kTogether), re2(n * kTogether), im2(n * kTogether);
    for (std::size_t first = 0; first < count; first += kTogether) {
        const std::size_t group_size = std::min<std::size_t>(kTogether, count - first);
        Lanes along = lanes(rates + first, group_size, step), across = along;
        follow(a, n, along, re.data(), im.data());
        follow(b, n, across, re2.data(), im2.data());
        for (std::size_t i = 0; i < group_size; ++i) {
            const Complex s = rates[first + i];
            const double inverse = 1.0 / s.imag(), shrink = std::exp(-s.real() * step);
            const auto first_state = [&](std::size_t k) { return Complex{re[k * kTogether + i], im[k * kTogether + i]}; };
            const auto other = [&](std::size_t k) { return Complex{re2[k * kTogether + i], im2[k * kTogether + i]}; };
            double xx = 0.0, xy = 0.0, yy = 0.0;
            for (std::size_t k = 0; k < n; ++k) {
                const double x = first_state(k).imag(), y = other(k).imag();
                xx += x * x, xy += x * y, yy += y * y;
            }
            const double room = 1e-6 * (xx + yy);  // for a path that is nearly a line
            Outline outline{cosine, sine, directions, std::vector<double>(directions, 0.0), yy + room, -xy, xx + room};
            // the extreme points in some directions first: then most other points are inside the ellipse
            for (std::size_t d = 0; d < directions; d += 12) {
                double most = -1.0;
                std::size_t at = 0;
                for (std::size_t k = 0; k < n; ++k) {
                    const double far = std::abs(cosine[d] * first_state(k).imag() + sine[d] * other(k).imag());
                    if (far > most) most = far, at = k;
                }
                outline.raise(first_state(at).imag() * inverse, other(at).imag() * inverse);
            }
            outline.settle();
            for (std::size_t k = 0; k < n; ++k) outline.raise(first_state(k).imag() * inverse, other(k).imag() * inverse);
            Complex x = first_state(n - 1), y = other(n - 1);
            const Complex turn = std::exp(s * (kPi / s.imag() / static_cast<double>(points - 1)));
            for (std::int64_t k = 0; k < points; ++k, x = times(x, turn), y = times(y, turn))
                outline.raise(x.imag() * inverse, y.imag() * inverse);
            outline.settle();
            std::vector<Stretch> stretches;
            const auto number = static_cast<double>(parts[first + i]);
            for (std::int64_t k = 1; k <= parts[first + i]; ++k)
                stretches.emplace_back(s, static_cast<double>(k) * step / number, step);
            const double needed = 2.0 * s.imag() * std::sqrt(outline.inside), width = step / number;
            double size = 0.0, pushed = std::sqrt(outline.form(a[0], b[0]));
            for (std::size_t k = 0; k + 1 < n; ++k) {
                // in a step a state changes by at most the integral of the ground acceleration, measured from either
                // end
                const double next = std::sqrt(outline.form(first_state(k + 1), other(k + 1)));
                const double push = std::sqrt(outline.form(a[k + 1], b[k + 1]));
                const bool close = size + shrink * (next + step * std::max(pushed, push)) >= needed;
                size = next, pushed = push;
                if (!close) continue;
                Complex left = first_state(k), left2 = other(k);
                for (const Stretch& stretch : stretches) {
                    const Complex right = stretch.after(first_state(k), a[k], a[k + 1] - a[k]);
                    const Complex right2 = stretch.after(other(k), b[k], b[k + 1] - b[k]);
                    const double p = left.imag() * inverse, q = left2.imag() * inverse;
                    const double z = right.imag() * inverse, w = right2.imag() * inverse;
                    const double d = width * (left.real() + s.real() * p), d2 = width * (left2.real() + s.real() * q);
                    const double e = width * (right.real() + s.real() * z), e2 = width * (right2.real() + s.real() * w);
                    // a cubic is inside the convex hull of its ends and two points on its tangents
                    if (outline.beyond(p, q) || outline.beyond(z, w) || outline.beyond(p + d / 3.0, q + d2 / 3.0) ||
                        outline.beyond(z - e / 3.0, w - e2 / 3.0)) {
                        for (const double t : {0.25, 0.5, 0.75})
                            outline.raise(p + t * (d + t * (3.0 * (z - p) - 2.0 * d - e + t * (d + e - 2.0 * (z - p)))),
                                          q + t * (d2 + t * (3.0 * (w - q) - 2.0 * d2 - e2 + t * (d2 + e2 - 2.0 * (w - q)))));
                        outline.raise(z, w);
                    }
                    left = right, left2 = right2;
                }
            }
            std::copy(outline.best.begin(), outline.best.end(), peaks + (first + i) * directions);
        }
    }
}

}  // namespace rocking::motions
