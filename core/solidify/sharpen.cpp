#include "core/solidify/sharpen.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <utility>

#include "core/base/float_rounding.h"
#include "core/base/parallel.h"
#include "core/mesh/self_intersections.h"
#include "core/solidify/vertex_normals.h"

namespace fretwork {
namespace {

constexpr int kRounds = 16;

/// Shares of its way that a vertex goes: all of it, or less where that makes triangles meet or turn over.
constexpr std::array<double, 4> kShares = {0.0, 0.3, 0.65, 1.0};
constexpr std::uint8_t kWholeWay = kShares.size() - 1;

/// Moves shorter than this, in voxels, are not worth a check.
constexpr double kShortest = 0.01;

/// After a move a triangle may have turned by up to this against its old self.
constexpr double kTurnCosine = -0.2;

class Sharpener {
  public:
    Sharpener(const WallMesh& wall, double voxel_mm, const RunControl& run)
        : wall_(wall), voxel_mm_(voxel_mm), run_(run), step_(wall.vertices.size(), 0) {
        mesh_.triangles = wall.triangles;
        mesh_.positions_mm.resize(wall.vertices.size());
        parallel_for(wall.vertices.size(), 1 << 14, [&](std::size_t v) {
            const auto length = static_cast<double>(wall.vertices[v].to_target_mm.norm());
            step_[v] = length > kShortest * voxel_mm ? kWholeWay : 0;
            place(v);
        });
    }

    TriangleMesh run() {
        take_back_flips();
        std::vector<std::uint32_t> changed = triangles_at([&](std::uint32_t v) { return step_[v] != 0; });
        for (int round = 0; round < kRounds && !changed.empty(); ++round) {
            run_.throw_if_stopped();
            std::vector<std::uint8_t> back = corners_of_meetings(changed);
            const bool last = round + 1 == kRounds &&
                              std::count(back.begin(), back.end(), 0) < static_cast<std::ptrdiff_t>(back.size());
            for (std::size_t v = 0; v < step_.size(); ++v) {
                if (last && step_[v] != 0) {
                    step_[v] = 0;
                    place(v);
                }
                if (back[v] != 0) take_back(v);
            }
            changed = triangles_at([&](std::uint32_t v) { return back[v] != 0; });
        }
        return std::move(mesh_);
    }

  private:
    void place(std::size_t v) {
        const WallVertex& vertex = wall_.vertices[v];
        mesh_.positions_mm[v] =
            rounded_to_float(vertex.position_mm + kShares[step_[v]] * vertex.to_target_mm.cast<double>());
    }

    void take_back(std::size_t v) {
        if (step_[v] == 0) return;
        --step_[v];
        place(v);
    }

    [[nodiscard]] bool touched(const Triangle& t) const {
        return step_[t[0]] != 0 || step_[t[1]] != 0 || step_[t[2]] != 0;
    }

    /// The one of some vertices that is farthest from where the lattice put it.
    [[nodiscard]] std::uint32_t farthest_moved(std::initializer_list<Triangle> triangles) const {
        std::uint32_t farthest = (*triangles.begin())[0];
        double most = -1.0;
        for (const Triangle& t : triangles)
            for (const std::uint32_t v : t) {
                const double move = kShares[step_[v]] * static_cast<double>(wall_.vertices[v].to_target_mm.norm());
                if (move <= most) continue;
                most = move;
                farthest = v;
            }
        return farthest;
    }

    void take_back_flips() {
        std::vector<std::uint32_t> suspects = triangles_at([&](std::uint32_t v) { return step_[v] != 0; });
        while (!suspects.empty()) {
            run_.throw_if_stopped();
            std::vector<std::uint8_t> corner(step_.size(), 0), back(step_.size(), 0);
            for (const std::uint32_t t : suspects)
                for (const std::uint32_t v : mesh_.triangles[t]) corner[v] = 1;
            const std::vector<Vec3f> sums = normal_sums(mesh_, corner);
            for (const std::uint32_t t : suspects)
                if (touched(mesh_.triangles[t]) &&
                    (turned_over(mesh_.triangles[t]) || folded(mesh_, mesh_.triangles[t], sums)))
                    back[farthest_moved({mesh_.triangles[t]})] = 1;
            for (std::size_t v = 0; v < back.size(); ++v)
                if (back[v] != 0) take_back(v);
            suspects = triangles_at([&](std::uint32_t v) { return back[v] != 0; });
        }
    }

    [[nodiscard]] bool turned_over(const Triangle& t) const {
        const auto normal = [&](const auto& at) { return Vec3((at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0]))); };
        const Vec3 before = normal([&](std::uint32_t v) { return wall_.vertices[v].position_mm; });
        const Vec3 after = normal([&](std::uint32_t v) { return mesh_.positions_mm[v]; });
        const bool flat = !(after.norm() > 1e-5 * voxel_mm_ * voxel_mm_);
        return flat || before.dot(after) < kTurnCosine * before.norm() * after.norm();
    }

    template <class Wanted>
    [[nodiscard]] std::vector<std::uint32_t> triangles_at(const Wanted& wanted) const {
        std::vector<std::uint32_t> chosen;
        for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
            const Triangle& k = mesh_.triangles[t];
            if (wanted(k[0]) || wanted(k[1]) || wanted(k[2])) chosen.push_back(t);
        }
        return chosen;
    }

    /// Per vertex: 1 if of the corners of two triangles that meet it has moved farthest. Triangles that are as the
    /// lattice made them do not meet, so that it suffices to look at those that changed.
    [[nodiscard]] std::vector<std::uint8_t> corners_of_meetings(const std::vector<std::uint32_t>& changed) const {
        std::vector<std::uint8_t> corner(step_.size(), 0);
        for (const auto& [a, b] : find_self_intersections_among(mesh_, changed, run_)) {
            const std::uint32_t v = farthest_moved({mesh_.triangles[a], mesh_.triangles[b]});
            corner[v] = step_[v] != 0 ? 1 : 0;
        }
        return corner;
    }

    const WallMesh& wall_;
    double voxel_mm_;
    const RunControl& run_;
    std::vector<std::uint8_t> step_;  ///< per vertex: index into kShares
    TriangleMesh mesh_;
};

}  // namespace

TriangleMesh sharpened_mesh(const WallMesh& wall, double voxel_mm, const RunControl& run) {
    return Sharpener(wall, voxel_mm, run).run();
}

}  // namespace fretwork
