// Highest points: steps in which a body may reverse wait here until they fill complete registers.
#pragma once
#include "kernel.hpp"

namespace rocking {
namespace ROCKING_ISA {

// Stores a step up to a position at which the body is at `height` above the ground. If the body returns to the ground
// there and starts upwards, the step contains a turning point.
ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::keep_peak(int i, Step step, double upto, double height, bool comes_down) {
    const int s = peaks_waiting++;
    ROCKING_UNROLL
    for (int k = 0; k <= N; ++k) waiting[k][s] = step[k];
    const bool turns = step[0] < 0.0 && comes_down;
    bases[s] = alpha[i] - u[i];
    peaks[s] = {i, lanes[i].side, lanes[i].row, stretch_of(i), tau[i], length(i), upto, turns ? height : -1.0};
    // The step is always stored, even if the highest point is known. Otherwise the next action of a lane would depend
    // on the time of the search, and therefore on other lanes.
    if (turns) peak[i] = std::max(peak[i], std::max(bases[s], height));
    if (peaks_waiting == M * P) find_peaks();
}

// Finds the zeros of the velocity in all waiting steps, in parallel.
ROCKING_KERNEL
void Kernel<G, U, N, D, Z, L>::find_peaks() {
    alignas(64) double at[M * P], height[M * P];
    Pack rise[N + 1][M];
    ROCKING_UNROLL
    for (int k = 0; k <= N; ++k)
        for (int m = 0; m < M; ++m) rise[k][m] = Pack(0.0) - Pack::load(&waiting[k][m * P]);
    SimpleRoots<N, M> ends;
    const Bits ended = ends.solve(rise);
    for (int m = 0; ended && m < M; ++m) {
        Pack y = rise[N][m] * Pack(1.0 / (N + 1));
        ROCKING_UNROLL
        for (int k = N - 1; k >= 0; --k) y = fma(y, ends.zero[m], rise[k][m] * Pack(1.0 / (k + 1)));
        ends.zero[m].store(at + m * P);
        fma(y, ends.zero[m], Pack::load(bases + m * P)).store(height + m * P);
    }
    for (int s = 0; s < peaks_waiting; ++s) {
        const Top& top = peaks[s];
        if (lanes[top.lane].row != top.row) continue;  // this row has ended in the meantime
        if (ended >> s & 1) {
            raise_peak(top, at[s], height[s]);
        } else {
            double c[N + 2], slopes[N + 1];
            c[0] = bases[s];
            for (int k = 0; k <= N; ++k) {
                slopes[k] = -waiting[k][s];
                c[k + 1] = slopes[k] * (1.0 / (k + 1));
            }
            each_fall<N>(slopes, [&](double x) { raise_peak(top, x, value_of<N + 1>(c, x)); });
        }
        raise_peak(top, top.upto, top.end);  // the end can be a peak: rounding may hide a zero of the velocity there
    }
    peaks_waiting = 0;
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

// True if a step of this lane waits.
ROCKING_KERNEL
bool Kernel<G, U, N, D, Z, L>::has_peaks(int i) const {
    for (int s = 0; s < peaks_waiting; ++s)
        if (peaks[s].lane == i && peaks[s].row == lanes[i].row) return true;
    return false;
}

}  // namespace ROCKING_ISA
}  // namespace rocking
