// Highest points: steps within which a body may turn round wait here, until they fill registers of their own.
#pragma once
#include "kernel.hpp"

namespace rocking {
namespace ROCKING_ISA {

// Takes over a step, up to a place in it, at whose end the body stands `height` above the ground.
ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::keep_top(int i, Step made, double upto, double height, bool comes_back) {
    const int s = turns++;
    ROCKING_UNROLL
    for (int k = 0; k <= N; ++k) turning[k][s] = made[k];
    const double start = alpha[i] - u[i];
    bases[s] = start;
    tops[s] = {i, lanes[i].side, lanes[i].row, stretch_of(i), tau[i], length(i), upto};
    // Between two lower points there is one as high as these. No more is claimed before it is found, so that what
    // this lane does next does not depend on others.
    if (made[0] < 0.0 && comes_back) peak[i] = std::max(peak[i], std::max(start, height));
    if (turns == M * P) find_tops();
}

// Where the velocity changes its sign: all steps that wait, side by side.
ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::find_tops() {
    alignas(64) double at[M * P], height[M * P];
    Pack rise[N + 1][M];
    ROCKING_UNROLL
    for (int k = 0; k <= N; ++k)
        for (int m = 0; m < M; ++m) rise[k][m] = Pack(0.0) - Pack::load(&turning[k][m * P]);
    Falls<N, M> falls;
    const Bits found = falls.solve(rise);
    for (int m = 0; m < M; ++m) {
        Pack y = rise[N][m] * Pack(1.0 / (N + 1));
        ROCKING_UNROLL
        for (int k = N - 1; k >= 0; --k) y = fma(y, falls.zero[m], rise[k][m] * Pack(1.0 / (k + 1)));
        falls.zero[m].store(at + m * P);
        fma(y, falls.zero[m], Pack::load(bases + m * P)).store(height + m * P);
    }
    for (int s = 0; s < turns; ++s) {
        if (lanes[tops[s].lane].row != tops[s].row) continue;  // it has overturned since
        if (found >> s & 1) {
            raise_peak(tops[s], at[s], height[s]);
            continue;
        }
        double c[N + 2], slopes[N + 1];
        c[0] = bases[s];
        for (int k = 0; k <= N; ++k) {
            slopes[k] = -turning[k][s];
            c[k + 1] = slopes[k] * (1.0 / (k + 1));
        }
        each_fall<N>(slopes, [&](double x) { raise_peak(tops[s], x, value_of<N + 1>(c, x)); });
    }
    turns = 0;
}

ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::raise_peak(const Top& top, double at, double y) {
    Lane& lane = lanes[top.lane];
    if (!(at <= top.upto) || !(y > std::fabs(lane.peak_signed))) return;
    lane.peak_signed = top.side * y;
    lane.peak_time = (top.stretch + (top.tau + at * top.length)) * lane.step;
}

ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::raise_peak(int i, double y, double time) {
    peak[i] = std::max(peak[i], y);
    Lane& lane = lanes[i];
    if (!(y > std::fabs(lane.peak_signed))) return;
    lane.peak_signed = lane.side * y;
    lane.peak_time = time;
}

// Whether a step of this lane waits.
ROCKING_KERNEL
bool Kernel<G, U, N, D, Z, L>::turned(int i) const {
    for (int s = 0; s < turns; ++s)
        if (tops[s].lane == i && tops[s].row == lanes[i].row) return true;
    return false;
}

}  // namespace ROCKING_ISA
}  // namespace rocking
