// One Taylor step of all lanes.
#pragma once
#include "kernel.hpp"

namespace rocking {
namespace ROCKING_ISA {

// One Taylor step of every lane, then visits to those that need one. Those that may touch the ground go side by side.
ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::sweep() {
    int landing[W + 2 * P], other[W], landings = 0, others = 0;
    ++work.sweeps;
    for (int g = 0; g < G; ++g) {
        if (!busy[g]) continue;
        work.steps += busy[g];
        // every lane reads a motion of its own, more streams than processors foresee: lines ahead, every eighth turn
        for (int i = g * U * P + static_cast<int>(work.sweeps % 8); i < (g + 1) * U * P; i += 8)
            __builtin_prefetch(motions.data + static_cast<std::int64_t>(idx[i]) + 24);
        unsigned long flagged, near;
        step(g, flagged, near);
        for (unsigned long left = near; left; left &= left - 1) landing[landings++] = g * U * P + lowest(left);
        for (unsigned long left = flagged & ~near; left; left &= left - 1) other[others++] = g * U * P + lowest(left);
    }
    work.events += landings + others;
    int at = 0;
    for (; landings - at > P; at += 2 * P) land<2>(landing + at, std::min(landings - at, 2 * P));
    if (landings > at) land<1>(landing + at, landings - at);
    for (int k = 0; k < others; ++k) visit(other[k], false);
    for (int k = 0; k < landings; ++k)
        if (lanes[landing[k]].row < 0) fill(landing[k]);
    for (int k = 0; k < others; ++k)
        if (lanes[other[k]].row < 0) fill(other[k]);
}

// One Taylor step of a group; lanes that need a visit keep their state until they have had it.
ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::step(int group, unsigned long& flagged, unsigned long& near) {
    const int base = group * U * P;
    Pack u0[U], v0[U], t0[U], h[U], i0[U], b[D + 1][U], z[2][U], S[N + 1][U], C[N + 1][U], V[N + 1][U], q[U], w[U];
    ROCKING_LANES {
        u0[j] = Pack::load(u + base + j * P);
        v0[j] = Pack::load(v + base + j * P);
        t0[j] = Pack::load(tau + base + j * P);
        h[j] = Pack::load(len + base + j * P);
        i0[j] = Pack::load(idx + base + j * P);
        w[j] = Pack(0.0);
        q[j] = Pack::load(kappa + base + j * P) * h[j];
        V[0][j] = v0[j] * h[j];
    }
    forcing(base, i0, t0, h, b, z);
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
            f = f * inverse;
            w[j] = w[j] + f;
            V[k + 1][j] = f * (q[j] * h[j]);
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
    flagged = near = 0;
    ROCKING_LANES {
        const int at = base + j * P;
        const Pack zero(0.0);
        Pack du = V[N][j] * Pack(1.0 / (N + 1)), sag = max(zero - V[1][j], zero) * Pack(0.125);
        Pack sway = fma(Pack(0.25), abs(V[2][j]), Pack(0.4) * abs(V[3][j]));
        ROCKING_UNROLL
        for (int k = N - 1; k >= 0; --k) du = fma(V[k][j], Pack(1.0 / (k + 1)), du);
        ROCKING_UNROLL
        for (int k = 2; k <= N; ++k) sag = fma(max(zero - V[k][j], zero), Pack(1.0 / (k + 1)), sag);
        ROCKING_UNROLL
        for (int k = 4; k <= N; ++k) sway = sway + abs(V[k][j]);
        const Pack u1 = u0[j] + du, v1 = fma(q[j], w[j], v0[j]);

        // With y = y0 + c1 x + c2 x^2 + ..., y >= min(y0, y1) - c2+ / 4 - c3+ - ...: between its ends a step can
        // only sag by its convex terms. A step that starts at y = 0 is divided by its known zero first.
        const Pack y0 = Pack::load(alpha + at) - u0[j], y1 = y0 - du;
        const Mask clear = (min(y0, y1) > sag) | ((y0 == zero) & (min(zero - V[0][j], y1) > sag));
        // The velocity leaves the straight line between its ends by less than its sway.
        const Mask turns = ((v0[j] < zero) & (v1 >= zero)) | (sway >= min(abs(V[0][j]), abs(v1 * h[j])));
        const Mask turning = turns & (fma(Pack(4.0), sag, y0 + max(zero - V[0][j], zero)) > Pack::load(peak + at));
        const Mask beyond = (u1 < Pack::load(gate + at)) | ((u1 < zero) & (max(u0[j], u1) + sag >= zero));
        const Pack t1 = t0[j] + h[j];
        const Mask done = t1 >= Pack(kWhole);
        const Pack t2 = select(done, zero, t1), i1 = select(done, i0[j] + Pack::load(stride + at), i0[j]);
        const Mask visit = !clear | beyond | turning | (done & (i1 >= Pack::load(last + at)));
        flagged |= static_cast<unsigned long>(visit.bits()) << (j * P);
        near |= static_cast<unsigned long>((!clear).bits()) << (j * P);

        select(visit, u0[j], u1).store(u + at);
        select(visit, v0[j], v1).store(v + at);
        select(visit, t0[j], t2).store(tau + at);
        select(visit, h[j], min(Pack::load(sub + at), Pack(1.0) - t2)).store(len + at);
        select(visit, i0[j], i1).store(idx + at);
        u1.store(end_u + at);
        v1.store(end_v + at);
        // what happens beyond a quarter turn is of no interest
        (Pack::load(err + at) + select(u1 > Pack(-kHalfPi), abs(V[N][j]), zero)).store(err + at);
        const Pack top = Pack::load(fastest + at);
        select(visit, top, max(top, abs(v1))).store(fastest + at);
        ROCKING_UNROLL
        for (int k = 0; k <= N; ++k) V[k][j].store(&terms[k][at]);
    }
    near &= flagged;
    if (trace && lanes[0].row >= 0 && !(flagged & 1) && tau[0] == 0.0) sample(0);
}

// Series of the ground's acceleration over the step: s a_x / g in b, a_z / g in z.
ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::forcing(int base, const Pack* i0, const Pack* t0, const Pack* h, Pack (*b)[U], Pack (*z)[U]) const {
    const double* data = motions.data;
    ROCKING_LANES {
        const Pack c = Pack::load(ca + base + j * P);
        if (D == 1) {
            constexpr int hop = Z ? 2 : 1;
            const Pack a = Pack::gather(data, i0[j]), da = Pack::gather(data + hop, i0[j]) - a;
            b[0][j] = c * fma(da, t0[j], a);
            b[1][j] = c * (da * h[j]);
            if (Z) {
                const Pack w = Pack::load(cz + base + j * P);
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
                for (int m = D - 1; m >= k; --m) p[m] = fma(t0[j], p[m + 1], p[m]);
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

}  // namespace ROCKING_ISA
}  // namespace rocking
