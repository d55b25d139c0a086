#include "core/exemplar/distance_transform.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "core/base/parallel.h"

namespace fretwork {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kNone = -1;

/// Stands for "no crossing on this line of n links"; real links, unwrapped, lie in [-n, 2n).
constexpr int no_link(int n) {
    return -n - 1;
}

/// Where the border crosses the links from a pixel to its right and to its lower neighbour, as a
/// fraction of the link; negative where it does not.
struct Crossings {
    std::vector<float> right, down;
};

/// A view of the level field that knows whether it wraps.
struct Field {
    std::span<const float> level;
    int width, height;
    bool wrap;

    [[nodiscard]] std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
    [[nodiscard]] int wrap_x(int x) const { return (x % width + width) % width; }
    [[nodiscard]] int wrap_y(int y) const { return (y % height + height) % height; }
    /// Whether the cell between pixels (x, y) and (x + 1, y + 1) exists.
    [[nodiscard]] bool has_cell(int x, int y) const {
        return wrap || (x >= 0 && y >= 0 && x + 1 < width && y + 1 < height);
    }
};

/// Keeps a crossing off the pixel centre itself, so that no distance is zero and each keeps its sign.
float crossing(float a, float b) {
    if ((a > 0) == (b > 0)) return -1.0f;
    return std::clamp(a / (a - b), 1.0f / 256, 255.0f / 256);
}

Crossings find_crossings(const Field& f) {
    Crossings c;
    c.right.assign(f.level.size(), -1.0f);
    c.down.assign(f.level.size(), -1.0f);
    parallel_for(static_cast<std::size_t>(f.height), 16, [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < f.width; ++x) {
            const float here = f.level[f.index(x, y)];
            if (f.wrap || x + 1 < f.width)
                c.right[f.index(x, y)] = crossing(here, f.level[f.index(f.wrap_x(x + 1), y)]);
            if (f.wrap || y + 1 < f.height)
                c.down[f.index(x, y)] = crossing(here, f.level[f.index(x, f.wrap_y(y + 1))]);
        }
    });
    return c;
}

/// One line of links: for each pixel i the nearest crossing on the line, as the unwrapped index of
/// the pixel before it, or no_link(n). `at(i)` is the crossing after pixel i, negative if there is none.
template <class At>
void nearest_on_line(int n, bool wrap, const At& at, std::vector<int>& nearest) {
    const int none = no_link(n);
    nearest.assign(static_cast<std::size_t>(n), none);
    const auto position = [&](int link) { return static_cast<float>(link) + at((link + n) % n); };
    const auto offer = [&](int i, int link) {
        int& best = nearest[static_cast<std::size_t>(i)];
        const float d = std::abs(position(link) - static_cast<float>(i));
        if (best == none || d < std::abs(position(best) - static_cast<float>(i))) best = link;
    };
    // Twice around, so that what lies across the border is known when the line wraps.
    int last = none;
    for (int j = wrap ? -n : 0; j < n; ++j) {
        if (j >= 0 && last != none) offer(j, last);
        if (at((j + n) % n) >= 0) last = j;
    }
    last = none;
    for (int j = wrap ? 2 * n - 1 : n - 1; j >= 0; --j) {
        if (at(j % n) >= 0) last = j;
        if (j < n && last != none) offer(j, last);
    }
}

/// Lower envelope of the parabolas `height[q] + (x - q)^2`, q in [first, first + count).
struct Envelope {
    std::vector<int> apex;
    std::vector<double> from;

    template <class Height>
    void build(int first, int count, const Height& height) {
        apex.clear();
        from.clear();
        for (int q = first; q < first + count; ++q) {
            const double h = height(q);
            if (std::isinf(h)) continue;
            double start = -std::numeric_limits<double>::infinity();
            while (!apex.empty()) {
                const int p = apex.back();
                start = ((h + static_cast<double>(q) * q) - (height(p) + static_cast<double>(p) * p)) / (2.0 * (q - p));
                if (start > from.back()) break;
                apex.pop_back();
                from.pop_back();
                start = -std::numeric_limits<double>::infinity();
            }
            apex.push_back(q);
            from.push_back(start);
        }
    }
};

struct Point {
    float x, y;
};

float distance_to_segment(Point a, Point b) {
    // From the origin: the caller works relative to the pixel.
    const float dx = b.x - a.x, dy = b.y - a.y;
    const float length2 = dx * dx + dy * dy;
    const float t = length2 > 0 ? std::clamp(-(a.x * dx + a.y * dy) / length2, 0.0f, 1.0f) : 0.0f;
    return std::hypot(a.x + t * dx, a.y + t * dy);
}

/// Sides of a cell, clockwise from the top.
enum Side { kTop, kRight, kBottom, kLeft };

/// Distance from `pixel` to the segment that enters the cell with upper left pixel (x, y) through
/// `side`; infinity if the cell does not exist. (x, y) is not wrapped, so it may be compared with
/// `pixel`.
float distance_in_cell(const Field& f, const Crossings& c, int x, int y, Side side, Point pixel) {
    if (!f.has_cell(x, y)) return kInfinity;
    const int x0 = f.wrap_x(x), x1 = f.wrap_x(x + 1), y0 = f.wrap_y(y), y1 = f.wrap_y(y + 1);
    const std::array<float, 4> cut = {c.right[f.index(x0, y0)], c.down[f.index(x1, y0)], c.right[f.index(x0, y1)],
                                      c.down[f.index(x0, y0)]};
    const int cuts = static_cast<int>(std::ranges::count_if(cut, [](float t) { return t >= 0; }));
    int other = kNone;
    if (cuts == 4) {
        // A saddle: the mean decides which diagonal is joined through the middle of the cell.
        const float mean =
            f.level[f.index(x0, y0)] + f.level[f.index(x1, y0)] + f.level[f.index(x0, y1)] + f.level[f.index(x1, y1)];
        const bool joined = (mean > 0) == (f.level[f.index(x0, y0)] > 0);
        constexpr std::array<int, 4> kCutsOffTopRight = {kRight, kTop, kLeft, kBottom};
        constexpr std::array<int, 4> kCutsOffTopLeft = {kLeft, kBottom, kRight, kTop};
        other = joined ? kCutsOffTopRight[side] : kCutsOffTopLeft[side];
    } else {
        for (int s = 0; s < 4; ++s)
            if (s != side && cut[static_cast<std::size_t>(s)] >= 0) other = s;
    }
    const auto point = [&](int s) -> Point {
        const float t = cut[static_cast<std::size_t>(s)];
        const float px = static_cast<float>(x) - pixel.x, py = static_cast<float>(y) - pixel.y;
        if (s == kTop) return {px + t, py};
        if (s == kRight) return {px + 1, py + t};
        if (s == kBottom) return {px + t, py + 1};
        return {px, py + t};
    };
    return distance_to_segment(point(side), point(other));
}

/// Unsigned distance to the border, looking only at crossings on horizontal links (`transposed`
/// false) or vertical links; written as the minimum into `distance`.
void lower_to_crossings(const Field& f, const Crossings& c, bool transposed, std::vector<float>& distance) {
    // "Line" runs along the links, "across" over the lines.
    const int along = transposed ? f.height : f.width;
    const int across = transposed ? f.width : f.height;
    const auto pixel = [&](int i, int line) { return transposed ? f.index(line, i) : f.index(i, line); };
    const std::vector<float>& cut = transposed ? c.down : c.right;

    std::vector<int> link(f.level.size());
    parallel_chunks(static_cast<std::size_t>(across), 16, [&](std::size_t begin, std::size_t end) {
        std::vector<int> nearest;
        for (std::size_t l = begin; l < end; ++l) {
            const int line = static_cast<int>(l);
            nearest_on_line(
                along, f.wrap, [&](int i) { return cut[pixel(i, line)]; }, nearest);
            for (int i = 0; i < along; ++i) link[pixel(i, line)] = nearest[static_cast<std::size_t>(i)];
        }
    });

    const int margin = f.wrap ? across / 2 + 1 : 0;
    const auto wrapped = [&](int line) { return ((line % across) + across) % across; };
    parallel_chunks(static_cast<std::size_t>(along), 16, [&](std::size_t begin, std::size_t end) {
        Envelope envelope;
        std::vector<double> height(static_cast<std::size_t>(across));
        for (std::size_t column = begin; column < end; ++column) {
            const int i = static_cast<int>(column);
            for (int line = 0; line < across; ++line) {
                const int l = link[pixel(i, line)];
                double& h = height[static_cast<std::size_t>(line)];
                h = std::numeric_limits<double>::infinity();
                if (l == no_link(along)) continue;
                const double d = l + static_cast<double>(cut[pixel((l + along) % along, line)]) - i;
                h = d * d;
            }
            envelope.build(-margin, across + 2 * margin,
                           [&](int q) { return height[static_cast<std::size_t>(wrapped(q))]; });
            std::size_t piece = 0;
            for (int line = 0; line < across && !envelope.apex.empty(); ++line) {
                while (piece + 1 < envelope.apex.size() && envelope.from[piece + 1] <= line) ++piece;
                const int q = envelope.apex[piece];
                const int l = link[pixel(i, wrapped(q))];
                const double h = height[static_cast<std::size_t>(wrapped(q))];
                float d = static_cast<float>(std::sqrt(h + static_cast<double>(q - line) * (q - line)));
                if (transposed) {
                    const Point p{static_cast<float>(line), static_cast<float>(i)};
                    d = std::min(
                        {d, distance_in_cell(f, c, q, l, kLeft, p), distance_in_cell(f, c, q - 1, l, kRight, p)});
                } else {
                    const Point p{static_cast<float>(i), static_cast<float>(line)};
                    d = std::min(
                        {d, distance_in_cell(f, c, l, q, kTop, p), distance_in_cell(f, c, l, q - 1, kBottom, p)});
                }
                float& best = distance[pixel(i, line)];
                best = std::min(best, d);
            }
        }
    });
}

}  // namespace

std::vector<float> signed_distance_px(std::span<const float> level, int width, int height, bool wrap) {
    const Field field{level, width, height, wrap};
    const Crossings crossings = find_crossings(field);
    std::vector<float> distance(level.size(), kInfinity);
    lower_to_crossings(field, crossings, false, distance);
    lower_to_crossings(field, crossings, true, distance);
    for (std::size_t i = 0; i < distance.size(); ++i)
        if (level[i] > 0) distance[i] = -distance[i];
    return distance;
}

}  // namespace fretwork
