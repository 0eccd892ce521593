// One Taylor step of all lanes.
#pragma once
#include "kernel.hpp"

namespace rocking {
namespace ROCKING_ISA {

// One Taylor step of every lane, then visits to those that need one. Those that may touch the ground go side by side.
ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::sweep() {
    int landing[W], landings = 0;
    ++work.sweeps;
    for (int g = 0; g < G; ++g) {
        if (!busy[g]) continue;
        work.steps += busy[g];
        unsigned long flagged, near;
        step(g, flagged, near);
        work.events += count_of(flagged);
        for (unsigned long left = near; left; left &= left - 1) {
            const int k = lowest(left), i = g * U * P + k;
            ROCKING_UNROLL
            for (int m = 0; m < N + 3; ++m) queued[m][landings] = fresh[m][k];
            above[landings] = alpha[i] - u[i];
            span[landings] = len[i];
            landing[landings++] = i;
        }
        for (unsigned long left = flagged & ~near; left; left &= left - 1) {
            const int k = lowest(left), i = g * U * P + k;
            visit(i, {&fresh[0][k], U * P}, false);
            if (lanes[i].row < 0) fill(i);
        }
    }
    for (int at = 0; at < landings; at += M * P) land(landing + at, at, std::min(landings - at, M * P));
    for (int k = 0; k < landings; ++k)
        if (lanes[landing[k]].row < 0) fill(landing[k]);
    if (G > 1 && used > 1 && active <= (used - 1) * U * P) close_ranks();
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
    const double hop = motions.stride();
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
        const Pack t2 = select(done, zero, t1), i1 = select(done, i0[j] + Pack(hop), i0[j]);
        const Mask visit = !clear | beyond | turning | (done & (i1 >= Pack::load(last + at)));
        flagged |= static_cast<unsigned long>(visit.bits()) << (j * P);
        near |= static_cast<unsigned long>((!clear).bits()) << (j * P);

        select(visit, u0[j], u1).store(u + at);
        select(visit, v0[j], v1).store(v + at);
        select(visit, t0[j], t2).store(tau + at);
        select(visit, h[j], min(Pack::load(sub + at), Pack(1.0) - t2)).store(len + at);
        select(visit, i0[j], i1).store(idx + at);
        u1.store(&fresh[N + 1][j * P]);
        v1.store(&fresh[N + 2][j * P]);
        // what happens beyond a quarter turn is of no interest
        (Pack::load(err + at) + select(u1 > Pack(-kHalfPi), abs(V[N][j]), zero)).store(err + at);
        const Pack top = Pack::load(fastest + at);
        select(visit, top, max(top, abs(v1))).store(fastest + at);
        ROCKING_UNROLL
        for (int k = 0; k <= N; ++k) V[k][j].store(&fresh[k][j * P]);
    }
    near &= flagged;
    if (trace && lanes[0].row >= 0 && !(flagged & 1) && tau[0] == 0.0) sample(0);
}

// Series of the ground's acceleration over the step: s a_x / g in b, a_z / g in z.
ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::forcing(int base, const Pack* i0, const Pack* t0, const Pack* h, Pack (*b)[U], Pack (*z)[U]) const {
    const double* data = motions.data;
    alignas(64) std::int64_t where[U * P];
    ROCKING_LANES i0[j].store_whole(where + j * P);
    // every lane reads a motion of its own, more streams than processors foresee: lines ahead, every eighth turn
    ROCKING_LANES __builtin_prefetch(data + where[j * P + work.sweeps % P] + 16);
    ROCKING_LANES {
        const Pack c = Pack::load(ca + base + j * P);
        if (D == 1) {
            constexpr int hop = Z ? 2 : 1;
            Pack a, da, g, dg;
            if (Z) {
                Pack::pairs(data, where + j * P, a, g);
                Pack::pairs(data + hop, where + j * P, da, dg);
            } else {
                Pack::pairs(data, where + j * P, a, da);
            }
            da = da - a;
            b[0][j] = c * fma(da, t0[j], a);
            b[1][j] = c * (da * h[j]);
            if (Z) {
                const Pack w = Pack::load(cz + base + j * P);
                dg = dg - g;
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
