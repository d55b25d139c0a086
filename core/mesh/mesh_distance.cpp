#include "core/mesh/mesh_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/mesh/check_mesh.h"
#include "core/mesh/closest_point.h"
#include "core/mesh/spread_points.h"

namespace fretwork {
namespace {

OneSidedDistance one_sided(const TriangleMesh& from, const TriangleMesh& to, const MeshDistanceSettings& settings,
                           const RunControl& run) {
    const SurfaceTree tree(to, run);
    std::vector<Vec3> points;
    for (const SpreadPoint& p : spread_points(from, settings.samples, settings.seed, RandomStream::kMeshDistance))
        points.push_back(p.at_mm);
    std::vector<std::uint8_t> used(from.positions_mm.size(), 0);
    for (const Triangle& t : from.triangles)
        for (const std::uint32_t v : t)
            if (used[v] == 0) used[v] = 1, points.push_back(from.positions_mm[v]);
    const std::vector<ClosestPoint> answers = tree.closest(points, std::numeric_limits<double>::infinity(), run);
    OneSidedDistance result;
    for (std::size_t i = 0; i < answers.size(); ++i) {
        const double d = answers[i].distance_mm;
        result.max_mm = std::max(result.max_mm, d);
        if (i >= settings.samples) continue;
        result.mean_mm += d;
        result.root_mean_square_mm += d * d;
    }
    result.mean_mm /= static_cast<double>(settings.samples);
    result.root_mean_square_mm = std::sqrt(result.root_mean_square_mm / static_cast<double>(settings.samples));
    return result;
}

}  // namespace

MeshDistance mesh_distance(const TriangleMesh& first, const TriangleMesh& second, const MeshDistanceSettings& settings,
                           const RunControl& run) {
    if (settings.samples == 0) throw InvalidSetting("mesh distance: samples is 0; expected at least 1");
    check_mesh(first, "mesh distance, first mesh");
    check_mesh(second, "mesh distance, second mesh");
    return {one_sided(first, second, settings, run), one_sided(second, first, settings, run)};
}

}  // namespace fretwork
