#include "likeness/shape_statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/error.h"
#include "core/exemplar/distance_transform.h"

namespace fretwork::likeness {
namespace {

/// The pixels met from (x, y) in steps of (dx, dy), until the border or, in a picture that wraps, until the start.
std::vector<std::uint8_t> line_from(const std::vector<std::uint8_t>& mask, const PatternPicture& p, int x, int y,
                                    int dx, int dy) {
    std::vector<std::uint8_t> line;
    const int x0 = x, y0 = y;
    do {
        line.push_back(
            mask[static_cast<std::size_t>(y) * static_cast<std::size_t>(p.width) + static_cast<std::size_t>(x)]);
        x += dx;
        y += dy;
        if (p.wraps) x = (x + p.width) % p.width, y = (y + p.height) % p.height;
    } while (x >= 0 && x < p.width && y >= 0 && y < p.height && (x != x0 || y != y0));
    return line;
}

/// Adds the lengths of the runs of `value` that end at both sides within the line.
void add_runs(const std::vector<std::uint8_t>& line, std::uint8_t value, bool cyclic, double step,
              std::vector<double>& lengths) {
    const std::size_t n = line.size();
    const auto first_change = std::adjacent_find(line.begin(), line.end(), std::not_equal_to<>());
    if (first_change == line.end()) return;
    const auto start = static_cast<std::size_t>(first_change - line.begin()) + 1;
    const std::size_t end = cyclic ? start + n : n;
    for (std::size_t i = start; i < end;) {
        std::size_t run = i;
        while (run < end && line[run % n] == line[i % n]) ++run;
        if (line[i % n] == value && (cyclic || run < n)) lengths.push_back(step * static_cast<double>(run - i));
        i = run;
    }
}

}  // namespace

std::vector<std::uint8_t> solid_mask(const PatternPicture& picture) {
    std::vector<std::uint8_t> mask;
    mask.reserve(picture.pixels.size());
    for (const PatternPixel& p : picture.pixels) mask.push_back(p[3] >= 0.5F ? 1 : 0);
    return mask;
}

std::vector<double> chord_lengths(const PatternPicture& p, bool solid, int direction) {
    constexpr int kSteps[4][2] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}};
    const int dx = kSteps[direction][0], dy = kSteps[direction][1];
    const std::vector<std::uint8_t> mask = solid_mask(p);
    std::vector<double> lengths;
    const auto add_line = [&](int x, int y) {
        add_runs(line_from(mask, p, x, y, dx, dy), solid ? 1 : 0, p.wraps, std::hypot(dx, dy), lengths);
    };
    if (p.wraps) {
        // Lines close on themselves; each is walked once from every row (column) it starts in, which leaves the
        // distribution as it is.
        if (dy == 0)
            for (int y = 0; y < p.height; ++y) add_line(0, y);
        else
            for (int x = 0; x < p.width; ++x) add_line(x, 0);
        return lengths;
    }
    if (dx != 0)
        for (int y = 0; y < p.height; ++y) add_line(0, y);
    if (dy != 0)
        for (int x = dx == 0 ? 0 : 1; x < p.width; ++x) add_line(x, dy > 0 ? 0 : p.height - 1);
    return lengths;
}

std::vector<double> thicknesses(const PatternPicture& picture, bool solid) {
    const std::vector<std::uint8_t> mask = solid_mask(picture);
    std::vector<float> level;
    level.reserve(mask.size());
    for (const std::uint8_t m : mask) level.push_back(m != 0 ? 0.5F : -0.5F);
    const std::vector<float> distance = signed_distance_px(level, picture.width, picture.height, picture.wraps);
    std::vector<double> result;
    for (std::size_t i = 0; i < mask.size(); ++i)
        if ((mask[i] != 0) == solid && std::isfinite(distance[i]))
            result.push_back(std::abs(static_cast<double>(distance[i])));
    return result;
}

double wasserstein(std::vector<double> a, std::vector<double> b) {
    if (a.empty() || b.empty()) throw InvalidInput("a distribution needs at least one value");
    std::ranges::sort(a);
    std::ranges::sort(b);
    // The area between the two quantile functions, whose steps are at multiples of 1/n and 1/m.
    const std::size_t n = a.size(), m = b.size();
    double sum = 0.0;
    for (std::size_t i = 0, j = 0, at = 0; i < n && j < m;) {
        const std::size_t next = std::min((i + 1) * m, (j + 1) * n);
        sum += static_cast<double>(next - at) * std::abs(a[i] - b[j]);
        if (next == (i + 1) * m) ++i;
        if (next == (j + 1) * n) ++j;
        at = next;
    }
    return sum / (static_cast<double>(n) * static_cast<double>(m));
}

double relative_wasserstein(const std::vector<double>& output, const std::vector<double>& reference) {
    if (reference.empty()) return output.empty() ? 0.0 : 1.0;
    if (output.empty()) return 1.0;
    const double mean =
        std::accumulate(reference.begin(), reference.end(), 0.0) / static_cast<double>(reference.size());
    return wasserstein(output, reference) / mean;
}

}  // namespace fretwork::likeness
