#include "support/width_oracle.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "core/base/counter_random.h"
#include "core/base/parallel.h"
#include "core/mesh/closest_point.h"

namespace fretwork::testing {
namespace {

struct Samples {
    std::vector<Vec3> points;
    std::vector<Vec3> normals;
    std::vector<std::uint8_t> solid;
};

Samples spread_samples(const TriangleMesh& surface, double spacing_mm) {
    Samples samples;
    double owed = 0.0;  // area not yet paid for by a sample
    std::uint64_t drawn = 0;
    for (const Triangle& t : surface.triangles) {
        const Vec3 a = surface.positions_mm[t[0]];
        const Vec3 ab = surface.positions_mm[t[1]] - a;
        const Vec3 ac = surface.positions_mm[t[2]] - a;
        const Vec3 twice_area = ab.cross(ac);
        owed += 0.5 * twice_area.norm() / (spacing_mm * spacing_mm);
        while (owed >= 1.0) {
            owed -= 1.0;
            double u = unit_interval(counter_random(1, RandomStream::kTest, 0, drawn, 0));
            double v = unit_interval(counter_random(1, RandomStream::kTest, 0, drawn, 1));
            ++drawn;
            if (u + v > 1.0) {
                u = 1.0 - u;
                v = 1.0 - v;
            }
            samples.points.push_back(a + u * ab + v * ac);
            samples.normals.push_back(twice_area.normalized());
        }
    }
    return samples;
}

/// Samples by cells of a grid, for all neighbours within a radius.
class Buckets {
  public:
    Buckets(const Samples& samples, double cell_mm) : samples_(samples), cell_mm_(cell_mm) {
        for (std::size_t i = 0; i < samples.points.size(); ++i) cells_[cell(samples.points[i])].push_back(i);
    }

    /// Calls `visit(j)` for samples within `radius_mm` of sample i on the same side of the wall, until it says stop.
    template <class Visit>
    bool any_within(std::size_t i, double radius_mm, const Visit& visit) const {
        const Vec3& p = samples_.points[i];
        const auto lo = cell(p - Vec3::Constant(radius_mm));
        const auto hi = cell(p + Vec3::Constant(radius_mm));
        for (int x = lo[0]; x <= hi[0]; ++x)
            for (int y = lo[1]; y <= hi[1]; ++y)
                for (int z = lo[2]; z <= hi[2]; ++z) {
                    const auto found = cells_.find({x, y, z});
                    if (found == cells_.end()) continue;
                    for (const std::size_t j : found->second)
                        if ((samples_.points[j] - p).squaredNorm() <= radius_mm * radius_mm &&
                            samples_.normals[j].dot(samples_.normals[i]) > -0.3 && visit(j))
                            return true;
                }
        return false;
    }

  private:
    [[nodiscard]] std::array<int, 3> cell(const Vec3& p) const {
        return {static_cast<int>(std::floor(p[0] / cell_mm_)), static_cast<int>(std::floor(p[1] / cell_mm_)),
                static_cast<int>(std::floor(p[2] / cell_mm_))};
    }

    const Samples& samples_;
    double cell_mm_;
    std::map<std::array<int, 3>, std::vector<std::size_t>> cells_;
};

/// Discs are placed by their samples alone, so the border of a feature is reached up to `slack_mm`.
double uncovered_share(const Samples& samples, const Buckets& buckets, std::uint8_t phase, double radius_mm,
                       double slack_mm, const std::function<bool(const Vec3&)>& counted) {
    const std::size_t n = samples.points.size();
    std::vector<std::uint8_t> center(n, 0);
    parallel_for(n, 256, [&](std::size_t i) {
        center[i] = samples.solid[i] == phase &&
                    !buckets.any_within(i, radius_mm, [&](std::size_t j) { return samples.solid[j] != phase; });
    });
    std::vector<std::uint8_t> covered(n, 0);
    parallel_for(n, 256, [&](std::size_t i) {
        covered[i] = samples.solid[i] == phase &&
                     buckets.any_within(i, radius_mm + slack_mm, [&](std::size_t j) { return center[j] != 0; });
    });
    std::size_t members = 0;
    std::size_t bare = 0;
    for (std::size_t i = 0; i < n; ++i) {
        if (samples.solid[i] != phase || !counted(samples.points[i])) continue;
        ++members;
        if (!covered[i]) ++bare;
    }
    return members == 0 ? 0.0 : static_cast<double>(bare) / static_cast<double>(members);
}

}  // namespace

WidthJudgement judge_widths(const TriangleMesh& surface, const TriangleMesh& carved, double depth_mm, double spacing_mm,
                            double solid_width_mm, double hole_width_mm,
                            const std::function<bool(const Vec3&)>& counted) {
    Samples samples = spread_samples(surface, spacing_mm);
    const SurfaceTree wall(carved);
    const std::size_t n = samples.points.size();
    samples.solid.resize(n);
    parallel_for(n, 64, [&](std::size_t i) {
        samples.solid[i] = wall.inside(samples.points[i] - depth_mm * samples.normals[i]) ? 1 : 0;
    });

    WidthJudgement judgement;
    judgement.samples = n;
    const auto solid = static_cast<double>(std::count(samples.solid.begin(), samples.solid.end(), 1));
    judgement.solid_share = solid / static_cast<double>(n);
    const Buckets buckets(samples, 0.5 * std::max(solid_width_mm, hole_width_mm));
    judgement.too_thin_share = uncovered_share(samples, buckets, 1, 0.5 * solid_width_mm, 2.0 * spacing_mm, counted);
    judgement.too_narrow_share = uncovered_share(samples, buckets, 0, 0.5 * hole_width_mm, 2.0 * spacing_mm, counted);
    return judgement;
}

}  // namespace fretwork::testing
