#include "core/solidify/color_areas.h"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "core/base/disjoint_sets.h"
#include "core/base/float_rounding.h"
#include "core/base/parallel.h"
#include "core/solidify/simplify_state.h"
#include "core/solidify/vertex_normals.h"

namespace fretwork {
namespace {

constexpr std::size_t kGrain = 4096;

/// Two colours of a palette differ by at least this in one channel.
constexpr int kUnlike = 40;
constexpr std::size_t kMostColors = 12;
/// A colour this rare is not worth an area: it is a mixture along the border of two others.
constexpr double kLeastShare = 0.01;
constexpr int kRefinements = 4;
/// A colour this close to a mixture of two others is the seam between them where at most this share of the triangles at
/// its vertices are of one colour: too narrow to have two borders of its own.
constexpr int kSeamDistance = 36;
constexpr double kSeamShare = 0.5;

/// Within this of a colour of the palette a colour is no mixture; how many rings of mixtures find their area.
constexpr int kSure = 24;
constexpr int kSettlePasses = 4;

/// An edge this short, and a triangle this flat, is not cut: rounding would turn what comes out over.
constexpr double kShortestCut = 0.04;  // of the mean edge
constexpr double kFlattestCut = 2e-3;  // 4 sqrt 3 area / sum of squared sides

/// Least share of an edge between a vertex on a border and the edge's ends.
constexpr double kFromEnds = 0.05;
constexpr int kSearchSteps = 3;

int distance2(const Rgb8& a, const Rgb8& b) {
    int sum = 0;
    for (std::size_t k = 0; k < 3; ++k) sum += (int{a[k]} - int{b[k]}) * (int{a[k]} - int{b[k]});
    return sum;
}

/// How far a colour is from what two others give when mixed, squared.
int distance2_to_mixture(const Rgb8& color, const Rgb8& a, const Rgb8& b) {
    const int length2 = distance2(a, b);
    int along = 0;
    for (std::size_t k = 0; k < 3; ++k) along += (int{color[k]} - int{a[k]}) * (int{b[k]} - int{a[k]});
    if (length2 == 0 || along <= 0 || along >= length2) return std::min(distance2(color, a), distance2(color, b));
    return distance2(color, a) - static_cast<int>(static_cast<double>(along) * along / length2);
}

bool unlike(const Rgb8& a, const Rgb8& b) {
    for (std::size_t k = 0; k < 3; ++k)
        if (std::abs(int{a[k]} - int{b[k]}) >= kUnlike) return true;
    return false;
}

std::uint8_t nearest_color(const std::vector<Rgb8>& palette, const Rgb8& color) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < palette.size(); ++i)
        if (distance2(palette[i], color) < distance2(palette[best], color)) best = i;
    return static_cast<std::uint8_t>(best);
}

/// Colours counted in cells of 16 steps a side.
struct ColorCell {
    std::size_t count = 0;
    std::array<std::size_t, 3> sum = {0, 0, 0};

    void add(const ColorCell& other) {
        count += other.count;
        for (std::size_t k = 0; k < 3; ++k) sum[k] += other.sum[k];
    }
    [[nodiscard]] Rgb8 mean() const {
        Rgb8 m{};
        for (std::size_t k = 0; k < 3; ++k) m[k] = static_cast<std::uint8_t>((sum[k] + count / 2) / count);
        return m;
    }
};

std::vector<ColorCell> count_colors(const std::vector<Rgb8>& colors) {
    std::vector<ColorCell> cells(4096);
    for (const Rgb8& c : colors) {
        ColorCell& cell = cells[static_cast<std::size_t>(((c[0] >> 4) << 8) | ((c[1] >> 4) << 4) | (c[2] >> 4))];
        ++cell.count;
        for (std::size_t k = 0; k < 3; ++k) cell.sum[k] += c[k];
    }
    std::erase_if(cells, [](const ColorCell& c) { return c.count == 0; });
    std::stable_sort(cells.begin(), cells.end(),
                     [](const ColorCell& a, const ColorCell& b) { return a.count > b.count; });
    return cells;
}

std::vector<ColorCell> group_by_nearest(const std::vector<ColorCell>& cells, const std::vector<Rgb8>& palette) {
    std::vector<ColorCell> group(palette.size());
    for (const ColorCell& cell : cells) group[nearest_color(palette, cell.mean())].add(cell);
    return group;
}

/// Cuts one mesh.
class AreaCutter {
  public:
    AreaCutter(const TriangleMesh& mesh, const std::vector<Rgb8>& colors,
               const std::function<Rgb8(std::uint32_t, std::uint32_t, double)>& between, const RunControl& run)
        : mesh_(mesh), colors_(colors), between_(between), run_(run) {}

    ColorAreas cut() {
        result_.palette = choose_palette(colors_);
        result_.mesh.positions_mm = mesh_.positions_mm;
        result_.areas.of_vertex.resize(colors_.size());
        choose_areas();
        while (drop_seam()) choose_areas();
        settle_mixtures();
        merge_small();
        list_cut_edges();
        place_vertices();
        for (const Triangle& t : mesh_.triangles) cut_triangle(t);
        return std::move(result_);
    }

  private:
    using Edge = std::uint64_t;  ///< lower vertex, higher vertex

    static Edge edge(std::uint32_t a, std::uint32_t b) {
        return (static_cast<Edge>(std::min(a, b)) << 32) | std::max(a, b);
    }
    [[nodiscard]] std::uint8_t area(std::uint32_t v) const { return result_.areas.of_vertex[v]; }

    void choose_areas() {
        parallel_for(colors_.size(), kGrain,
                     [&](std::size_t v) { result_.areas.of_vertex[v] = nearest_color(result_.palette, colors_[v]); });
    }

    /// Takes the narrowest of the seams between other colours out of the palette, if there is one.
    bool drop_seam() {
        std::vector<Rgb8>& palette = result_.palette;
        std::vector<std::size_t> touching(palette.size(), 0), whole(palette.size(), 0);
        for (const Triangle& t : mesh_.triangles) {
            const std::uint8_t a = area(t[0]), b = area(t[1]), c = area(t[2]);
            ++touching[a];
            if (b != a) ++touching[b];
            if (c != a && c != b) ++touching[c];
            if (a == b && b == c) ++whole[a];
        }
        std::size_t narrowest = palette.size();
        double least = kSeamShare;
        for (std::size_t i = 0; i < palette.size(); ++i) {
            const double share =
                static_cast<double>(whole[i]) / static_cast<double>(std::max(touching[i], std::size_t{1}));
            if (share >= least || !is_mixture(i)) continue;
            least = share;
            narrowest = i;
        }
        if (narrowest == palette.size()) return false;
        palette.erase(palette.begin() + static_cast<std::ptrdiff_t>(narrowest));
        return true;
    }

    [[nodiscard]] bool is_mixture(std::size_t color) const {
        const std::vector<Rgb8>& palette = result_.palette;
        for (std::size_t j = 0; j < palette.size(); ++j)
            for (std::size_t k = j + 1; k < palette.size(); ++k)
                if (j != color && k != color &&
                    distance2_to_mixture(palette[color], palette[j], palette[k]) < kSeamDistance * kSeamDistance)
                    return true;
        return false;
    }

    /// A vertex whose colour is a mixture, as along every soft border, goes to one of the areas next to it, whatever
    /// other colour of the palette the mixture is near to.
    void settle_mixtures() {
        std::vector<std::uint8_t> sure(colors_.size());
        parallel_for(colors_.size(), kGrain, [&](std::size_t v) {
            sure[v] = distance2(colors_[v], result_.palette[area(static_cast<std::uint32_t>(v))]) <= kSure * kSure;
        });
        std::vector<std::uint16_t> beside(colors_.size());
        for (int pass = 0; pass < kSettlePasses; ++pass) {
            std::fill(beside.begin(), beside.end(), std::uint16_t{0});
            for (const Triangle& t : mesh_.triangles)
                for (std::size_t k = 0; k < 3; ++k)
                    if (sure[t[k]] != 0)
                        for (const std::uint32_t v : {t[(k + 1) % 3], t[(k + 2) % 3]})
                            if (sure[v] == 0) beside[v] = static_cast<std::uint16_t>(beside[v] | (1U << area(t[k])));
            parallel_for(colors_.size(), kGrain, [&](std::size_t v) {
                if (beside[v] == 0) return;
                result_.areas.of_vertex[v] = nearest_of(beside[v], colors_[v]);
                sure[v] = 1;
            });
        }
    }

    [[nodiscard]] std::uint8_t nearest_of(std::uint16_t areas, const Rgb8& color) const {
        std::size_t best = result_.palette.size();
        for (std::size_t i = 0; i < result_.palette.size(); ++i)
            if (((areas >> i) & 1U) != 0 &&
                (best == result_.palette.size() ||
                 distance2(result_.palette[i], color) < distance2(result_.palette[best], color)))
                best = i;
        return static_cast<std::uint8_t>(best);
    }

    /// Puts the ends of edges too short and the corners of triangles too flat to be cut or
    /// folded into one area.
    void merge_small() {
        const double shortest = kShortestCut * mean_edge();
        DisjointSets together(colors_.size());
        std::vector<std::uint8_t> at_border(colors_.size(), 0);
        for (const Triangle& t : mesh_.triangles)
            if (area(t[0]) != area(t[1]) || area(t[1]) != area(t[2]))
                for (const std::uint32_t v : t) at_border[v] = 1;
        const std::vector<Vec3f> sums = normal_sums(mesh_, at_border);
        for (const Triangle& t : mesh_.triangles) {
            if (area(t[0]) == area(t[1]) && area(t[1]) == area(t[2])) continue;
            const Vec3 &a = mesh_.positions_mm[t[0]], &b = mesh_.positions_mm[t[1]], &c = mesh_.positions_mm[t[2]];
            const bool flat = static_cast<double>(shape_of(a, b, c).quality) < kFlattestCut || folded(mesh_, t, sums);
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t from = t[k], to = t[(k + 1) % 3];
                if (flat || (mesh_.positions_mm[from] - mesh_.positions_mm[to]).norm() < shortest)
                    together.unite(from, to);
            }
        }
        for (std::uint32_t v = 0; v < colors_.size(); ++v)
            result_.areas.of_vertex[v] = result_.areas.of_vertex[together.find(v)];
    }

    [[nodiscard]] double mean_edge() const {
        double sum = 0.0;
        for (const Triangle& t : mesh_.triangles) sum += (mesh_.positions_mm[t[0]] - mesh_.positions_mm[t[1]]).norm();
        return sum / static_cast<double>(mesh_.triangles.size());
    }

    void list_cut_edges() {
        for (const Triangle& t : mesh_.triangles)
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t a = t[k], b = t[(k + 1) % 3];
                if (area(a) != area(b)) edges_.push_back(edge(a, b));
            }
        std::sort(edges_.begin(), edges_.end());
        edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
    }

    void place_vertices() {
        const std::size_t old = colors_.size();
        result_.mesh.positions_mm.resize(old + edges_.size());
        result_.areas.of_vertex.resize(old + edges_.size(), MeshAreas::kBorder);
        result_.parent.resize(edges_.size());
        parallel_chunks(edges_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
            run_.throw_if_stopped();
            for (std::size_t e = begin; e < end; ++e) {
                const auto a = static_cast<std::uint32_t>(edges_[e] >> 32), b = static_cast<std::uint32_t>(edges_[e]);
                const double share = share_of_border(a, b);
                const Vec3 &from = mesh_.positions_mm[a], &to = mesh_.positions_mm[b];
                result_.mesh.positions_mm[old + e] = rounded_to_float(from + share * (to - from));
                result_.parent[e] = share < 0.5 ? a : b;
            }
        });
    }

    /// Where along an edge the colour is as far from the one area's as from the other's (regula falsi, Illinois).
    [[nodiscard]] double share_of_border(std::uint32_t a, std::uint32_t b) const {
        const Rgb8 &own = result_.palette[area(a)], &other = result_.palette[area(b)];
        const auto nearer_other = [&](const Rgb8& c) {
            return static_cast<double>(distance2(c, own) - distance2(c, other));
        };
        double low = 0.0, high = 1.0, f_low = nearer_other(colors_[a]), f_high = nearer_other(colors_[b]);
        double share = 0.5;
        int side = 0;
        for (int step = 0; step < kSearchSteps; ++step) {
            share = f_high > f_low ? low + (high - low) * std::clamp(f_low / (f_low - f_high), 0.1, 0.9) : 0.5;
            const double f = nearer_other(between_(a, b, share));
            if (f < 0.0) {
                low = share;
                f_low = f;
                if (side == -1) f_high *= 0.5;
                side = -1;
            } else {
                high = share;
                f_high = f;
                if (side == 1) f_low *= 0.5;
                side = 1;
            }
        }
        return std::clamp(share, kFromEnds, 1.0 - kFromEnds);
    }

    [[nodiscard]] std::uint32_t vertex_on(std::uint32_t a, std::uint32_t b) const {
        const auto at = std::lower_bound(edges_.begin(), edges_.end(), edge(a, b));
        return static_cast<std::uint32_t>(colors_.size() + static_cast<std::size_t>(at - edges_.begin()));
    }

    void add(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint8_t area) {
        result_.mesh.triangles.push_back({a, b, c});
        result_.areas.of_triangle.push_back(area);
    }

    void cut_triangle(const Triangle& t) {
        const std::uint8_t a0 = area(t[0]), a1 = area(t[1]), a2 = area(t[2]);
        if (a0 == a1 && a1 == a2) return add(t[0], t[1], t[2], a0);
        if (a0 != a1 && a1 != a2 && a2 != a0) {
            const std::uint32_t m01 = vertex_on(t[0], t[1]), m12 = vertex_on(t[1], t[2]), m20 = vertex_on(t[2], t[0]);
            add(t[0], m01, m20, a0);
            add(t[1], m12, m01, a1);
            add(t[2], m20, m12, a2);
            return add(m01, m12, m20, std::min({a0, a1, a2}));
        }
        // One corner stands alone; the rest is a quadrangle, cut along its shorter diagonal.
        const std::size_t k = a1 == a2 ? 0 : a2 == a0 ? 1 : 2;
        const std::uint32_t lone = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
        const std::uint32_t mb = vertex_on(lone, b), mc = vertex_on(lone, c);
        add(lone, mb, mc, area(lone));
        const std::vector<Vec3>& at = result_.mesh.positions_mm;
        if ((at[mb] - at[c]).squaredNorm() < (at[mc] - at[b]).squaredNorm()) {
            add(mb, b, c, area(b));
            add(mb, c, mc, area(b));
        } else {
            add(mb, b, mc, area(b));
            add(b, c, mc, area(b));
        }
    }

    const TriangleMesh& mesh_;
    const std::vector<Rgb8>& colors_;
    const std::function<Rgb8(std::uint32_t, std::uint32_t, double)>& between_;
    const RunControl& run_;
    ColorAreas result_;
    std::vector<Edge> edges_;
};

}  // namespace

std::vector<Rgb8> choose_palette(const std::vector<Rgb8>& colors) {
    const std::vector<ColorCell> cells = count_colors(colors);
    std::vector<Rgb8> palette;
    for (const ColorCell& cell : cells) {
        if (palette.size() >= kMostColors) break;
        if (!palette.empty() && static_cast<double>(cell.count) < kLeastShare * static_cast<double>(colors.size()))
            break;
        const Rgb8 mean = cell.mean();
        if (std::all_of(palette.begin(), palette.end(), [&](const Rgb8& c) { return unlike(c, mean); }))
            palette.push_back(mean);
    }
    if (palette.empty()) return {Rgb8{}};
    for (int round = 0; round < kRefinements; ++round) {
        const std::vector<ColorCell> group = group_by_nearest(cells, palette);
        for (std::size_t i = 0; i < palette.size(); ++i)
            if (group[i].count > 0) palette[i] = group[i].mean();
    }
    return palette;
}

ColorAreas cut_into_areas(const TriangleMesh& mesh, const std::vector<Rgb8>& colors,
                          const std::function<Rgb8(std::uint32_t, std::uint32_t, double)>& between,
                          const RunControl& run) {
    return AreaCutter(mesh, colors, between, run).cut();
}

}  // namespace fretwork
