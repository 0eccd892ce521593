// The fast engine: Taylor steps of many histories in parallel. Every lane has its own motion and its own sample.
//
// A lane contains u = alpha - |theta| and its derivative, for the side of contact:
//     u'' = p^2 { (1 + a_z / g) S + s (a_x / g) C },   S = sin u, C = cos u   (slender-linear: S = u, C = 1),
// with s = +1 on the right foot. S and C are series too: S' = C u', C' = -S u'. One expansion covers one segment
// of the motion or a part of it. Other events (impact, uplift, rest, point of no return, end) are computed lane by
// lane, so that the loop over the steps has no branches.
#pragma once
#include <algorithm>
#include <limits>

#include "batch.hpp"
#include "simple_roots.hpp"
#include "law.hpp"
#include "pack.hpp"
#include "roots.hpp"
#include "sine.hpp"

namespace rocking {
namespace ROCKING_ISA {

constexpr double kWhole = 1.0 - 1e-13;  // fraction of a segment; a step that ends after it ends with the segment
constexpr double kMostError = 0.01;     // above this sum of error estimates there is no result [rad]
constexpr double kMostSteps = 2e7;      // largest number of steps of a history
constexpr double kLongest = 40.0;       // largest number of segments of the flights before rest
// bound on the effect of the heights of these flights on the logarithm of their gain
constexpr double kHeights = 0.1;
constexpr double kNothing = 1e-9;       // speeds / (p alpha) that count as zero
constexpr double kHalfPi = 1.57079632679489661923;

#define ROCKING_KERNEL template <int G, int U, int N, int D, bool Z, bool L>
#define ROCKING_SIDE_BY_SIDE ROCKING_UNROLL for (int j = 0; j < Q; ++j)

// G groups of U registers of lanes, order N, motions of degree D, with a vertical part if Z, slender-linear if L.
ROCKING_KERNEL
class Kernel {
    static constexpr int P = Pack::width, W = G * U * P;
    static constexpr int stride = D == 1 ? (Z ? 2 : 1) : D + 1;  // number of values per sample or segment
    static constexpr int Q = U > 1 ? 2 : 1;  // registers that are computed in parallel
    static constexpr int M = G > 1 ? 2 : 1;  // registers of lanes that land or reverse, computed in parallel
    using Bits = std::uint64_t;              // one bit per lane of a group

    // state of the lanes; unused lanes rest on segment zero. `peak` is a height that the body has reached: lower points
    // are ignored. The highest point may be larger by the change within a step.
    alignas(64) double u[W], v[W], tau[W], sub[W], kappa[W], ca[W], cz[W], alpha[W], peak[W], err[W], fastest[W], gate[W];
    // Extreme contact forces: smallest normal force / m g, largest ratio of horizontal to normal force. For the foot of
    // contact: -2 m R^2 / I_o, sine and cosine of alpha.
    alignas(64) double least[W], demand[W], lever[W], sine_of[W], cosine_of[W];
    alignas(64) std::int64_t idx[W], last[W];
    alignas(64) Pack b[D + 1][U], z[2][U], sines[U], cosines[U], spans[U];  // for the steps of a group
    alignas(64) double u_end[W], v_end[W];   // end of the last step
    alignas(64) double fresh[N + 1][U * P];  // terms of the last steps of a group
    alignas(64) double queued[N + 1][W + M * P] = {};  // terms of the lanes that may touch the ground
    // heights, `peak` and step lengths of these lanes
    alignas(64) double above[W + M * P] = {}, floors[W + M * P] = {}, span[W + M * P] = {};

    struct alignas(64) Side {  // kappa, push: per segment; calm: at lower speeds the body may come to rest
        double alpha, p, sine, cosine, r, kappa, push, calm;
    };
    struct Step {  // terms of the velocity, as a column of a table
        const double* terms;
        int pitch;
        double operator[](int k) const { return terms[k * pitch]; }
    };
    struct alignas(64) Lane {
        Side sides[2];
        std::int64_t row = -1, impacts = 0, uplifts = 0, still = 0, first, block;
        int side = 0;
        double q[2];  // m R^2 / I_o of both sides
        double ax, az, step, peak_signed, peak_time, over_time, first_uplift;  // peak: the largest rotation until now
    } lanes[W];
    double least_before[W], demand_before[W];  // values at the passage of a body over its foot
    // Steps that may contain the highest point of a lane: their terms, initial heights, lanes, the positions up to
    // which the steps are valid, and the heights there if the body has reversed by then, otherwise -1.
    alignas(64) double waiting[N + 1][M * P] = {}, bases[M * P] = {};
    struct Top {
        int lane, side;
        std::int64_t row;
        double stretch, tau, length, upto, end;
    } peaks[M * P];
    int peaks_waiting = 0;
    struct {  // the next row, prepared in advance, so that no lane waits for memory
        Lane lane;
        bool still;                // true if it starts at rest
        double parts;
        std::int64_t segments;     // number of segments of its motion
        std::int64_t from;         // first sample that may cause uplift from rest
        std::int64_t row = -1;
    } ready;

    const Motions& motions;
    const Law& law;
    const Rows& rows;
    const Settings& set;
    Trace* trace;
    Queue& queue;
    std::int64_t next = 0, end = 0;  // rows from the queue that have not started
    int active = 0, used = G * U;    // number of lanes with a row, number of registers with such lanes

  public:
    Work work;

    Kernel(const Motions& m, const Law& l, const Rows& r, const Settings& s, Trace* t, Queue& q)
        : motions(m), law(l), rows(r), set(s), trace(t), queue(q) {}

    void run() {
        for (int i = 0; i < W; ++i) fill(i);
        while (active) sweep();
    }

  private:
    Side side_of(double alpha, double p, double r, double step, double push) const {
        const double unit = p * alpha * step;
        Side s{alpha, p, alpha, 1.0, r, (p * step) * (p * step), push, std::max(set.rest, kNothing) * unit};
        if (!L) sine_cosine(alpha, s.sine, s.cosine);
        return s;
    }

    const Side& here(int i) const { return lanes[i].sides[lanes[i].side < 0]; }

    static int count_of(Bits bits) {
#if defined(__GNUC__)
        return __builtin_popcountll(bits);
#else
        int n = 0;
        for (; bits; bits &= bits - 1) ++n;
        return n;
#endif
    }

    static int lowest(Bits bits) {
#if defined(__GNUC__)
        return __builtin_ctzll(bits);
#else
        int i = 0;
        while (!(bits >> i & 1)) ++i;
        return i;
#endif
    }

    // ---- all lanes at once ------------------------------------------------------------------------------------------
    void sweep();
    void step(int base, int count, Bits& flagged, Bits& near);
    void land(const int* who, int from, int count);
    Pack step_of(int at) const { return min(Pack::load(sub + at), Pack(1.0) - Pack::load(tau + at)); }
    void forcing(int base, int j);

    // ---- one lane ---------------------------------------------------------------------------------------------------

    // length of the next step / length of a segment
    double length(int i) const { return std::min(sub[i], 1.0 - tau[i]); }
    double stretch_of(int i) const { return static_cast<double>((idx[i] - lanes[i].first) / stride); }
    double now(int i, double fraction) const {
        const Lane& lane = lanes[i];
        return (stretch_of(i) + (tau[i] + fraction * length(i))) * lane.step;
    }
    ROCKING_APART void sample(int i);
    ROCKING_APART void note(int i, EventKind kind, double time, double before, double after, double coefficient);
    void arc(int i, Step step, double* c) const;
    ROCKING_APART void resolve_event(int i, Step step, bool near);
    double first_contact(double* c) const;
    void keep_peak(int i, Step step, double upto, double height, bool comes_down);
    ROCKING_APART void find_peaks();
    void raise_peak(const Top& top, double at, double y);
    void raise_peak(int i, double y, double time);
    bool has_peaks(int i) const;
    ROCKING_APART void note_forces(int base, Bits beats);
    ROCKING_INLINE void force_at(int i, double sine, double cosine, double speed, double push, double weight);
    void force_at_end(int i);
    ROCKING_APART void note_force(int i, double up, double along, double square);
    ROCKING_INLINE void touch(int i, double speed, double push, double weight);
    ROCKING_INLINE void ground_at(int i, double to, double& push, double& weight) const;
    void pass_over(int i, double speed, double to);
    void forces_up_to_here(int i);
    ROCKING_INLINE bool bounce(int i, double at, double speed);
    void settle(int i);
    ROCKING_APART double coefficient(int i, double speed) const;
    void stand(int i);
    void move(int i, double to);
    void advance(int i, Step step);
    bool over(int i);
    void overturned(int i);
    bool beyond_return(int i) const;
    double next_look(int i) const;
    std::int64_t block_at(int i) const;
    Range up(const std::vector<Range>& ranges, std::int64_t block) const { return Z ? ranges[block] : Range{0.0, 0.0}; }
    void still_to_come(int i, double& back, double& weight) const;
    void holding(int i, int side, std::int64_t at, double* d) const;
    double release(int i, int side, std::int64_t at, double from) const;

    struct Window {
        double low[2], variation, steepness;
    };
    bool window(int i, std::int64_t stretches, double most_varies, Window& w) const;
    bool comes_to_rest(int i, double after) const;

    double largest(int i, int side) const;
    void rest(int i);
    void await(int i, std::int64_t at);
    std::int64_t first_loud(std::int64_t at, std::int64_t end, double scale, double calm) const;
    bool may_lift(const Lane& lane, Range across, Range up) const;
    std::int64_t first_block(const Lane& lane, std::int64_t at, std::int64_t stop) const;
    int preferred(int i, std::int64_t at, double from) const;
    void lift(int i, std::int64_t at, int side, double when);
    void conclude(int i);
    void overturns(int i, double when);
    static double energy(const Side& s, double u_, double speed);
    static double height(const Side& s, double e);

    // ---- lanes and the queue ----------------------------------------------------------------------------------------
    void finish(int i, Outcome outcome, Status status);
    void idle(int i);
    void close_ranks();
    void move_lane(int from, int to);
    static bool valid(const Rows& r, std::int64_t k, std::size_t motions);
    void fill(int i);
    std::int64_t listed(std::int64_t k) const { return rows.list ? rows.list[k] : k; }
    void write_invalid(std::int64_t row);
    static bool resolved(double parts, std::int64_t stretches) { return parts * static_cast<double>(stretches) <= kMostSteps; }
    bool prepare(std::int64_t row);
    void write_still(std::int64_t row);
    void look_for_one();
    const Shake* shake_of(std::int64_t position) const;
    void start(int i);
};

ROCKING_KERNEL
Work run_rows(const Motions& m, const Law& law, const Rows& r, const Settings& s, Trace* t, Queue& q) {
    Kernel<G, U, N, D, Z, L> kernel(m, law, r, s, t, q);
    kernel.run();
    kernel.work.orders = N * kernel.work.steps;
    return kernel.work;
}

}  // namespace ROCKING_ISA
}  // namespace rocking

#include "forces.hpp"
#include "resting.hpp"
#include "rows.hpp"
#include "step.hpp"
#include "peaks.hpp"
#include "verdict.hpp"
#include "events.hpp"
