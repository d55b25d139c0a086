#include "core/printability/layers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/mesh/edge_table.h"

namespace fretwork {
namespace {

/// Loops are led through points where edges cross the plane; this far off they may be left out.
constexpr double kCleanMm = 0.002;
constexpr std::size_t kMostLayers = 100'000;

/// Cuts one mesh at any number of heights.
class Cutter {
  public:
    Cutter(const TriangleMesh& mesh, const RunControl& run) : mesh_(mesh), edge_of_(3 * mesh.triangles.size()) {
        const EdgeTable edges(mesh, run);
        for (std::size_t e = 0; e < edges.size(); ++e)
            for (const HalfEdge h : edges.half_edges(e)) edge_of_[h] = static_cast<std::uint32_t>(e);
    }

    /// \param triangles  at least those that reach across the height
    [[nodiscard]] Polygons cut(double z, const std::vector<std::uint32_t>& triangles) const {
        std::vector<Step> steps;
        for (const std::uint32_t t : triangles)
            if (const std::optional<Step> step = step_through(t, z)) steps.push_back(*step);
        std::ranges::sort(steps, {}, &Step::order);
        return solid_of(cleaned(loops(steps), kCleanMm));
    }

  private:
    /// A triangle leads the border from the edge where it dips below the plane to the one where it rises, with the
    /// material on the left.
    struct Step {
        std::uint32_t from_edge, to_edge, triangle;
        ClipperLib::IntPoint start;
        [[nodiscard]] std::pair<std::uint32_t, std::uint32_t> order() const { return {from_edge, triangle}; }
    };

    [[nodiscard]] bool above(std::uint32_t v, double z) const { return mesh_.positions_mm[v][2] >= z; }

    [[nodiscard]] std::optional<Step> step_through(std::uint32_t t, double z) const {
        const Triangle& corners = mesh_.triangles[t];
        std::optional<std::uint32_t> down, up;
        for (std::uint32_t k = 0; k < 3; ++k) {
            const bool start = above(corners[k], z), end = above(corners[(k + 1) % 3], z);
            if (start && !end) down = k;
            if (!start && end) up = k;
        }
        if (!down || !up) return std::nullopt;
        return Step{edge_of_[3 * t + *down], edge_of_[3 * t + *up], t,
                    crossing(corners[*down], corners[(*down + 1) % 3], z)};
    }

    /// From the lower to the higher index, so that both triangles of an edge find the same point.
    [[nodiscard]] ClipperLib::IntPoint crossing(std::uint32_t a, std::uint32_t b, double z) const {
        const Vec3 &p = mesh_.positions_mm[std::min(a, b)], &q = mesh_.positions_mm[std::max(a, b)];
        const double t = (z - p[2]) / (q[2] - p[2]);
        return point_of(Vec2(p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])));
    }

    /// Follows steps from edge to edge; `steps` ascend by their first edge. Loops that do not close are dropped.
    static Polygons loops(const std::vector<Step>& steps) {
        Polygons all;
        std::vector<std::uint8_t> used(steps.size(), 0);
        for (std::size_t first = 0; first < steps.size(); ++first) {
            Polygon loop;
            std::size_t at = first;
            while (at < steps.size() && !used[at]) {
                used[at] = 1;
                loop.push_back(steps[at].start);
                at = unused_from(steps, used, steps[at].to_edge, first);
            }
            if (at == first && loop.size() > 2) all.push_back(std::move(loop));
        }
        return all;
    }

    /// A step that starts on the edge: `first` if it is one, so that a loop closes as soon as it can.
    static std::size_t unused_from(const std::vector<Step>& steps, const std::vector<std::uint8_t>& used,
                                   std::uint32_t edge, std::size_t first) {
        if (steps[first].from_edge == edge) return first;
        const auto found = std::ranges::lower_bound(steps, edge, {}, &Step::from_edge);
        for (auto i = static_cast<std::size_t>(found - steps.begin()); i < steps.size(); ++i) {
            if (steps[i].from_edge != edge) break;
            if (!used[i]) return i;
        }
        return steps.size();
    }

    const TriangleMesh& mesh_;
    std::vector<std::uint32_t> edge_of_;
};

struct Heights {
    double bottom, step;
    std::size_t count;

    [[nodiscard]] double middle(std::size_t i) const { return bottom + (static_cast<double>(i) + 0.5) * step; }
    /// First layer whose middle lies at or above `z`.
    [[nodiscard]] std::size_t first_at(double z) const {
        const double i = std::ceil((z - bottom) / step - 0.5);
        return i <= 0.0 ? 0 : std::min(count, static_cast<std::size_t>(i));
    }
};

Heights heights_of(const TriangleMesh& mesh, double step) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Triangle& t : mesh.triangles)
        for (const std::uint32_t v : t) {
            low = std::min(low, mesh.positions_mm[v][2]);
            high = std::max(high, mesh.positions_mm[v][2]);
        }
    const double count = std::max(1.0, std::ceil((high - low) / step - 0.5));
    if (count > static_cast<double>(kMostLayers))
        throw InvalidInput("printability: the model is " + std::to_string(high - low) + " mm high, more than " +
                           std::to_string(kMostLayers) + " layers of " + std::to_string(step) + " mm");
    return {low, step, static_cast<std::size_t>(count)};
}

/// Triangles that may reach across the middle of each layer, ascending.
std::vector<std::vector<std::uint32_t>> triangles_by_layer(const TriangleMesh& mesh, const Heights& heights) {
    std::vector<std::vector<std::uint32_t>> lists(heights.count);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (const std::uint32_t v : mesh.triangles[t]) {
            low = std::min(low, mesh.positions_mm[v][2]);
            high = std::max(high, mesh.positions_mm[v][2]);
        }
        const std::size_t first = heights.first_at(low);
        // One more than needed, against rounding; a triangle that does not cross is passed over.
        const std::size_t last = std::min(heights.count, heights.first_at(high) + 1);
        for (std::size_t i = first > 0 ? first - 1 : 0; i < last; ++i) lists[i].push_back(t);
    }
    return lists;
}

}  // namespace

std::vector<Layer> cut_layers(const TriangleMesh& mesh, double layer_height_mm, const RunControl& run) {
    const Heights heights = heights_of(mesh, layer_height_mm);
    const auto lists = triangles_by_layer(mesh, heights);
    const Cutter cutter(mesh, run);
    std::vector<Layer> layers(heights.count);
    parallel_chunks(layers.size(), 1, [&](std::size_t begin, std::size_t end) {
        run.throw_if_stopped();
        for (std::size_t i = begin; i < end; ++i)
            layers[i] = {heights.middle(i), cutter.cut(heights.middle(i), lists[i])};
    });
    return layers;
}

}  // namespace fretwork
