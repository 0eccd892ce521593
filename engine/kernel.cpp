// One set of kernels for one instruction set; compiled once for each, with ROCKING_ISA naming it.
#include "kernel.hpp"
#include "table.hpp"

namespace rocking {
namespace ROCKING_ISA {

// Registers of a group, whose flags fill one word where a register holds eight numbers, and groups: enough lanes for
// those that land to fill registers of their own, few enough for the caches. A single history takes one.
constexpr int kMany = 8, kGroups = 3;

// A history has the same bits alone and among many: where such processors are rare (plain and AVX2), one set of
// kernels is used for both, and where a wider register has no effect on a single history, that of AVX2 is used.
template <int N, int D, bool Z, bool L>
Run rows_of(bool single) {
#if defined(ROCKING_X86) && !defined(ROCKING_AVX2) && !defined(ROCKING_AVX512)
    return run_rows<1, 1, N, D, Z, L>;
#elif defined(ROCKING_AVX512)
    return run_rows<kGroups, kMany, N, D, Z, L>;
#else
    if constexpr (N < 8) return run_rows<kGroups, kMany, N, D, Z, L>;
    else return single ? run_rows<1, 1, N, D, Z, L> : run_rows<kGroups, kMany, N, D, Z, L>;
#endif
}

Run kernel_for(bool single, const Choice& c) {
#if defined(ROCKING_AVX512)
    // wider registers have no effect on a single history; rare kernels are compiled once
    if ((single && c.order == 8) || c.linear || c.degree == 7 || c.order == 4) return avx2::kernel_for(single, c);
    if (c.order == 6) return c.vertical ? rows_of<6, 1, true, false>(false) : rows_of<6, 1, false, false>(false);
    return c.vertical ? rows_of<8, 1, true, false>(single) : rows_of<8, 1, false, false>(single);
#else
    if (c.order == 8) {
        if (c.degree == 7) return c.linear ? rows_of<8, 7, false, true>(single) : rows_of<8, 7, false, false>(single);
        if (c.vertical) return c.linear ? rows_of<8, 1, true, true>(single) : rows_of<8, 1, true, false>(single);
        return c.linear ? rows_of<8, 1, false, true>(single) : rows_of<8, 1, false, false>(single);
    }
    if (c.linear) return nullptr;
    // many histories use order 6 where it applies; a single history on request only, and order 4 likewise
    if (c.order == 6) {
        if (c.degree == 7) return rows_of<6, 7, false, false>(false);
        return c.vertical ? rows_of<6, 1, true, false>(false) : rows_of<6, 1, false, false>(false);
    }
    if (c.vertical || c.order != 4) return nullptr;
    return c.degree == 7 ? rows_of<4, 7, false, false>(false) : rows_of<4, 1, false, false>(false);
#endif
}

}  // namespace ROCKING_ISA
}  // namespace rocking
