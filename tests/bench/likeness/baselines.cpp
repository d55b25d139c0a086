#include "likeness/baselines.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/base/counter_random.h"
#include "likeness/windows.h"

namespace fretwork::likeness {
namespace {

using Place = std::array<int, 2>;

/// The uses of random numbers in this file.
enum : std::uint32_t { kCrop = 100, kBlocks, kNoise, kShift, kStart, kSearch = 200 };

int random_below(std::uint64_t seed, std::uint32_t use, std::uint64_t item, std::uint32_t draw, int n) {
    return static_cast<int>(
        index_below(counter_random(seed, RandomStream::kTest, use, item, draw), static_cast<std::uint32_t>(n)));
}

template <class Source>
SourceMap make_map(int width, int height, const Source& source) {
    SourceMap map{width, height, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) map.source.push_back(source(x, y));
    return map;
}

int wrapped(int i, int n) {
    return ((i % n) + n) % n;
}

/// One level of the search of `synthesized_map`.
class WindowMatcher {
  public:
    WindowMatcher(const PatternPicture& exemplar, SourceMap start, bool use_similar, std::uint64_t seed)
        : e_(exemplar), map_(std::move(start)), seed_(seed) {
        for (Place& p : map_.source) p = allowed(p);
        if (use_similar) list_similar();
    }

    /// Visits all pixels once. With `everywhere`, every place of the exemplar is a candidate.
    void pass(std::uint32_t number, bool everywhere) {
        for (int y = 0; y < map_.height; ++y)
            for (int x = 0; x < map_.width; ++x) improve(x, y, number, everywhere);
    }

    [[nodiscard]] const SourceMap& map() const { return map_; }

  private:
    static constexpr int kHalf = kWindowSide / 2, kReach = 2, kRandom = 4;

    /// The nearest place whose whole window lies in the exemplar.
    [[nodiscard]] Place allowed(const Place& p) const {
        if (e_.wraps) return {wrapped(p[0], e_.width), wrapped(p[1], e_.height)};
        return {std::clamp(p[0], kHalf, e_.width - 1 - kHalf), std::clamp(p[1], kHalf, e_.height - 1 - kHalf)};
    }
    [[nodiscard]] bool is_allowed(const Place& p) const { return e_.wraps || allowed(p) == p; }
    [[nodiscard]] std::size_t index(const Place& p) const {
        return static_cast<std::size_t>(p[1]) * static_cast<std::size_t>(e_.width) + static_cast<std::size_t>(p[0]);
    }

    /// For every place another one, elsewhere, that looks most like it.
    void list_similar() {
        similar_.resize(e_.pixels.size());
        const PlacedWindows all = all_windows(e_);
        const WindowBasis basis = principal_basis(all.windows);
        // The two colours of a chessboard of 8 x 8 pixels are searched in each other, so that no place finds itself.
        std::array<std::vector<std::uint32_t>, 2> rows;
        for (std::uint32_t i = 0; i < all.size(); ++i) {
            const int color = (static_cast<int>(all.corner[i].x()) / 8 + static_cast<int>(all.corner[i].y()) / 8) % 2;
            rows[static_cast<std::size_t>(color)].push_back(i);
        }
        for (std::size_t color = 0; color < 2; ++color) {
            const PlacedWindows queries = rows_of(all, rows[color]), pool = rows_of(all, rows[1 - color]);
            if (pool.size() == 0) continue;
            const std::vector<Nearest> found = NearestWindows(pool.windows, basis).nearest(queries.windows);
            for (std::size_t i = 0; i < found.size(); ++i)
                similar_[index(center(queries, i))] = center(pool, found[i].row);
        }
        for (int y = 0; y < e_.height; ++y)
            for (int x = 0; x < e_.width; ++x)
                if (Place& p = similar_[index({x, y})]; !is_allowed(p)) p = allowed({x, y});
    }
    [[nodiscard]] Place center(const PlacedWindows& all, std::size_t row) const {
        const Vec2f& c = all.corner[row];
        return {(static_cast<int>(c.x()) + kHalf) % e_.width, (static_cast<int>(c.y()) + kHalf) % e_.height};
    }

    void improve(int x, int y, std::uint32_t number, bool everywhere) {
        gather(x, y);
        best_ = std::numeric_limits<float>::max();
        try_place(map_.at(x, y));
        for (int j = -kReach; j <= kReach; ++j)
            for (int i = -kReach; i <= kReach; ++i) {
                const int nx = x + i, ny = y + j;
                if ((i == 0 && j == 0) || nx < 0 || ny < 0 || nx >= map_.width || ny >= map_.height) continue;
                const Place& n = map_.at(nx, ny);
                try_place({n[0] - i, n[1] - j});
                if (similar_.empty() || std::abs(i) > 1 || std::abs(j) > 1) continue;
                const Place& twin = similar_[index(n)];
                try_place({twin[0] - i, twin[1] - j});
            }
        const auto item =
            static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(map_.width) + static_cast<std::uint64_t>(x);
        for (std::uint32_t k = 0; k < kRandom; ++k)
            try_place({random_below(seed_, kSearch + number, item, 2 * k, e_.width),
                       random_below(seed_, kSearch + number, item, 2 * k + 1, e_.height)});
        if (everywhere)
            for (int v = 0; v < e_.height; ++v)
                for (int u = 0; u < e_.width; ++u) try_place({u, v});
        map_.source[item] = best_place_;
    }

    /// What surrounds (x, y) now.
    void gather(int x, int y) {
        around_.clear();
        for (int j = -kHalf; j <= kHalf; ++j)
            for (int i = -kHalf; i <= kHalf; ++i) {
                if ((i == 0 && j == 0) || x + i < 0 || y + j < 0 || x + i >= map_.width || y + j >= map_.height)
                    continue;
                const Place& p = map_.at(x + i, y + j);
                around_.push_back({{i, j}, e_.at(p[0], p[1])});
            }
    }

    void try_place(const Place& wanted) {
        if (!is_allowed(wanted)) return;
        const Place p = allowed(wanted);
        float sum = 0.0F;
        for (const auto& [offset, seen] : around_) {
            const PatternPixel& there =
                e_.at(wrapped(p[0] + offset[0], e_.width), wrapped(p[1] + offset[1], e_.height));
            for (std::size_t c = 0; c < 4; ++c) sum += (there[c] - seen[c]) * (there[c] - seen[c]);
            if (sum >= best_) return;
        }
        best_ = sum;
        best_place_ = p;
    }

    const PatternPicture& e_;
    SourceMap map_;
    std::uint64_t seed_;
    std::vector<Place> similar_;
    std::vector<std::pair<Place, PatternPixel>> around_;
    float best_ = 0.0F;
    Place best_place_{};
};

}  // namespace

SourceMap crop_map(const PatternPicture& exemplar, int side, std::uint64_t seed) {
    // A tenth is left over, so that there is a choice of places.
    const int width = exemplar.wraps ? side : std::min(side, exemplar.width * 9 / 10);
    const int height = exemplar.wraps ? side : std::min(side, exemplar.height * 9 / 10);
    const int x0 = random_below(seed, kCrop, 0, 0, exemplar.wraps ? exemplar.width : exemplar.width - width);
    const int y0 = random_below(seed, kCrop, 0, 1, exemplar.wraps ? exemplar.height : exemplar.height - height);
    return make_map(width, height, [&](int x, int y) {
        return Place{(x0 + x) % exemplar.width, (y0 + y) % exemplar.height};
    });
}

SourceMap synthesized_map(const PatternPicture& exemplar, int side, std::uint64_t seed) {
    std::vector<PatternPicture> pyramid{exemplar};
    while (std::min(pyramid.back().width, pyramid.back().height) >= 32) pyramid.push_back(halved(pyramid.back()));
    const auto coarsest = static_cast<int>(pyramid.size()) - 1;
    const auto side_at = [&](int level) { return (side + (1 << level) - 1) >> level; };
    SourceMap map = make_map(side_at(coarsest), side_at(coarsest), [&](int x, int y) {
        const auto item = static_cast<std::uint64_t>(y * side + x);
        return Place{random_below(seed, kStart, item, 0, pyramid.back().width),
                     random_below(seed, kStart, item, 1, pyramid.back().height)};
    });
    std::uint32_t number = 0;
    for (int level = coarsest; level >= 0; --level) {
        if (level < coarsest)
            map = make_map(side_at(level), side_at(level), [&](int x, int y) {
                const Place& p = map.at(x / 2, y / 2);
                return Place{2 * p[0] + x % 2, 2 * p[1] + y % 2};
            });
        WindowMatcher matcher(pyramid[static_cast<std::size_t>(level)], std::move(map), level > 0, seed);
        const int passes = level == coarsest ? 10 : 2 + 2 * level;
        for (int pass = 0; pass < passes; ++pass) matcher.pass(number++, level == coarsest);
        map = matcher.map();
    }
    return map;
}

SourceMap tiled_map(const PatternPicture& exemplar, int side, std::uint64_t seed) {
    const int block = std::max(8, exemplar.width / 4);
    return make_map(side, side, [&](int x, int y) {
        const auto item = static_cast<std::uint64_t>(y / block * 1000 + x / block);
        return Place{random_below(seed, kBlocks, item, 0, exemplar.width - block) + x % block,
                     random_below(seed, kBlocks, item, 1, exemplar.height - block) + y % block};
    });
}

SourceMap noise_map(const PatternPicture& exemplar, int side, std::uint64_t seed) {
    return make_map(side, side, [&](int x, int y) {
        const auto item = static_cast<std::uint64_t>(y * side + x);
        return Place{random_below(seed, kNoise, item, 0, exemplar.width),
                     random_below(seed, kNoise, item, 1, exemplar.height)};
    });
}

PatternPicture picture_of(const SourceMap& map, const PatternPicture& exemplar, std::uint64_t seed) {
    const double dx = unit_interval(counter_random(seed, RandomStream::kTest, kShift, 0, 0)) - 0.5;
    const double dy = unit_interval(counter_random(seed, RandomStream::kTest, kShift, 0, 1)) - 0.5;
    return read_picture(exemplar, map.width, map.height, [&](int x, int y) {
        const Place& p = map.at(x, y);
        return Vec2(p[0] + 0.5 + dx, p[1] + 0.5 + dy);
    });
}

}  // namespace fretwork::likeness
