// One set of kernels for one instruction set; compiled once for each, with ROCKING_ISA naming it.
#include "kernel.hpp"
#include "table.hpp"

namespace rocking {
namespace ROCKING_ISA {

// Registers of a group, whose flags fill one word where a register holds eight numbers, and groups: enough lanes for
// those that land to fill registers of their own, few enough for the caches. A single history takes one.
constexpr int kMany = 8, kGroups = 3;

Run kernel_for(bool single, const Choice& c) {
    if (c.order == 8) {
        if (c.degree == 7) {
            if (c.linear) return single ? run_rows<1, 1, 8, 7, false, true> : run_rows<kGroups, kMany, 8, 7, false, true>;
            return single ? run_rows<1, 1, 8, 7, false, false> : run_rows<kGroups, kMany, 8, 7, false, false>;
        }
        if (c.vertical) {
            if (c.linear) return single ? run_rows<1, 1, 8, 1, true, true> : run_rows<kGroups, kMany, 8, 1, true, true>;
            return single ? run_rows<1, 1, 8, 1, true, false> : run_rows<kGroups, kMany, 8, 1, true, false>;
        }
        if (c.linear) return single ? run_rows<1, 1, 8, 1, false, true> : run_rows<kGroups, kMany, 8, 1, false, true>;
        return single ? run_rows<1, 1, 8, 1, false, false> : run_rows<kGroups, kMany, 8, 1, false, false>;
    }
    if (c.linear) return nullptr;
    if (c.order == 6) {
        if (c.degree == 7) return run_rows<kGroups, kMany, 6, 7, false, false>;
        if (c.vertical) return single ? run_rows<1, 1, 6, 1, true, false> : run_rows<kGroups, kMany, 6, 1, true, false>;
        return single ? run_rows<1, 1, 6, 1, false, false> : run_rows<kGroups, kMany, 6, 1, false, false>;
    }
    if (c.vertical) return nullptr;
    if (c.order == 4) return c.degree == 7 ? run_rows<kGroups, kMany, 4, 7, false, false> : run_rows<kGroups, kMany, 4, 1, false, false>;
    return nullptr;
}

}  // namespace ROCKING_ISA
}  // namespace rocking
