#include "core/exemplar/otsu.h"

#include <cstddef>

namespace fretwork {

std::optional<double> otsu_threshold(const Histogram& histogram) {
    double count = 0, sum = 0;
    for (std::size_t v = 0; v < 256; ++v) {
        count += static_cast<double>(histogram[v]);
        sum += static_cast<double>(v) * static_cast<double>(histogram[v]);
    }
    double dark_count = 0, dark_sum = 0, best = 0;
    std::size_t first = 0, last = 0;
    for (std::size_t v = 0; v + 1 < 256; ++v) {
        dark_count += static_cast<double>(histogram[v]);
        dark_sum += static_cast<double>(v) * static_cast<double>(histogram[v]);
        const double light_count = count - dark_count;
        if (dark_count <= 0 || light_count <= 0) continue;
        const double gap = dark_sum / dark_count - (sum - dark_sum) / light_count;
        const double between = dark_count * light_count * gap * gap;
        if (between > best) {
            best = between;
            first = v;
        }
        // The same sums give the same bits, so an empty stretch compares equal.
        if (between == best) last = v;
    }
    if (best <= 0) return std::nullopt;
    return 0.5 * static_cast<double>(first + last) + 0.5;
}

}  // namespace fretwork
