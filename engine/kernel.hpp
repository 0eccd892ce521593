// The fast engine: Taylor steps of many histories side by side, each lane at its own sample of its own motion.
//
// A lane holds u = alpha - |theta| and its derivative, on the side on which the body stands:
//     u'' = p^2 { (1 + a_z / g) S + s (a_x / g) C },   S = sin u, C = cos u   (slender-linear: S = u, C = 1),
// with s = +1 on the right foot. S and C are carried as series: S' = C u', C' = -S u'. One expansion covers one stretch
// of the motion or a part of it; whatever is not a plain step (impact, uplift, rest, the top, the end) is left to the
// lane-by-lane part, so that the part that counts has no branches.
#pragma once
#include <algorithm>
#include <limits>

#include "batch.hpp"
#include "landing.hpp"
#include "law.hpp"
#include "pack.hpp"
#include "roots.hpp"
#include "sine.hpp"

namespace rocking {
namespace ROCKING_ISA {

constexpr double kWhole = 1.0 - 1e-13;  // a step that ends this close to the end of its stretch ends with it
constexpr double kMostError = 0.01;     // sum of error estimates above which nothing is claimed [rad]
constexpr double kMostSteps = 2e7;      // steps of a history
constexpr double kLongest = 40.0;       // stretches that flights to rest may take
constexpr double kHeights = 0.1;        // what the heights of these flights may add to the logarithm of their gain
constexpr double kNothing = 1e-9;       // speeds over p alpha that are as good as none
constexpr double kHalfPi = 1.57079632679489661923;

#define ROCKING_KERNEL template <int G, int U, int N, int D, bool Z, bool L>
#define ROCKING_LANES ROCKING_UNROLL for (int j = 0; j < U; ++j)

// G groups of U registers of lanes, order N, motions of degree D, with a vertical part if Z, slender-linear if L.
ROCKING_KERNEL
class Kernel {
    static constexpr int P = Pack::width, W = G * U * P;

    // state of the lanes; unused ones stay at rest on stretch zero
    alignas(64) double u[W], v[W], tau[W], len[W], sub[W], kappa[W], ca[W], cz[W], alpha[W], peak[W], idx[W], last[W],
        stride[W], err[W], fastest[W], gate[W];
    alignas(64) double terms[N + 1][W], end_u[W], end_v[W];  // of the step that waits for a visit

    struct Side {
        double alpha, p, sine, cosine, r;
    };
    struct Lane {
        std::int64_t row = -1, impacts = 0, uplifts = 0, still = 0;
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
    Queue& queue;
    std::int64_t next = 0, end = 0;  // rows taken from the queue and not yet begun
    int active = 0, busy[G] = {};

  public:
    Work work;

    Kernel(const Motions& m, const Law& l, const Rows& r, const Settings& s, Trace* t, Queue& q)
        : motions(m), law(l), rows(r), set(s), trace(t), queue(q) {}

    void run() {
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
    void sweep();
    void step(int group, unsigned long& flagged, unsigned long& near);
    template <int M>
    void land(const int* who, int count);
    void forcing(int base, const Pack* i0, const Pack* t0, const Pack* h, Pack (*b)[U], Pack (*z)[U]) const;

    // ---- one lane ---------------------------------------------------------------------------------------------------

    double now(int i, double fraction) const {
        const Lane& lane = lanes[i];
        const double index = (idx[i] - lane.first) / motions.stride();
        return (index + (tau[i] + fraction * len[i])) * lane.step;
    }
    void sample(int i);
    void note(int i, EventKind kind, double time, double before, double after, double coefficient);
    void touch(int i, double zero, double speed);
    void visit(int i, bool near);
    double first_contact(double* c) const;
    void note_peak(int i, const double* c, double upto);
    void raise_peak(int i, double y, double time);
    void impact(int i, double at, double speed);
    double coefficient(int i, double speed) const;
    void stand(int i);
    void move(int i, double to);
    void advance(int i, const double* V);
    bool over(int i);
    void overturned(int i);
    bool beyond_return(int i) const;
    double next_look(int i) const;
    const Bounds& bounds_at(int i) const;
    void holding(int i, int side, std::int64_t at, double* d) const;
    double release(int i, int side, std::int64_t at, double from) const;

    struct Window {
        double low[2], variation, steepness;
    };
    bool window(int i, std::int64_t stretches, Window& w) const;
    bool comes_to_rest(int i, double after) const;

    double largest(const Side& s) const { return law.kind == LawKind::constant ? s.r : s.r * law.largest; }
    void rest(int i);
    std::int64_t first_loud(std::int64_t at, std::int64_t end, double scale, double calm) const;
    bool may_lift(int i, const Bounds& b) const;
    int preferred(int i, std::int64_t at, double from) const;
    void lift(int i, std::int64_t at, int side, double when);
    void conclude(int i);
    void falls(int i, double when);
    static double energy(const Side& s, double u_, double speed);
    static double height(const Side& s, double e);

    // ---- lanes and the queue ----------------------------------------------------------------------------------------
    void finish(int i, Outcome outcome, Status status);
    void idle(int i);
    static bool valid(const Rows& r, std::int64_t k, std::size_t motions);
    void fill(int i);
    void write_invalid(std::int64_t row);
    double parts_of_step(const Lane& lane, double p) const;
    void start(int i, std::int64_t row);
};

ROCKING_KERNEL
Work run_rows(const Motions& m, const Law& law, const Rows& r, const Settings& s, Trace* t, Queue& q) {
    Kernel<G, U, N, D, Z, L> kernel(m, law, r, s, t, q);
    kernel.run();
    return kernel.work;
}

}  // namespace ROCKING_ISA
}  // namespace rocking

#include "resting.hpp"
#include "rows.hpp"
#include "step.hpp"
#include "verdict.hpp"
#include "visits.hpp"
