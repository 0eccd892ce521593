// One set of kernels, compiled once for each instruction set; ROCKING_ISA is the name of the set.
#include "kernel.hpp"
#include "table.hpp"

namespace rocking {
namespace ROCKING_ISA {

// kMany registers per group: with eight numbers per register, the flags of a group fill one word. kGroups groups: the
// landing lanes fill complete registers, and all lanes fit into the caches. A single history uses one register in one
// group.
constexpr int kMany = 8, kGroups = 3;

// A history has the same bits alone and among many histories. Plain and AVX2 processors are rare, so one set of kernels
// serves both cases. If a wider register has no effect on a single history, the AVX2 kernels are used.
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
    // wider registers have no effect on a single history; rarely used kernels are compiled once
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
    // batches use order 6 where it is sufficient; a single history uses order 6 or 4 only on request
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
