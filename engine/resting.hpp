// At rest: when the ground lifts the body, and when impacts that die out have brought it there.
#pragma once
#include "kernel.hpp"

namespace rocking {
namespace ROCKING_ISA {

// Moment that holds the body down on a side, over m g R: D = (1 + a_z / g) sin alpha + s (a_x / g) cos alpha,
// as a polynomial of the time within a stretch.
ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::holding(int i, int side, std::int64_t at, double* d) const {
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

// The same at a sample.
ROCKING_KERNEL
double Kernel<G, U, N, D, Z, L>::held_at(int i, int side, std::int64_t at) const {
    const Lane& lane = lanes[i];
    const Side& s = lane.sides[side > 0 ? 0 : 1];
    const double weight = Z ? 1.0 + lane.az * motions.data[at + 1] : 1.0;
    return weight * s.sine + side * lane.ax * motions.data[at] * s.cosine;
}

// First instant of the stretch, from `from` on, at which a side is no longer held down; 2 if it is throughout.
ROCKING_KERNEL
double Kernel<G, U, N, D, Z, L>::release(int i, int side, std::int64_t at, double from) const {
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

ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::extremes(const double* a, std::int64_t count, double& least, double& most) {
    std::int64_t k = 0;
    if (count >= P) {
        Pack low = Pack::unaligned(a), high = low;
        for (k = P; k + P <= count; k += P) {
            const Pack x = Pack::unaligned(a + k);
            low = min(low, x);
            high = max(high, x);
        }
        const Pack x = Pack::unaligned(a + count - P);
        alignas(64) double lows[P], highs[P];
        min(low, x).store(lows);
        max(high, x).store(highs);
        for (int m = 0; m < P; ++m) {
            least = std::min(least, lows[m]);
            most = std::max(most, highs[m]);
        }
        return;
    }
    for (; k < count; ++k) {
        least = std::min(least, a[k]);
        most = std::max(most, a[k]);
    }
}

ROCKING_KERNEL
bool Kernel<G, U, N, D, Z, L>::window(int i, std::int64_t stretches, Window& w) const {
    const Lane& lane = lanes[i];
    const int hop = motions.stride();
    const double* a = motions.data + static_cast<std::int64_t>(idx[i]);
    double least = 1e300, most = -1e300, least_weight = 1.0, most_weight = 1.0;
    if (D == 1) {
        if (Z) {
            const double z = lane.az * (a[1] + (a[hop + 1] - a[1]) * tau[i]);
            least_weight = most_weight = 1.0 + z;
        }
        const double first = a[0] + (a[hop] - a[0]) * tau[i];
        least = most = first;
        if (Z) {
            for (std::int64_t k = 1; k <= stretches; ++k) {
                least = std::min(least, a[k * hop]);
                most = std::max(most, a[k * hop]);
                const double z = 1.0 + lane.az * a[k * hop + 1];
                least_weight = std::min(least_weight, z);
                most_weight = std::max(most_weight, z);
            }
        } else {
            extremes(a + 1, stretches, least, most);
        }
        least *= lane.ax;
        most *= lane.ax;
        if (least > most) std::swap(least, most);
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
ROCKING_KERNEL
bool Kernel<G, U, N, D, Z, L>::comes_to_rest(int i, double after) const {  // [rad per stretch]
    const Lane& lane = lanes[i];
    const Side& s = here(i);
    const double unit = s.p * s.alpha;
    if (!(after <= std::max(set.rest, kNothing) * unit * lane.step)) return false;
    const Side& o = lane.sides[lane.side > 0 ? 1 : 0];
    const std::int64_t at = static_cast<std::int64_t>(idx[i]);
    double d[D + 1];
    holding(i, lane.side, at, d);
    const double held = value_of<D>(d, tau[i]);
    if (!(held > 0.0)) return false;
    after /= lane.step;
    if (after <= kNothing * unit) return true;  // what is left is below all digits that count
    if (!(after <= set.rest * unit)) return false;
    holding(i, -lane.side, at, d);
    // the flights under the moments of now, as a guess of the time they take
    const double across = value_of<D>(d, tau[i]), here_ = s.p * s.p * held, there = o.p * o.p * across;
    const double flights = 2.0 * after * (there + largest(o) * here_);
    const double steps = here_ * there * (1.0 - largest(s) * largest(o)) * lane.step;
    if (!(across > 0.0 && flights < 40.0 * steps)) return false;
    const double left = 1.0 - tau[i], guess = 1.5 * (flights / steps);
    std::int64_t stretches = 1;
    if (D == 1 && guess > left) {
        const std::int64_t rest_of_it = static_cast<std::int64_t>(last[i] - idx[i]) / motions.stride();
        stretches = std::min(static_cast<std::int64_t>(guess - left) + 2, rest_of_it);
    }
    if (D == 1) {  // most fail already by the moments of now and of the window's end: no need to look in between
        const std::int64_t end = at + stretches * motions.stride();
        const double held_ = held_at(i, lane.side, end), across_ = held_at(i, -lane.side, end);
        const double rr = largest(s) * largest(o);
        const double low = std::min(held, held_) * std::min(across, across_), high = std::max(held, held_) * std::max(across, across_);
        if (rr * rr * high > (1.0 + 1e-8) * low) return false;
    }
    Window w;
    return window(i, stretches, w) &&
           time_to_rest(i, after, w) <= (left + static_cast<double>(stretches - 1)) * lane.step;
}

// Longest time that the flights to come can take in all under the moments of a window; infinite if unknown.
ROCKING_KERNEL
double Kernel<G, U, N, D, Z, L>::time_to_rest(int i, double after, Window w) const {
    const Lane& lane = lanes[i];
    const int k = lane.side > 0 ? 0 : 1, o = 1 - k;
    const Side &s = lane.sides[k], &t = lane.sides[o];
    const double r_here = largest(s), r_there = largest(t);
    const double never = std::numeric_limits<double>::infinity();
    // the ratio below cannot be less than this one: no square roots for those that fail anyway
    const double spread = r_here * r_here * r_there * r_there * w.high[k] * w.high[o];
    if (spread > (1.0 + 1e-9) * (w.low[k] * w.low[o])) return never;
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
ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::rest(int i) {
    Lane& lane = lanes[i];
    const int stride_ = motions.stride();
    std::int64_t at = static_cast<std::int64_t>(idx[i]);
    const std::int64_t stop = static_cast<std::int64_t>(last[i]);
    double from = tau[i];
    const Bounds& now_ = bounds_at(i);
    const Bounds later{now_.later_low, now_.later_high, now_.later_vertical_low, now_.later_vertical_high, 0, 0, 0, 0};
    if (!may_lift(i, later)) at = stop;
    const double calm = (1.0 - 1e-12) * std::min(lane.sides[0].sine / lane.sides[0].cosine, lane.sides[1].sine / lane.sides[1].cosine);
    while (at < stop) {
        const std::int64_t k = (at - static_cast<std::int64_t>(lane.first)) / stride_;
        if (!may_lift(i, motions.bounds[lane.shake->block + k / kBlock])) {
            at = static_cast<std::int64_t>(lane.first) + (k / kBlock + 1) * kBlock * stride_;
            from = 0.0;
            continue;
        }
        if (D == 1 && !Z && std::fabs(lane.ax * motions.data[at]) < calm && std::fabs(lane.ax * motions.data[at + 1]) < calm) {
            ++at;
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

ROCKING_KERNEL
bool Kernel<G, U, N, D, Z, L>::may_lift(int i, const Bounds& b) const {
    const Lane& lane = lanes[i];
    const double weight = 1.0 + (Z ? std::min({0.0, lane.az * b.vertical_low, lane.az * b.vertical_high}) : 0.0);
    const double push = std::max(lane.ax * b.low, lane.ax * b.high), pull = std::max(-lane.ax * b.low, -lane.ax * b.high);
    const Side &r = lane.sides[0], &l = lane.sides[1];
    return pull * r.cosine >= weight * r.sine * (1.0 - 1e-12) || push * l.cosine >= weight * l.sine * (1.0 - 1e-12);
}

// Both sides let go at once, which takes a ground that falls faster than gravity: against the ground's push.
ROCKING_KERNEL
int Kernel<G, U, N, D, Z, L>::preferred(int i, std::int64_t at, double from) const {
    const double* a = motions.data + at;
    constexpr int hop = Z ? 2 : 1;
    const double push = lanes[i].ax * (D == 1 ? a[0] + (a[hop] - a[0]) * from : value_of<D>(a, from));
    return push > 0.0 ? -1 : push < 0.0 ? 1 : 0;
}

ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::lift(int i, std::int64_t at, int side, double when) {
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

}  // namespace ROCKING_ISA
}  // namespace rocking
