// A body at rest: the time at which the ground causes uplift, and the proof that decaying impacts end in rest.
#pragma once
#include "kernel.hpp"

namespace rocking {
namespace ROCKING_ISA {

// Restoring moment of a side / (m g R): D = (1 + a_z / g) sin alpha + s (a_x / g) cos alpha,
// as a polynomial of the time within a segment.
ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::holding(int i, int side, std::int64_t at, double* d) const {
    const Lane& lane = lanes[i];
    const Side& s = lane.sides[side > 0 ? 0 : 1];
    const double* a = motions.data + at;
    if (D == 1) {
        constexpr int hop = Z ? 2 : 1;
        d[0] = s.sine + side * lane.ax * a[0] * s.cosine;  // Eq. 24
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

// First instant after `from` in the segment at which the restoring moment of a side is not positive; 2 if there is
// none.
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

// Restoring moments over the next segments: smallest moments of both sides, total variation of the moments over the
// smallest values, and derivative of the moments with respect to the rotation.
ROCKING_KERNEL
bool Kernel<G, U, N, D, Z, L>::window(int i, std::int64_t stretches, double most_varies, Window& w) const {
    const Lane& lane = lanes[i];
    constexpr int hop = stride;
    const double* a = motions.data + idx[i];
    double least, most, varies = 0.0, least_weight = 1.0, most_weight = 1.0, weight_varies = 0.0;
    if (D == 1) {
        double last_a = least = most = a[0] + (a[hop] - a[0]) * tau[i];
        double last_z = Z ? 1.0 + lane.az * (a[1] + (a[hop + 1] - a[1]) * tau[i]) : 1.0;
        least_weight = most_weight = last_z;
        for (std::int64_t k = 1; k <= stretches; ++k) {
            const double x = a[k * hop];
            least = std::min(least, x);
            most = std::max(most, x);
            varies += std::fabs(x - last_a);
            last_a = x;
            if (varies > most_varies) return false;
            if (Z) {
                const double z = 1.0 + lane.az * a[k * hop + 1];
                least_weight = std::min(least_weight, z);
                most_weight = std::max(most_weight, z);
                weight_varies += std::fabs(z - last_z);
                last_z = z;
            }
        }
    } else {
        least = 1e300, most = -1e300;
        double end = a[0];
        for (std::int64_t k = 0; k < stretches; ++k, a += hop) {
            double low = a[0], high = a[0];
            varies += std::fabs(a[0] - end);
            end = a[0];
            for (int m = 1; m <= D; ++m) {
                (a[m] < 0.0 ? low : high) += a[m];
                varies += std::fabs(a[m]);
                end += a[m];
            }
            least = std::min(least, low);
            most = std::max(most, high);
        }
    }
    least *= lane.ax;
    most *= lane.ax;
    varies *= std::fabs(lane.ax);
    if (least > most) std::swap(least, most);
    w.low[0] = least_weight * lane.sides[0].sine + least * lane.sides[0].cosine;
    w.low[1] = least_weight * lane.sides[1].sine - most * lane.sides[1].cosine;
    if (!(w.low[0] > 0.0 && w.low[1] > 0.0)) return false;
    w.variation = varies * std::max(lane.sides[0].cosine / w.low[0], lane.sides[1].cosine / w.low[1]);  // Eq. 38
    if (Z) w.variation += weight_varies * std::max(lane.sides[0].sine / w.low[0], lane.sides[1].sine / w.low[1]);
    w.steepness = std::max(std::fabs(least_weight), std::fabs(most_weight)) + std::max(std::fabs(least), std::fabs(most));  // Eq. 39
    return true;
}

// After an impact with a small speed: true if the next impacts provably decay to rest before the body can rise again
// (docs/theory/rest.md). Then these impacts need not be computed.
ROCKING_KERNEL
bool Kernel<G, U, N, D, Z, L>::comes_to_rest(int i, double after) const {  // [rad per stretch]
    const Lane& lane = lanes[i];
    const Side &s = here(i), &o = lane.sides[lane.side > 0 ? 1 : 0];
    const double unit = s.p * s.alpha * lane.step;
    const std::int64_t at = idx[i];
    double d[D + 1];
    holding(i, lane.side, at, d);
    const double held = value_of<D>(d, tau[i]);
    if (!(held > 0.0)) return false;
    if (after <= kNothing * unit) return true;  // the remainder is below all significant digits
    if (!(after <= set.rest * unit)) return false;
    holding(i, -lane.side, at, d);
    const double across = value_of<D>(d, tau[i]), r = largest(i, lane.side < 0), q = largest(i, lane.side > 0), lost = 1.0 - r * q;
    const double p2 = s.p * s.p * lane.step * lane.step, other = o.p * o.p * lane.step * lane.step;
    // duration of the flights with the present moments, as an estimate
    const double flights = 2.0 * after * (other * across + q * p2 * held), rate = p2 * held * (other * across) * lost;  // Eq. 37
    if (!(across > 0.0 && flights < kLongest * rate)) return false;
    const double left = 1.0 - tau[i], guess = 1.5 * (flights / rate);
    const std::int64_t rest_of_it = (last[i] - idx[i]) / stride;
    const std::int64_t stretches = guess > left ? std::min(static_cast<std::int64_t>(guess - left) + 2, rest_of_it) : 1;
    const double end = left + static_cast<double>(stretches - 1);
    // The total duration increases with x = (variation + kHeights) / 2, and all >= flights / rate (1 + x + x^2). Hence
    // (2 x + 1)^2 <= spare / flights, and x <= spare / flights / 8, since the root is below its tangent. With a larger
    // variation of the ground the proof fails, so the remaining window is not examined.
    const double spare = 4.0 * (end * rate) - 3.0 * flights, least = 0.999999 * (1.0 + kHeights) * (1.0 + kHeights);
    if (!(spare > least * flights)) return false;
    const double most_varies = 1.000001 * std::min((0.25 * spare - kHeights * flights) * held * across, 2.0 * flights * held * across) /
                               (std::fabs(lane.ax) * flights * std::max(s.cosine * across, o.cosine * held));
    Window w;
    if (!window(i, stretches, most_varies, w)) return false;
    const int k = lane.side > 0 ? 0 : 1;
    const double low = w.low[k], low_ = w.low[1 - k], x = 0.5 * (w.variation + kHeights);
    if (!(x <= 1.0)) return false;
    const double gain = 1.0 + x + x * x;  // upper bound of exp(x)
    const double heights = w.steepness * (after * after) * (gain * gain) / std::min(p2 * low * low, other * low_ * low_);  // Eq. 40
    if (!(2.2 * heights * (1.0 + q * q) <= kHeights * (1.0 - r * r * q * q) && heights <= 0.3)) return false;
    const double all = 2.0 * after * gain * (1.0 / (p2 * low) + q / (other * low_)) / (lost * (1.0 - heights));  // Eq. 16
    return all <= end;
}

// First sample from `at` to before `end` that is not calm; `end` if all samples are calm.
ROCKING_KERNEL
std::int64_t Kernel<G, U, N, D, Z, L>::first_loud(std::int64_t at, std::int64_t end, double scale, double calm) const {
    for (; at + P <= end; at += P) {
        const Mask quiet = abs(Pack::load_any(motions.data + at) * Pack(scale)) < Pack(calm);
        if (const unsigned bits = (!quiet).bits() & ((1u << P) - 1)) return at + lowest(bits);
    }
    while (at < end && std::fabs(scale * motions.data[at]) < calm) ++at;
    return at;
}

// First position from `at` on in a block in which uplift is possible: `at`, the start of a later block, or a
// position that is not before `stop`.
ROCKING_KERNEL
std::int64_t Kernel<G, U, N, D, Z, L>::first_block(const Lane& lane, std::int64_t at, std::int64_t stop) const {
    const std::int64_t first = lane.first, length = kBlock * stride;
    for (std::int64_t k = (at - first) / length; at < stop; at = first + ++k * length) {
        const std::int64_t block = lane.block + k;
        if (may_lift(lane, motions.horizontal.within[block], up(motions.vertical.within, block))) break;
    }
    return at;
}

// At rest: finds the next uplift, and skips blocks without uplift.
ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::rest(int i) {
    const std::int64_t now_ = block_at(i);
    const bool ever = may_lift(lanes[i], motions.horizontal.later[now_], up(motions.vertical.later, now_));
    await(i, ever ? idx[i] : last[i]);
}

// Continues the search for uplift from a sample; the body is at rest until there.
ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::await(int i, std::int64_t at) {
    const Lane& lane = lanes[i];
    const std::int64_t stop = last[i];
    double from = tau[i];
    const double calm = (1.0 - 1e-12) * std::min(lane.sides[0].sine / lane.sides[0].cosine, lane.sides[1].sine / lane.sides[1].cosine);
    while (at < stop) {
        const std::int64_t block = first_block(lane, at, stop);
        if (block > at) {
            at = block;
            from = 0.0;
            continue;
        }
        const std::int64_t k = (at - lane.first) / stride;
        if (D == 1 && !Z) {  // skips blocks of samples that cannot cause uplift of the body
            const std::int64_t block_end = lane.first + (k / kBlock + 1) * kBlock;
            const std::int64_t heard = first_loud(at, std::min(stop, block_end) + 1, std::fabs(lane.ax), calm);
            if (heard > at + 1) {
                at = heard - 1;
                from = 0.0;
                continue;
            }
        }
        const double right = release(i, 1, at, from), left = release(i, -1, at, from);
        int side = right < left ? 1 : left < right ? -1 : 0;
        if (side == 0 && right <= 1.0) side = preferred(i, at, right);
        // without a horizontal push the body stays in place, although the contact force is tensile
        if (Z && side == 0 && right <= 1.0) {
            least[i] = std::min({least[i], 1.0 + lane.az * motions.data[at + 1], 1.0 + lane.az * motions.data[at + stride + 1]});
            demand[i] = std::numeric_limits<double>::infinity();
        }
        if (side) return lift(i, at, side, side > 0 ? right : left);
        at += stride;
        from = 0.0;
    }
    idx[i] = last[i];
    tau[i] = 0.0;
    finish(i, lane.uplifts || lane.impacts ? kRocked : kNoUplift, kGood);
}

ROCKING_KERNEL
bool Kernel<G, U, N, D, Z, L>::may_lift(const Lane& lane, Range across, Range up) const {
    const double weight = 1.0 + (Z ? std::min({0.0, lane.az * up.low, lane.az * up.high}) : 0.0);
    const double push = std::max(lane.ax * across.low, lane.ax * across.high), pull = std::max(-lane.ax * across.low, -lane.ax * across.high);
    const Side &r = lane.sides[0], &l = lane.sides[1];
    return pull * r.cosine >= weight * r.sine * (1.0 - 1e-12) || push * l.cosine >= weight * l.sine * (1.0 - 1e-12);
}

// Both sides uplift at once if the ground falls faster than gravity. The body rotates against the push of the ground.
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
    idx[i] = at;
    lane.side = side;
    stand(i);
    u[i] = alpha[i];
    v[i] = 0.0;
    move(i, when);
    for (int k = 8; k <= 32; k += 8) ROCKING_PREFETCH(motions.data + at + k);  // used later in step()
    if (idx[i] >= last[i]) return finish(i, lane.uplifts || lane.impacts ? kRocked : kNoUplift, kGood);
    if (!lane.uplifts) lane.first_uplift = now(i, 0.0);
    ++lane.uplifts;
    note(i, kUplift, now(i, 0.0), 0.0, 0.0, 0.0);
}

}  // namespace ROCKING_ISA
}  // namespace rocking
