// Coefficients that change from impact to impact: tables over the speed, and random values independent of the order of
// rows.
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "pack.hpp"

namespace rocking {
namespace ROCKING_ISA {

inline std::uint64_t mixed(std::uint64_t z) {
    z += 0x9E3779B97F4A7C15ull;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return z ^ (z >> 31);
}

// Number in [0, 1) that depends only on the seed, the history and the number of the impact.
inline double uniform(std::uint64_t seed, std::int64_t key, std::int64_t impact) {
    const std::uint64_t z =
        mixed(mixed(mixed(seed) + static_cast<std::uint64_t>(key)) + static_cast<std::uint64_t>(impact));
    return static_cast<double>(z >> 11) * 0x1p-53;  // Eq. 43
}

inline double interpolated(const std::vector<double>& at, const std::vector<double>& value, double x) {
    if (!(x > at.front())) return value.front();
    if (x >= at.back()) return value.back();
    const std::size_t k = std::upper_bound(at.begin(), at.end(), x) - at.begin();
    return value[k - 1] + (value[k] - value[k - 1]) * ((x - at[k - 1]) / (at[k] - at[k - 1]));  // Eq. 44
}

}  // namespace ROCKING_ISA
}  // namespace rocking
