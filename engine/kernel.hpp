// The fast engine: Taylor steps of many histories side by side, each lane at its own sample of its own motion.
//
// A lane holds u = alpha - |theta| and its derivative, on the side on which the body stands:
//     u'' = p^2 { (1 + a_z / g) S + s (a_x / g) C },   S = sin u, C = cos u   (slender-linear: S = u, C = 1),
// with s = +1 on the right foot. S and C are carried as series: S' = C u', C' = -S u'. One expansion covers one stretch
// of the motion or a part of it; whatever is not a plain step (impact, uplift, rest, the top, the end) is left to the
// lane-by-lane part, so that the part that counts has no branches.
#pragma once
#include <algorithm>
#include <atomic>
#include <limits>

#include "batch.hpp"
#include "pack.hpp"
#include "roots.hpp"
#include "sine.hpp"

namespace rocking {
namespace ROCKING_ISA {

constexpr double kWhole = 1.0 - 1e-13;  // a step that ends this close to the end of its stretch ends with it
constexpr double kHalfPi = 1.57079632679489661923;

inline std::uint64_t mixed(std::uint64_t z) {
    z += 0x9E3779B97F4A7C15ull;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return z ^ (z >> 31);
}

// Number in [0, 1) that depends on the seed, the history and the count of its impacts, on nothing else.
inline double uniform(std::uint64_t seed, std::int64_t key, std::int64_t impact) {
    const std::uint64_t z =
        mixed(mixed(mixed(seed) + static_cast<std::uint64_t>(key)) + static_cast<std::uint64_t>(impact));
    return static_cast<double>(z >> 11) * 0x1p-53;
}

inline double interpolated(const std::vector<double>& at, const std::vector<double>& value, double x) {
    if (!(x > at.front())) return value.front();
    if (x >= at.back()) return value.back();
    const std::size_t k = std::upper_bound(at.begin(), at.end(), x) - at.begin();
    return value[k - 1] + (value[k] - value[k - 1]) * ((x - at[k - 1]) / (at[k] - at[k - 1]));
}

#define ROCKING_LANES ROCKING_UNROLL for (int j = 0; j < U; ++j)

template <int U, int N, int D, bool Z, bool L>
class Kernel {
    static constexpr int P = Pack::width, W = U * P;

    // state of the lanes; unused ones stay at rest on stretch zero
    alignas(64) double u[W], v[W], tau[W], len[W], sub[W], kappa[W], ca[W], cz[W], alpha[W], peak[W], idx[W], last[W],
        stride[W], err[W], fastest[W], gate[W];
    alignas(64) double terms[N + 1][W];

    struct Side {
        double alpha, p, sine, cosine, r;
    };
    struct Lane {
        std::int64_t row = -1, impacts = 0, uplifts = 0;
        int side = 0;
        Side sides[2];
        double scale, ax, az, step, first, peak_signed, peak_time, over_time, first_uplift;
        const Shake* shake;
    } lanes[W];

    const Motions& motions;
    const Law& law;
    const Rows& rows;
    const Settings& set;
    Trace* trace;
    std::int64_t next, end;
    int active = 0;

  public:
    Work work;

    Kernel(const Motions& m, const Law& l, const Rows& r, const Settings& s, Trace* t) : motions(m), law(l), rows(r), set(s), trace(t) {}

    void run(std::int64_t from, std::int64_t to) {
        next = from;
        end = to;
        active = 0;
        for (int i = 0; i < W; ++i) fill(i);
        while (active) sweep();
    }

  private:
    static Side side_of(double alpha, double p, double r) {
        Side s{alpha, p, alpha, 1.0, r};
        if (!L) sine_cosine(alpha, s.sine, s.cosine);
        return s;
    }

    const Side& here(int i) const { return lanes[i].sides[lanes[i].side > 0 ? 0 : 1]; }

    static int lowest(unsigned long bits) {
#if defined(__GNUC__)
        return __builtin_ctzl(bits);
#else
        int i = 0;
        while (!(bits >> i & 1)) ++i;
        return i;
#endif
    }

    // ---- all lanes at once ------------------------------------------------------------------------------------------

    // One Taylor step of every lane; those that need a visit keep their state until they have had it.
    void sweep() {
        work.steps += active;
        ++work.sweeps;
        Pack u0[U], v0[U], t0[U], h[U], i0[U], b[D + 1][U], z[2][U], S[N + 1][U], C[N + 1][U], V[N + 1][U], q[U];
        ROCKING_LANES {
            u0[j] = Pack::load(u + j * P);
            v0[j] = Pack::load(v + j * P);
            t0[j] = Pack::load(tau + j * P);
            h[j] = Pack::load(len + j * P);
            i0[j] = Pack::load(idx + j * P);
            q[j] = Pack::load(kappa + j * P) * (h[j] * h[j]);
            V[0][j] = v0[j] * h[j];
        }
        forcing(i0, t0, h, b, z);
        ROCKING_LANES {
            if (L) S[0][j] = u0[j];
            else sine_cosine(u0[j], S[0][j], C[0][j]);
        }
        ROCKING_UNROLL
        for (int k = 0; k < N; ++k) {
            const Pack inverse(1.0 / (k + 1));
            ROCKING_LANES {
                Pack f = Z ? fma(z[0][j], S[k][j], S[k][j]) : S[k][j];
                if (Z && k > 0) f = fma(z[1][j], S[k - 1][j], f);
                if (L) {
                    if (k <= D) f = f + b[k][j];
                } else {
                    ROCKING_UNROLL
                    for (int m = 0; m <= (k < D ? k : D); ++m) f = fma(b[m][j], C[k - m][j], f);
                }
                V[k + 1][j] = f * (q[j] * inverse);
            }
            if (k + 1 == N) break;
            ROCKING_LANES {
                if (L) {
                    S[k + 1][j] = V[k][j] * inverse;
                } else {
                    Pack s = V[0][j] * C[k][j], c = V[0][j] * S[k][j];
                    ROCKING_UNROLL
                    for (int m = 1; m <= k; ++m) {
                        s = fma(V[m][j], C[k - m][j], s);
                        c = fma(V[m][j], S[k - m][j], c);
                    }
                    S[k + 1][j] = s * inverse;
                    C[k + 1][j] = c * Pack(-1.0 / (k + 1));
                }
            }
        }
        unsigned long flagged = 0;
        ROCKING_LANES {
            const int at = j * P;
            const Pack zero(0.0);
            Pack v1 = V[0][j], du = V[N][j] * Pack(1.0 / (N + 1)), sag = max(zero - V[1][j], zero) * Pack(0.125);
            ROCKING_UNROLL
            for (int k = 1; k <= N; ++k) v1 = v1 + V[k][j];
            ROCKING_UNROLL
            for (int k = N; k-- > 0;) du = fma(V[k][j], Pack(1.0 / (k + 1)), du);
            ROCKING_UNROLL
            for (int k = 2; k <= N; ++k) sag = fma(max(zero - V[k][j], zero), Pack(1.0 / (k + 1)), sag);
            const Pack u1 = u0[j] + du;
            v1 = v1 / h[j];

            // With y = y0 + c1 x + c2 x^2 + ..., y >= min(y0, y1) - c2+ / 4 - c3+ - ...: between its ends a step can
            // only sag by its convex terms. A step that starts at y = 0 is divided by its known zero first.
            const Pack y0 = Pack::load(alpha + at) - u0[j], y1 = y0 - du;
            const Mask clear = (min(y0, y1) > sag) | ((y0 == zero) & (min(zero - V[0][j], y1) > sag));
            const Mask turning = (v0[j] < zero) & (v1 >= zero) & (fma(Pack(4.0), sag, y0 - V[0][j]) > Pack::load(peak + at));
            const Mask beyond = (u1 < Pack::load(gate + at)) | ((u1 < zero) & (u0[j] >= zero));
            const Pack t1 = t0[j] + h[j];
            const Mask done = t1 >= Pack(kWhole);
            const Pack t2 = select(done, zero, t1), i1 = select(done, i0[j] + Pack::load(stride + at), i0[j]);
            const Mask visit = !clear | beyond | turning | (done & (i1 >= Pack::load(last + at)));
            flagged |= static_cast<unsigned long>(visit.bits()) << at;

            select(visit, u0[j], u1).store(u + at);
            select(visit, v0[j], v1).store(v + at);
            select(visit, t0[j], t2).store(tau + at);
            select(visit, h[j], min(Pack::load(sub + at), Pack(1.0) - t2)).store(len + at);
            select(visit, i0[j], i1).store(idx + at);
            (Pack::load(err + at) + abs(V[N][j])).store(err + at);
            const Pack top = Pack::load(fastest + at);
            select(visit, top, max(top, abs(v1))).store(fastest + at);
            ROCKING_UNROLL
            for (int k = 0; k <= N; ++k) V[k][j].store(&terms[k][at]);
        }
        if (trace && lanes[0].row >= 0 && !(flagged & 1) && tau[0] == 0.0) sample(0);
        while (flagged) {
            const int i = lowest(flagged);
            flagged &= flagged - 1;
            ++work.events;
            if (lanes[i].row >= 0) visit(i);
            if (lanes[i].row < 0) fill(i);
        }
    }

    // Series of the ground's acceleration over the step: s a_x / g in b, a_z / g in z.
    void forcing(const Pack* i0, const Pack* t0, const Pack* h, Pack (*b)[U], Pack (*z)[U]) const {
        const double* data = motions.data;
        ROCKING_LANES {
            const Pack c = Pack::load(ca + j * P);
            if (D == 1) {
                constexpr int hop = Z ? 2 : 1;
                const Pack a = Pack::gather(data, i0[j]), da = Pack::gather(data + hop, i0[j]) - a;
                b[0][j] = c * fma(da, t0[j], a);
                b[1][j] = c * (da * h[j]);
                if (Z) {
                    const Pack w = Pack::load(cz + j * P);
                    const Pack g = Pack::gather(data + 1, i0[j]), dg = Pack::gather(data + hop + 1, i0[j]) - g;
                    z[0][j] = w * fma(dg, t0[j], g);
                    z[1][j] = w * (dg * h[j]);
                }
            } else {
                Pack p[D + 1];
                ROCKING_UNROLL
                for (int k = 0; k <= D; ++k) p[k] = c * Pack::gather(data + k, i0[j]);
                ROCKING_UNROLL
                for (int k = 0; k < D; ++k) {  // Taylor shift to t0
                    ROCKING_UNROLL
                    for (int m = D; m-- > k;) p[m] = fma(t0[j], p[m + 1], p[m]);
                }
                Pack power = h[j];
                b[0][j] = p[0];
                ROCKING_UNROLL
                for (int k = 1; k <= D; ++k) {
                    b[k][j] = p[k] * power;
                    power = power * h[j];
                }
            }
        }
    }

    // ---- one lane ---------------------------------------------------------------------------------------------------

    double now(int i, double fraction) const {
        const Lane& lane = lanes[i];
        const double index = (idx[i] - lane.first) / motions.stride();
        return (index + (tau[i] + fraction * len[i])) * lane.step;
    }

    void sample(int i) {
        const Lane& lane = lanes[i];
        const std::int64_t k = static_cast<std::int64_t>((idx[i] - lane.first) / motions.stride());
        trace->rotation[k] = lane.side * (alpha[i] - u[i]);
        trace->velocity[k] = -lane.side * v[i] / lane.step;
    }

    void note(int i, EventKind kind, double time, double before, double after, double coefficient) {
        if (trace) trace->events.push_back({time, before, after, coefficient, kind, static_cast<std::int8_t>(lanes[i].side)});
    }

    void visit(int i) {
        double V[N + 1], c[N + 2];
        double sum = 0.0;
        for (int k = 0; k <= N; ++k) {
            V[k] = terms[k][i];
            c[k + 1] = -V[k] * (1.0 / (k + 1));
            sum += std::fabs(V[k]);
        }
        c[0] = alpha[i] - u[i];
        if (!(sum < 1e100)) return finish(i, kFailed, kNotFinite);
        const double zero = first_contact(c);
        note_peak(i, c, zero < 1.0 ? zero : 1.0);
        if (zero <= 1.0) return impact(i, c, zero);
        advance(i, V);
    }

    // First return to y = 0; a step that starts there is divided by the known zero first.
    double first_contact(double* c) const {
        if (c[0] > 0.0) return first_zero<N + 1>(c);
        if (c[0] < 0.0) return 0.0;
        if (c[1] > 0.0) return first_zero<N>(c + 1);
        if (c[1] < 0.0) return 0.0;
        c[2] = std::max(c[2], 0.0);  // uplift: the moment just changed sign here, so rounding alone is left
        if (c[2] > 0.0) return first_zero<N - 1>(c + 2);
        if (c[3] > 0.0) return first_zero<N - 2>(c + 3);
        return 2.0;
    }

    void note_peak(int i, const double* c, double upto) {
        if (c[1] < 0.0) return;
        double slopes[N + 1];
        slopes_of<N + 1>(c, slopes);
        if (value_of<N>(slopes, upto) > 0.0) return;
        double at = 2.0;
        if (slopes[0] > 0.0) at = first_zero<N>(slopes);
        else if (slopes[1] > 0.0) at = first_zero<N - 1>(slopes + 1);
        else if (slopes[2] > 0.0) at = first_zero<N - 2>(slopes + 2);
        if (at <= upto) raise_peak(i, value_of<N + 1>(c, at), now(i, at));
    }

    void raise_peak(int i, double y, double time) {
        if (y > peak[i]) {
            peak[i] = y;
            lanes[i].peak_signed = lanes[i].side * y;
            lanes[i].peak_time = time;
        }
    }

    void impact(int i, const double* c, double at) {
        Lane& lane = lanes[i];
        double slopes[N + 1];
        slopes_of<N + 1>(c, slopes);
        const double speed = std::max(0.0, -value_of<N>(slopes, at) / (len[i] * lane.step));
        const double time = now(i, at);
        const int old = lane.side;
        fastest[i] = std::max(fastest[i], speed * lane.step);
        lane.side = -old;
        const double r = coefficient(i, speed);
        const double after = r * speed;
        ++lane.impacts;
        note(i, kImpact, time, -old * speed, -old * after, r);
        stand(i);
        u[i] = alpha[i];
        v[i] = -after * lane.step;
        move(i, tau[i] + at * len[i]);
        if (trace && tau[i] == 0.0) sample(i);
        if (lane.impacts >= set.most_impacts) return finish(i, kFailed, kTooManyImpacts);
        if (idx[i] >= last[i]) return conclude(i);
        if (comes_to_rest(i, after)) {
            note(i, kRest, time, 0.0, 0.0, 0.0);
            rest(i);
        }
    }

    double coefficient(int i, double speed) const {
        const Lane& lane = lanes[i];
        const double r = here(i).r;
        if (law.kind == LawKind::of_speed) return r * interpolated(law.at, law.value, speed);
        if (law.kind == LawKind::random)
            return r * interpolated(law.at, law.value, uniform(law.seed, rows.key[lane.row], lane.impacts));
        return r;
    }

    // Lane variables of the side on which the body stands.
    void stand(int i) {
        const Lane& lane = lanes[i];
        const Side& s = here(i);
        alpha[i] = s.alpha;
        kappa[i] = (s.p * lane.step) * (s.p * lane.step);
        ca[i] = lane.side * lane.ax;
    }

    void move(int i, double to) {
        if (to >= kWhole) {
            idx[i] += motions.stride();
            tau[i] = 0.0;
        } else {
            tau[i] = to;
        }
        len[i] = std::min(sub[i], 1.0 - tau[i]);
    }

    void advance(int i, const double* V) {
        Lane& lane = lanes[i];
        double u1 = V[N] * (1.0 / (N + 1)), v1 = V[0];
        for (int k = N; k-- > 0;) u1 = fma(V[k], 1.0 / (k + 1), u1);
        u1 = u[i] + u1;
        for (int k = 1; k <= N; ++k) v1 += V[k];
        v1 /= len[i];
        if (u[i] >= 0.0 && u1 < 0.0) {
            double c[N + 2];
            c[0] = u[i];
            for (int k = 0; k <= N; ++k) c[k + 1] = V[k] / (k + 1);
            lane.over_time = now(i, u[i] > 0.0 ? std::min(first_zero<N + 1>(c), 1.0) : 0.0);
        }
        u[i] = u1;
        v[i] = v1;
        fastest[i] = std::max(fastest[i], std::fabs(v1));
        move(i, tau[i] + len[i]);
        if (trace && tau[i] == 0.0) sample(i);
        if (u1 < 0.0) {
            const bool lies = alpha[i] - u1 >= kHalfPi && (!L || beyond_return(i));
            if (lies || (!set.to_the_ground && beyond_return(i))) return overturned(i);
            gate[i] = set.to_the_ground ? 0.0 : u1 - 0.02;  // look again a degree further out
        }
        if (idx[i] >= last[i]) conclude(i);
    }

    void overturned(int i) {
        finish(i, kOverturned, kGood);
    }

    // Whether nothing that is still to come can bring the body back: beyond the top, moving out, and even the
    // strongest acceleration left, with the weakest gravity left, leaves it accelerating outwards.
    bool beyond_return(int i) const {
        const Lane& lane = lanes[i];
        if (!(v[i] <= 0.0)) return false;
        if (idx[i] >= last[i]) return true;
        const Bounds& b = bounds_at(i);
        const double back = std::max({0.0, ca[i] * b.later_low, ca[i] * b.later_high});
        const double weight = 1.0 + (Z ? std::min({0.0, lane.az * b.later_vertical_low, lane.az * -b.later_vertical_low}) : 0.0);
        if (L) return weight * -u[i] > back && weight > 0.0;
        if (!(u[i] > -kHalfPi)) return true;
        double s, c;
        sine_cosine(-u[i], s, c);
        return weight * s > back * c && weight > 0.0;
    }

    const Bounds& bounds_at(int i) const {
        const Lane& lane = lanes[i];
        const std::int64_t k = static_cast<std::int64_t>((idx[i] - lane.first) / motions.stride());
        return motions.bounds[lane.shake->block + k / kBlock];
    }

    // Moment that holds the body down on a side, over m g R: D = (1 + a_z / g) sin alpha + s (a_x / g) cos alpha,
    // as a polynomial of the time within a stretch.
    void holding(int i, int side, std::int64_t at, double* d) const {
        const Lane& lane = lanes[i];
        const Side& s = lane.sides[side > 0 ? 0 : 1];
        const double* a = motions.data + at;
        if (D == 1) {
            constexpr int hop = Z ? 2 : 1;
            d[0] = s.sine + side * lane.ax * a[0] * s.cosine;
            d[1] = side * lane.ax * (a[hop] - a[0]) * s.cosine;
            if (Z) {
                d[0] += lane.az * a[1] * s.sine;
                d[1] += lane.az * (a[hop + 1] - a[1]) * s.sine;
            }
        } else {
            for (int k = 0; k <= D; ++k) d[k] = side * lane.ax * a[k] * s.cosine;
            d[0] += s.sine;
        }
    }

    // First instant of the stretch, from `from` on, at which a side is no longer held down; 2 if it is throughout.
    double release(int i, int side, std::int64_t at, double from) const {
        double d[D + 1];
        holding(i, side, at, d);
        double spread = 0.0;
        for (int k = 1; k <= D; ++k) spread += std::fabs(d[k]);
        if (d[0] > spread) return 2.0;
        if (value_of<D>(d, from) < 0.0) return from;
        if (D == 1) {
            if (!(d[0] + d[1] < 0.0)) return 2.0;
            return std::min(std::max(-d[0] / d[1], from), 1.0);
        }
        for (int k = 0; k < D; ++k)
            for (int j = D; j-- > k;) d[j] = fma(from, d[j + 1], d[j]);
        double power = 1.0;
        for (int k = 0; k <= D; ++k) {
            d[k] *= power;
            power *= 1.0 - from;
        }
        if (!(d[0] > 0.0)) d[0] = std::numeric_limits<double>::min();
        const double zero = first_zero<D>(d);
        return zero > 1.0 ? 2.0 : from + zero * (1.0 - from);
    }

    // Least and largest holding moment of each side over a window of time, and a bound on how fast they change with y.
    struct Window {
        double low[2], high[2], steepness;
    };

    bool window(int i, std::int64_t stretches, Window& w) const {
        const Lane& lane = lanes[i];
        const int hop = motions.stride();
        const double* a = motions.data + static_cast<std::int64_t>(idx[i]);
        double least = 1e300, most = -1e300, least_weight = 1.0, most_weight = 1.0;
        if (D == 1) {
            if (Z) {
                const double z = lane.az * (a[1] + (a[hop + 1] - a[1]) * tau[i]);
                least_weight = most_weight = 1.0 + z;
            }
            least = most = lane.ax * (a[0] + (a[hop] - a[0]) * tau[i]);
            for (std::int64_t k = 1; k <= stretches; ++k) {
                const double x = lane.ax * a[k * hop];
                least = std::min(least, x);
                most = std::max(most, x);
                if (Z) {
                    const double z = 1.0 + lane.az * a[k * hop + 1];
                    least_weight = std::min(least_weight, z);
                    most_weight = std::max(most_weight, z);
                }
            }
        } else {
            least = most = lane.ax * a[0];
            for (int k = 1; k <= D; ++k) (lane.ax * a[k] < 0.0 ? least : most) += lane.ax * a[k];
        }
        for (int k = 0; k < 2; ++k) {
            const Side& s = lane.sides[k];
            const double sign = k == 0 ? 1.0 : -1.0, x = sign * least, y = sign * most;
            w.low[k] = least_weight * s.sine + std::min(x, y) * s.cosine;
            w.high[k] = most_weight * s.sine + std::max(x, y) * s.cosine;
        }
        w.steepness = std::fabs(most_weight) + std::max(std::fabs(least), std::fabs(most));
        return w.low[0] > 0.0 && w.low[1] > 0.0;
    }

    // After an impact with a small speed: do the impacts to come add up to rest before the body could rise again? Their
    // flights are bounded by those under the least and the largest moment of the time they take, so that `true` is
    // proven and nothing is lost by not resolving them one by one.
    bool comes_to_rest(int i, double after) const {
        const Lane& lane = lanes[i];
        const Side& s = here(i);
        const double unit = s.p * s.alpha;
        if (!(after <= set.rest * unit)) return false;
        double d[D + 1];
        holding(i, lane.side, static_cast<std::int64_t>(idx[i]), d);
        const double held = value_of<D>(d, tau[i]);
        if (!(held > 0.0)) return false;
        if (after <= 1e-9 * unit) return true;  // what is left is below all digits that count
        const double left = 1.0 - tau[i];
        // no bound can be shorter than flights that all lasted as long as the first one under the moment of now
        const Side& o = lane.sides[lane.side > 0 ? 1 : 0];
        const double shortest = 2.0 * after / (s.p * s.p * held * lane.step);
        if (shortest > std::max(left, 40.0) * (1.0 - s.r * o.r * law.largest * law.largest)) return false;
        Window w;
        if (!window(i, 1, w)) return false;
        const double first = time_to_rest(i, after, w) / lane.step;
        if (first <= left) return true;
        const std::int64_t stretches = static_cast<std::int64_t>(1.5 * first - left) + 2;
        if (D > 1 || !(first < 40.0) || idx[i] + stretches * motions.stride() > last[i]) return false;
        if (!window(i, stretches, w)) return false;
        return time_to_rest(i, after, w) / lane.step <= left + static_cast<double>(stretches - 1);
    }

    // Longest time that the flights to come can take in all under the moments of a window; infinite if unknown.
    double time_to_rest(int i, double after, Window w) const {
        const Lane& lane = lanes[i];
        const int k = lane.side > 0 ? 0 : 1, o = 1 - k;
        const Side &s = lane.sides[k], &t = lane.sides[o];
        const double r_here = law.kind == LawKind::constant ? s.r : s.r * law.largest;
        const double r_there = law.kind == LawKind::constant ? t.r : t.r * law.largest;
        const double never = std::numeric_limits<double>::infinity();
        double speed = after;
        for (int side : {k, o}) {  // a higher flight meets a moment that differs by its steepness times the height
            const double p2 = lane.sides[side].p * lane.sides[side].p, height = speed * speed / (p2 * w.low[side]);
            const double change = height * w.steepness;
            if (!(change < 0.5 * w.low[side])) return never;
            w.low[side] -= change;
            w.high[side] += change;
            speed *= r_there * std::sqrt(w.high[side] / w.low[side]);
        }
        const double gain_here = std::sqrt(w.high[k] / w.low[k]), gain_there = std::sqrt(w.high[o] / w.low[o]);
        const double ratio = r_here * r_there * gain_here * gain_there;
        if (!(ratio < 1.0)) return never;
        return 2.0 * after * (1.0 / (s.p * s.p * w.low[k]) + r_there * gain_here / (t.p * t.p * w.low[o])) / (1.0 - ratio);
    }

    // At rest: find where the ground next lifts the body, skipping blocks in which it cannot.
    void rest(int i) {
        Lane& lane = lanes[i];
        const int stride_ = motions.stride();
        std::int64_t at = static_cast<std::int64_t>(idx[i]);
        const std::int64_t stop = static_cast<std::int64_t>(last[i]);
        double from = tau[i];
        while (at < stop) {
            const std::int64_t k = (at - static_cast<std::int64_t>(lane.first)) / stride_;
            if (!may_lift(i, motions.bounds[lane.shake->block + k / kBlock])) {
                at = static_cast<std::int64_t>(lane.first) + (k / kBlock + 1) * kBlock * stride_;
                from = 0.0;
                continue;
            }
            const double right = release(i, 1, at, from), left = release(i, -1, at, from);
            int side = right < left ? 1 : left < right ? -1 : 0;
            if (side == 0 && right <= 1.0) side = preferred(i, at, right);
            if (side) return lift(i, at, side, side > 0 ? right : left);
            at += stride_;
            from = 0.0;
        }
        idx[i] = last[i];
        tau[i] = 0.0;
        finish(i, lane.uplifts || lane.impacts ? kRocked : kNoUplift, kGood);
    }

    bool may_lift(int i, const Bounds& b) const {
        const Lane& lane = lanes[i];
        const double weight = 1.0 + (Z ? std::min({0.0, lane.az * b.vertical_low, lane.az * -b.vertical_low}) : 0.0);
        const double push = std::max(lane.ax * b.low, lane.ax * b.high), pull = std::max(-lane.ax * b.low, -lane.ax * b.high);
        const Side &r = lane.sides[0], &l = lane.sides[1];
        return pull * r.cosine >= weight * r.sine * (1.0 - 1e-12) || push * l.cosine >= weight * l.sine * (1.0 - 1e-12);
    }

    // Both sides let go at once, which takes a ground that falls faster than gravity: against the ground's push.
    int preferred(int i, std::int64_t at, double from) const {
        const double* a = motions.data + at;
        constexpr int hop = Z ? 2 : 1;
        const double push = lanes[i].ax * (D == 1 ? a[0] + (a[hop] - a[0]) * from : value_of<D>(a, from));
        return push > 0.0 ? -1 : push < 0.0 ? 1 : 0;
    }

    void lift(int i, std::int64_t at, int side, double when) {
        Lane& lane = lanes[i];
        idx[i] = static_cast<double>(at);
        lane.side = side;
        stand(i);
        u[i] = alpha[i];
        v[i] = 0.0;
        move(i, when);
        if (idx[i] >= last[i]) return finish(i, lane.uplifts || lane.impacts ? kRocked : kNoUplift, kGood);
        if (!lane.uplifts) lane.first_uplift = now(i, 0.0);
        ++lane.uplifts;
        note(i, kUplift, now(i, 0.0), 0.0, 0.0, 0.0);
    }

    // The motion is over: energy decides. e = u'^2 / (2 p^2) + cos u - cos alpha against 1 - cos alpha at the top.
    void conclude(int i) {
        Lane& lane = lanes[i];
        raise_peak(i, alpha[i] - u[i], now(i, 0.0));
        const double speed = v[i] / lane.step;
        const double e = energy(here(i), u[i], speed);
        const bool inward = speed > 0.0, passes = e > energy(here(i), 0.0, 0.0);
        if (u[i] < 0.0 && !(inward && passes)) return falls(i, lane.over_time >= 0.0 ? lane.over_time : now(i, 0.0));
        if (!inward && passes) return falls(i, now(i, 0.0));
        if (!inward) raise_peak(i, height(here(i), e), now(i, 0.0));
        double arrival = here(i).p * std::sqrt(2.0 * std::max(e, 0.0));
        for (int flight = 0; flight < 2; ++flight) {  // each later visit to a side has less energy than the one before
            lane.side = -lane.side;
            arrival *= coefficient(i, arrival);
            ++lane.impacts;
            const double f = 0.5 * arrival * arrival / (here(i).p * here(i).p);
            if (f > energy(here(i), 0.0, 0.0)) return falls(i, now(i, 0.0));
            raise_peak(i, height(here(i), f), now(i, 0.0));
        }
        lane.impacts -= 2;  // those to come are not counted unless they end in overturning
        finish(i, kRocked, kGood);
    }

    void falls(int i, double when) {
        lanes[i].over_time = when;
        finish(i, kOverturned, kGood);
    }

    // Energy over m g R above rest; 1 - cos x written as 2 sin^2(x / 2) keeps its digits.
    static double energy(const Side& s, double u_, double speed) {
        const double kinetic = 0.5 * speed * speed / (s.p * s.p);
        if (L) return kinetic + 0.5 * (s.alpha * s.alpha - u_ * u_);
        double a, b, c;
        sine_cosine(0.5 * (s.alpha + u_), a, c);
        sine_cosine(0.5 * (s.alpha - u_), b, c);
        return kinetic + 2.0 * a * b;
    }

    // Rotation |theta| at which a body of energy e turns round.
    static double height(const Side& s, double e) {
        if (L) return s.alpha - std::sqrt(std::max(0.0, s.alpha * s.alpha - 2.0 * e));
        const double half = std::sin(0.5 * s.alpha);
        return s.alpha - 2.0 * std::asin(std::sqrt(std::max(0.0, half * half - 0.5 * e)));
    }

    // ---- lanes and the queue ----------------------------------------------------------------------------------------

    void finish(int i, Outcome outcome, Status status) {
        Lane& lane = lanes[i];
        const std::int64_t row = lane.row;
        const double nan = std::numeric_limits<double>::quiet_NaN();
        const bool good = status == kGood, down = outcome == kOverturned;
        rows.outcome[row] = outcome;
        rows.status[row] = status;
        rows.side[row] = outcome == kOverturned ? static_cast<std::int8_t>(lane.side) : 0;
        rows.peak[row] = down ? lane.side * kHalfPi : good ? lane.peak_signed : nan;  // it lies at a quarter turn
        rows.peak_time[row] = down ? lane.over_time : good ? lane.peak_time : nan;
        rows.peak_velocity[row] = good ? fastest[i] / lane.step : nan;
        rows.overturning_time[row] = outcome == kOverturned ? lane.over_time : nan;
        rows.first_uplift[row] = lane.first_uplift;
        rows.error[row] = good ? err[i] : nan;
        rows.impacts[row] = lane.impacts;
        rows.uplifts[row] = lane.uplifts;
        --active;
        idle(i);
    }

    void idle(int i) {
        lanes[i].row = -1;
        u[i] = 0.0;
        v[i] = tau[i] = kappa[i] = ca[i] = cz[i] = idx[i] = stride[i] = err[i] = fastest[i] = gate[i] = 0.0;
        len[i] = sub[i] = alpha[i] = peak[i] = 1.0;
        last[i] = std::numeric_limits<double>::infinity();
    }

    static bool valid(const Rows& r, std::int64_t k, std::size_t motions) {
        for (const double* angle : {r.alpha_right, r.alpha_left})
            if (!(angle[k] > 0.0 && angle[k] < kHalfPi)) return false;
        for (const double* p : {r.p_right, r.p_left})
            if (!(p[k] > 1e-9 && p[k] < 1e9)) return false;
        for (const double* e : {r.r_right, r.r_left})
            if (!(e[k] >= 0.0 && e[k] <= 100.0)) return false;
        return std::fabs(r.scale[k]) <= 1e9 && std::fabs(r.rotation[k]) < kHalfPi && std::fabs(r.velocity[k]) < 1e9 &&
               r.motion[k] >= 0 && r.motion[k] < static_cast<std::int64_t>(motions);
    }

    // Take rows from the queue until one needs steps.
    void fill(int i) {
        idle(i);
        while (next < end && lanes[i].row < 0) {
            const std::int64_t row = next++;
            if (valid(rows, row, motions.shakes.size())) start(i, row);
            else write_invalid(row);
        }
    }

    void write_invalid(std::int64_t row) {
        const double nan = std::numeric_limits<double>::quiet_NaN();
        rows.outcome[row] = kFailed;
        rows.status[row] = kInvalid;
        rows.side[row] = 0;
        rows.peak[row] = rows.peak_time[row] = rows.peak_velocity[row] = nan;
        rows.overturning_time[row] = rows.first_uplift[row] = rows.error[row] = nan;
        rows.impacts[row] = rows.uplifts[row] = 0;
    }

    void start(int i, std::int64_t row) {
        Lane& lane = lanes[i];
        ++active;
        lane = Lane();
        lane.row = row;
        lane.peak_signed = lane.peak_time = 0.0;
        lane.over_time = lane.first_uplift = std::numeric_limits<double>::quiet_NaN();
        const Shake& shake = motions.shakes[rows.motion[row]];
        lane.shake = &shake;
        lane.sides[0] = side_of(rows.alpha_right[row], rows.p_right[row], rows.r_right[row]);
        lane.sides[1] = side_of(rows.alpha_left[row], rows.p_left[row], rows.r_left[row]);
        lane.step = shake.step;
        lane.ax = lane.az = rows.scale[row] / set.gravity;
        lane.first = static_cast<double>(shake.first);
        idx[i] = lane.first;
        stride[i] = motions.stride();
        last[i] = lane.first + static_cast<double>(shake.segments) * motions.stride();
        cz[i] = lane.az;
        const double reach = std::max(rows.p_right[row], rows.p_left[row]) * shake.step;
        sub[i] = 1.0 / std::max(1.0, std::ceil(reach / set.longest_step));
        tau[i] = 0.0;
        len[i] = sub[i];
        const double angle = rows.rotation[row], speed = rows.velocity[row];
        if (angle == 0.0 && speed == 0.0) {
            peak[i] = 0.0;
            return rest(i);
        }
        lane.side = angle > 0.0 || (angle == 0.0 && speed > 0.0) ? 1 : -1;
        stand(i);
        u[i] = alpha[i] - std::fabs(angle);
        v[i] = -lane.side * speed * lane.step;
        peak[i] = 0.0;
        raise_peak(i, std::fabs(angle), 0.0);
        if (u[i] < 0.0) lane.over_time = 0.0;
        lane.uplifts = 1;
        lane.first_uplift = 0.0;
        note(i, kUplift, 0.0, 0.0, 0.0, 0.0);
    }
};

template <int U, int N, int D, bool Z, bool L>
Work run_rows(const Motions& m, const Law& law, const Rows& r, const Settings& s, Trace* t, std::int64_t from, std::int64_t to) {
    Kernel<U, N, D, Z, L> kernel(m, law, r, s, t);
    kernel.run(from, to);
    return kernel.work;
}

}  // namespace ROCKING_ISA
}  // namespace rocking
