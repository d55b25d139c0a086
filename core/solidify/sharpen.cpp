#include "core/solidify/sharpen.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/float_rounding.h"
#include "core/base/parallel.h"
#include "core/mesh/self_intersections.h"

namespace fretwork {
namespace {

constexpr int kRounds = 6;

/// Moves shorter than this, in voxels, are not worth a check.
constexpr double kShortest = 0.01;

/// After a move a triangle may have turned by up to this against its old self.
constexpr double kTurnCosine = -0.2;

class Sharpener {
  public:
    Sharpener(const WallMesh& wall, double voxel_mm, const RunControl& run)
        : wall_(wall), voxel_mm_(voxel_mm), run_(run), moved_(wall.vertices.size(), 0) {
        mesh_.triangles = wall.triangles;
        mesh_.positions_mm.resize(wall.vertices.size());
        parallel_for(wall.vertices.size(), 1 << 14, [&](std::size_t v) {
            const auto length = static_cast<double>(wall.vertices[v].to_target_mm.norm());
            moved_[v] = length > kShortest * voxel_mm ? 1 : 0;
            place(v);
        });
    }

    TriangleMesh run() {
        take_back_flips();
        std::vector<std::uint32_t> changed = triangles_at([&](std::uint32_t v) { return moved_[v] != 0; });
        for (int round = 0; round < kRounds && !changed.empty(); ++round) {
            run_.throw_if_stopped();
            std::vector<std::uint8_t> back = corners_of_meetings(changed);
            if (round + 1 == kRounds && std::count(back.begin(), back.end(), 1) > 0) back = moved_;
            for (std::size_t v = 0; v < moved_.size(); ++v)
                if (back[v] != 0) take_back(v);
            changed = triangles_at([&](std::uint32_t v) { return back[v] != 0; });
        }
        return std::move(mesh_);
    }

  private:
    void place(std::size_t v) {
        const WallVertex& vertex = wall_.vertices[v];
        const Vec3 move = moved_[v] != 0 ? Vec3(vertex.to_target_mm.cast<double>()) : Vec3(Vec3::Zero());
        mesh_.positions_mm[v] = rounded_to_float(vertex.position_mm + move);
    }

    void take_back(std::size_t v) {
        if (moved_[v] == 0) return;
        moved_[v] = 0;
        place(v);
    }

    [[nodiscard]] bool touched(const Triangle& t) const {
        return moved_[t[0]] != 0 || moved_[t[1]] != 0 || moved_[t[2]] != 0;
    }

    void take_back_flips() {
        std::vector<std::uint32_t> bad;
        for (const Triangle& t : mesh_.triangles) {
            if (!touched(t)) continue;
            const auto normal = [&](const auto& at) { return Vec3((at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0]))); };
            const Vec3 before = normal([&](std::uint32_t v) { return wall_.vertices[v].position_mm; });
            const Vec3 after = normal([&](std::uint32_t v) { return mesh_.positions_mm[v]; });
            const bool flat = !(after.norm() > 1e-5 * voxel_mm_ * voxel_mm_);
            if (flat || before.dot(after) < kTurnCosine * before.norm() * after.norm())
                bad.insert(bad.end(), t.begin(), t.end());
        }
        for (const std::uint32_t v : bad) take_back(v);
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

    /// Per vertex: whether it has moved and is a corner of a triangle that meets another. Triangles that are as the
    /// lattice made them do not meet, so that it suffices to look at those that changed.
    [[nodiscard]] std::vector<std::uint8_t> corners_of_meetings(const std::vector<std::uint32_t>& changed) const {
        std::vector<std::uint8_t> corner(moved_.size(), 0);
        for (const auto& [a, b] : find_self_intersections_among(mesh_, changed, run_))
            for (const std::uint32_t t : {a, b})
                for (const std::uint32_t v : mesh_.triangles[t]) corner[v] = moved_[v];
        return corner;
    }

    const WallMesh& wall_;
    double voxel_mm_;
    const RunControl& run_;
    std::vector<std::uint8_t> moved_;
    TriangleMesh mesh_;
};

}  // namespace

TriangleMesh sharpened_mesh(const WallMesh& wall, double voxel_mm, const RunControl& run) {
    return Sharpener(wall, voxel_mm, run).run();
}

}  // namespace fretwork
