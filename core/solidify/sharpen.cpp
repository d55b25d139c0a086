#include "core/solidify/sharpen.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/base/float_rounding.h"
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
        for (std::size_t v = 0; v < wall.vertices.size(); ++v) {
            const auto length = static_cast<double>(wall.vertices[v].to_target_mm.norm());
            moved_[v] = length > kShortest * voxel_mm ? 1 : 0;
            place(v);
        }
    }

    TriangleMesh run() {
        take_back_flips();
        for (int round = 0; round < kRounds; ++round) {
            run_.throw_if_stopped();
            const bool last = round + 1 == kRounds;
            if (!take_back_meetings()) break;
            if (last)
                for (std::size_t v = 0; v < moved_.size(); ++v) take_back(v);
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

    /// Triangles near moved ones: those with a corner in a cell next to a cell of a moved triangle's corner.
    [[nodiscard]] std::vector<std::uint32_t> triangles_to_check() const {
        std::vector<std::uint64_t> cells;
        const auto key = [&](const Vec3& p, int dx, int dy, int dz) {
            const auto part = [&](double x, int d) {
                return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(x / voxel_mm_)) + d +
                                                  (1 << 20)) &
                       0x1FFFFFU;
            };
            return (part(p[2], dz) << 42) | (part(p[1], dy) << 21) | part(p[0], dx);
        };
        for (std::size_t v = 0; v < moved_.size(); ++v) {
            if (moved_[v] == 0) continue;
            for (int i = 0; i < 27; ++i)
                cells.push_back(key(mesh_.positions_mm[v], i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1));
        }
        std::sort(cells.begin(), cells.end());
        cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
        std::vector<std::uint8_t> near(moved_.size());
        for (std::size_t v = 0; v < near.size(); ++v)
            near[v] = std::binary_search(cells.begin(), cells.end(), key(mesh_.positions_mm[v], 0, 0, 0)) ? 1 : 0;
        std::vector<std::uint32_t> chosen;
        for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t)
            for (const std::uint32_t v : mesh_.triangles[t])
                if (near[v] != 0) {
                    chosen.push_back(t);
                    break;
                }
        return chosen;
    }

    bool take_back_meetings() {
        const std::vector<std::uint32_t> chosen = triangles_to_check();
        TriangleMesh part;
        part.positions_mm = mesh_.positions_mm;
        for (const std::uint32_t t : chosen) part.triangles.push_back(mesh_.triangles[t]);
        bool changed = false;
        for (const auto& [a, b] : find_self_intersections(part, run_))
            for (const std::uint32_t t : {a, b})
                for (const std::uint32_t v : part.triangles[t]) {
                    changed = changed || moved_[v] != 0;
                    take_back(v);
                }
        return changed;
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
