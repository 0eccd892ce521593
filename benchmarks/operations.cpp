// The fast engine with numbers that count: every history in one lane, so that nothing is counted that idles.
#define ROCKING_ISA counted
#define ROCKING_PACK "../benchmarks/counted_pack.hpp"
#include "../engine/kernel.hpp"
#include "../engine/ranges.hpp"

using namespace rocking;

// Blocks with the same sides under records of one step; tells their outcomes, and what was counted: sums, products,
// quotients, roots, fused multiply-adds, lesser or greater of two, steps.
extern "C" void count_operations(const double* data, std::int64_t motions, const std::int64_t* first, const std::int64_t* segments,
                                 double step, std::int64_t count, const double* alpha, const double* p, const double* r,
                                 const double* scale, const double* rotation, const Settings* set, std::int8_t* outcome,
                                 std::int64_t* counts) {
    Motions all{data, 1, false, {}, {}, {}};
    for (std::int64_t k = 0; k < motions; ++k) all.shakes.push_back({first[k], segments[k], 0, step, 0, {0.0, 0.0}, {0.0, 0.0}});
    all.find_ranges();
    const std::vector<double> still(count, 0.0), spread(count, 0.75), share(count, 1.0);
    std::vector<std::int64_t> own(count);
    for (std::int64_t k = 0; k < count; ++k) own[k] = k;
    std::vector<double> real(8 * count);
    std::vector<std::int64_t> whole(2 * count);
    std::vector<std::int8_t> small(3 * count);
    Rows rows{count, alpha, alpha, p, p, r, r, spread.data(), spread.data(), {share.data(), share.data()}, scale, rotation,
              still.data(), own.data(), own.data(), outcome, small.data(), small.data() + count, small.data() + 2 * count,
              real.data(), real.data() + count, real.data() + 2 * count, real.data() + 3 * count,
              real.data() + 4 * count, real.data() + 5 * count,
              real.data() + 6 * count, real.data() + 7 * count, whole.data(), whole.data() + count};
    std::vector<std::int64_t> lists[2];
    const double reach = reach_of_order_six(set->longest_step);
    for (std::int64_t row = 0; row < count; ++row) lists[takes_order_six(all, rows, row, *set, reach)].push_back(row);
    const Law law;
    counted::tally = {};
    std::int64_t steps = 0;
    for (int six = 0; six < 2; ++six) {
        rows.list = lists[six].data();
        rows.count = static_cast<std::int64_t>(lists[six].size());
        Queue queue{rows.count, 256, 1};
        const Work work = six ? counted::run_rows<1, 1, 6, 1, false, false>(all, law, rows, *set, nullptr, queue)
                              : counted::run_rows<1, 1, 8, 1, false, false>(all, law, rows, *set, nullptr, queue);
        steps += work.steps;
    }
    const counted::Tally& t = counted::tally;
    for (std::int64_t n : {t.sums, t.products, t.quotients, t.roots, t.fused, t.extremes, steps}) *counts++ = n;
}
