// One Taylor step of all lanes.
#pragma once
#include "kernel.hpp"

namespace rocking {
namespace ROCKING_ISA {

// One Taylor step of every lane; those that need a visit keep their state until they have had it.
ROCKING_KERNEL
void Kernel<U, N, D, Z, L>::sweep() {
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
    unsigned long flagged = 0, near = 0;
    ROCKING_LANES {
        const int at = j * P;
        const Pack zero(0.0);
        Pack v1 = V[0][j], du = V[N][j] * Pack(1.0 / (N + 1)), sag = max(zero - V[1][j], zero) * Pack(0.125);
        ROCKING_UNROLL
        for (int k = 1; k <= N; ++k) v1 = v1 + V[k][j];
        ROCKING_UNROLL
        for (int k = N - 1; k >= 0; --k) du = fma(V[k][j], Pack(1.0 / (k + 1)), du);
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
        near |= static_cast<unsigned long>((!clear).bits()) << at;

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
    if (flagged) visit_all(flagged, near);
}

// Series of the ground's acceleration over the step: s a_x / g in b, a_z / g in z.
ROCKING_KERNEL
void Kernel<U, N, D, Z, L>::forcing(const Pack* i0, const Pack* t0, const Pack* h, Pack (*b)[U], Pack (*z)[U]) const {
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
