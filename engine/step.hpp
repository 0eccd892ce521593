// One Taylor step of all lanes.
#pragma once
#include "kernel.hpp"

namespace rocking {
namespace ROCKING_ISA {

// One Taylor step of every lane, then the events of the flagged lanes. Lanes that may touch the ground are computed in
// parallel.
ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::sweep() {
    int landing[W], landings = 0;
    ++work.sweeps;
    work.steps += active;
    for (int first = 0; first < used; first += U) {
        Bits flagged, near;
        step(first * P, std::min(U, used - first), flagged, near);
        work.events += count_of(flagged);
        for (Bits left = near; left; left &= left - 1) {
            const int k = lowest(left), i = first * P + k;
            ROCKING_UNROLL
            for (int m = 0; m <= N; ++m) queued[m][landings] = fresh[m][k];
            above[landings] = alpha[i] - u[i];
            floors[landings] = peak[i];
            span[landings] = length(i);
            landing[landings++] = i;
        }
        for (Bits left = flagged & ~near; left; left &= left - 1) {
            const int k = lowest(left), i = first * P + k;
            resolve_event(i, {&fresh[0][k], U * P}, false);
            if (lanes[i].row < 0) fill(i);
        }
    }
    for (int at = 0; at < landings; at += M * P) land(landing + at, at, std::min(landings - at, M * P));
    for (int k = 0; k < landings; ++k)
        if (lanes[landing[k]].row < 0) fill(landing[k]);
    while (used > Q && active <= (used - Q) * P) close_ranks();
}

// One Taylor step of several registers; a lane with an event keeps its state until the event is resolved. The loops are
// not unrolled: their bodies then fit in the window of out-of-order execution and in the cache of decoded instructions.
ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::step(int base, int count, Bits& flagged, Bits& near) {
    // every lane reads its own motion, and there are too many streams for the processor to predict: prefetch one lane
    // per step
    for (int r = 0; r < count; ++r) ROCKING_PREFETCH(motions.data + idx[base + r * P + work.sweeps % P] + 16);
    ROCKING_ROLLED
    for (int r = 0; r < count; ++r) {
        forcing(base, r);
        const Pack angle = Pack::load(u + base + r * P);
        if (L) sines[r] = angle;
        else sine_cosine(angle, sines[r], cosines[r]);
    }
    Bits beats = 0;
    flagged = near = 0;
    ROCKING_ROLLED
    for (int r = 0; r < count; r += Q) {
        Pack S[N + 1][Q], C[N + 1][Q], V[N + 1][Q], h[Q], qh[Q], w[Q];
        Pack more[Q], size[Q], sway[Q];  // sums over the terms from V2 on: rotation, bounds of its curvature, velocity
        ROCKING_SIDE_BY_SIDE {
            const int at = base + (r + j) * P;
            h[j] = spans[r + j];
            qh[j] = Pack::load(kappa + at) * h[j] * h[j];
            V[0][j] = Pack::load(v + at) * h[j];
            V[0][j].store(&fresh[0][(r + j) * P]);
            S[0][j] = sines[r + j];
            C[0][j] = cosines[r + j];
        }
        // The newest terms are used last, so that few dependent operations wait for them.
        ROCKING_UNROLL
        for (int k = 0; k < N; ++k) {
            const Pack inverse(1.0 / (k + 1)), shared(1.0 / (k + 2)), bow((k + 1.0) / (k + 2));
            ROCKING_SIDE_BY_SIDE {
                Pack f = S[k][j];
                if (Z && k > 0) f = fma(z[1][r + j], S[k - 1][j], f);
                if (Z) f = fma(z[0][r + j], S[k][j], f);
                if (L) {
                    if (k <= D) f = f + b[k][r + j];  // Eq. 15
                } else {
                    ROCKING_UNROLL
                    for (int m = (k < D ? k : D); m >= 0; --m) f = fma(b[m][r + j], C[k - m][j], f);  // Eq. 14
                }
                if (k > 0) f = f * inverse;
                w[j] = k == 0 ? f : w[j] + f;
                V[k + 1][j] = f * qh[j];  // Eq. 48
                V[k + 1][j].store(&fresh[k + 1][(r + j) * P]);
                if (k == 0) continue;
                const Pack far = abs(V[k + 1][j]);
                more[j] = k == 1 ? V[k + 1][j] * shared : fma(V[k + 1][j], shared, more[j]);
                size[j] = k == 1 ? far * bow : fma(far, bow, size[j]);
                sway[j] = k == 1 ? far * Pack(0.25) : k == 2 ? fma(far, Pack(0.4), sway[j]) : far + sway[j];
            }
            if (k + 1 == N) break;
            ROCKING_SIDE_BY_SIDE {
                if (L) {
                    S[k + 1][j] = V[k][j] * inverse;
                } else {
                    Pack s = V[k][j] * C[0][j], c = V[k][j] * S[0][j];
                    ROCKING_UNROLL
                    for (int m = k - 1; m >= 0; --m) {
                        s = fma(V[m][j], C[k - m][j], s);  // Eq. 49
                        c = fma(V[m][j], S[k - m][j], c);  // Eq. 50
                    }
                    S[k + 1][j] = k > 0 ? s * inverse : s;
                    C[k + 1][j] = k > 0 ? c * Pack(-1.0 / (k + 1)) : Pack(0.0) - c;
                }
            }
        }
        ROCKING_SIDE_BY_SIDE {
            const int col = (r + j) * P, at = base + col;
            const Pack zero(0.0), u0 = Pack::load(u + at), v0 = Pack::load(v + at), t0 = Pack::load(tau + at);
            const Whole i0 = Whole::load(idx + at);
            const Pack du = V[0][j] + fma(V[1][j], Pack(0.5), more[j]);
            const Pack u1 = u0 + du, v1 = fma(Pack::load(kappa + at) * h[j], w[j], v0);

            // With y = y0 + c1 x + c2 x^2 + ..., y >= y0 (1 - x) + y1 x - sag x (1 - x), where sag = c2+ + 2 c3+ + ...:
            // there is no zero if sag < (sqrt y0 + sqrt y1)^2. If y = 0 at the start, the polynomial is divided by this
            // zero first.
            const Pack vh = v1 * h[j], away = zero - V[0][j], signs = vh - V[0][j] - V[1][j] - more[j];
            const Pack sag = Pack(0.5) * (max(zero - V[1][j], zero) + (size[j] - signs));
            const Pack y0 = Pack::load(alpha + at) - u0, y1 = y0 - du, start = select(y0 == zero, away, y0);
            const Pack low = min(start, y1);
            const Mask clear = (low > zero) & (fma(Pack(3.0), low, max(start, y1)) > sag);  // Eq. 55
            // The velocity deviates from the straight line between its ends by less than `sway`.
            const Mask turns = ((v0 < zero) & (v1 >= zero)) | (sway[j] >= min(abs(V[0][j]), abs(vh)));
            const Mask turning = turns & (y0 + max(away, zero) + sag > Pack::load(peak + at));
            const Mask beyond = (u1 < Pack::load(gate + at)) | ((u1 < zero) & (fma(Pack(0.25), max(sag, zero), max(u0, u1)) >= zero));
            // contact force at the start of the step, times (p h)^2: see forces.hpp
            Pack up = Z ? fma(z[0][r + j], qh[j], qh[j]) : qh[j], along = b[0][r + j] * qh[j];
            const Pack minus = Pack::load(lever + at);
            if (L) {
                Pack sine, cosine;
                sine_cosine(max(S[0][j], Pack(-kHalfPi)), sine, cosine);
                const Pack half = minus * Pack(0.5), square = V[0][j] * V[0][j];
                up = fma(half, fma(V[1][j], sine, square * cosine), up);
                along = fma(half, fnma(square, sine, V[1][j] * cosine), along);
            } else {
                up = fnma(minus, C[2][j], up);
                along = fma(minus, S[2][j], along);
            }
            const Mask beyond_so_far = (up < Pack::load(least + at) * qh[j]) | (abs(along) > Pack::load(demand + at) * up);
            beats |= static_cast<Bits>(beyond_so_far.bits()) << col;

            const Pack t1 = t0 + h[j];
            const Mask done = t1 >= Pack(kWhole);
            const Whole i1 = i0.plus(stride, done);
            const Mask event = !clear | beyond | turning | (done & (i1 >= Whole::load(last + at)));
            flagged |= static_cast<Bits>(event.bits()) << col;
            near |= static_cast<Bits>((!clear).bits()) << col;

            const Mask goes = !event;
            u1.store_where(goes, u + at);
            v1.store_where(goes, v + at);
            select(done, zero, t1).store_where(goes, tau + at);
            select(event, i0, i1).store(idx + at);
            u1.store(u_end + at);
            v1.store(v_end + at);
            // errors beyond a quarter turn are ignored
            (Pack::load(err + at) + select(u1 > Pack(-kHalfPi), abs(V[N][j]), zero)).store(err + at);
            const Pack top = Pack::load(fastest + at);
            max(top, abs(v1)).store_where(goes, fastest + at);
        }
    }
    near &= flagged;
    if (beats) note_forces(base, beats);
    if (trace && lanes[0].row >= 0 && !(flagged & 1) && tau[0] == 0.0) sample(0);
}

// Series of the ground acceleration over the step: s a_x / g in b, a_z / g in z.
ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::forcing(int base, int j) {
    const double* data = motions.data;
    const std::int64_t* where = idx + base;
    const Pack c = Pack::load(ca + base + j * P), t0 = Pack::load(tau + base + j * P), h = step_of(base + j * P);
    spans[j] = h;
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
        b[0][j] = c * fma(da, t0, a);
        b[1][j] = c * (da * h);
        if (Z) {
            const Pack w = Pack::load(cz + base + j * P);
            dg = dg - g;
            z[0][j] = w * fma(dg, t0, g);
            z[1][j] = w * (dg * h);
        }
    } else {
        Pack p[D + 1];
        ROCKING_UNROLL
        for (int k = 0; k <= D; ++k) p[k] = c * Pack::gather(data + k, where + j * P);
        ROCKING_UNROLL
        for (int k = 0; k < D; ++k) {  // Taylor shift to t0
            ROCKING_UNROLL
            for (int m = D - 1; m >= k; --m) p[m] = fma(t0, p[m + 1], p[m]);  // Eq. 51
        }
        Pack power = h;
        b[0][j] = p[0];
        ROCKING_UNROLL
        for (int k = 1; k <= D; ++k) {
            b[k][j] = p[k] * power;
            power = power * h;
        }
    }
}

}  // namespace ROCKING_ISA
}  // namespace rocking
