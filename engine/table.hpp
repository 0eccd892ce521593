// Selection of the kernel for a problem.
#pragma once
#include "batch.hpp"

namespace rocking {

struct Choice {
    int order, degree;
    bool vertical, linear;
};

using Run = Work (*)(const Motions&, const Law&, const Rows&, const Settings&, Trace*, Queue&);

#define ROCKING_DECLARE(isa) \
    namespace isa {          \
    Run kernel_for(bool single, const Choice&); \
    }
ROCKING_DECLARE(plain)
#if defined(ROCKING_X86)
ROCKING_DECLARE(avx2)
ROCKING_DECLARE(avx512)
#endif
#undef ROCKING_DECLARE

}  // namespace rocking
