// Largest ground accelerations in each block of segments, and from each block to the end.
#pragma once
#include <algorithm>

#include "batch.hpp"

namespace rocking {

// Range of an acceleration within a segment: of its samples, or of a polynomial's terms.
inline void widen(Range& range, const double* a, int degree) {
    double low = a[0], high = a[0];
    for (int j = 1; degree > 1 && j <= degree; ++j) (a[j] < 0.0 ? low : high) += a[j];
    range.low = std::min(range.low, low);
    range.high = std::max(range.high, high);
}

inline void find_later(Ranges& ranges, std::int64_t block, Range& all) {
    all = {0.0, 0.0};
    ranges.later.resize(ranges.within.size());
    for (std::int64_t b = static_cast<std::int64_t>(ranges.within.size()); b-- > block;) {
        all = {std::min(all.low, ranges.within[b].low), std::max(all.high, ranges.within[b].high)};
        ranges.later[b] = all;
    }
}

inline void Motions::find_ranges() {
    const int hop = stride();
    for (Shake& shake : shakes) {
        shake.block = static_cast<std::int64_t>(horizontal.within.size());
        const std::int64_t total = shake.segments + shake.still;
        for (std::int64_t from = 0; from < total; from += kBlock) {
            Range across{1e300, -1e300}, up = across;
            const std::int64_t stop = std::min(total, from + kBlock) + (degree == 1);
            for (const double* a = data + shake.first + from * hop; a < data + shake.first + stop * hop; a += hop) {
                widen(across, a, degree);
                if (vertical_part) widen(up, a + 1, 1);
            }
            horizontal.within.push_back(across);
            if (vertical_part) vertical.within.push_back(up);
        }
        find_later(horizontal, shake.block, shake.horizontal);
        find_later(vertical, vertical_part ? shake.block : 0, shake.vertical);
    }
}

}  // namespace rocking
