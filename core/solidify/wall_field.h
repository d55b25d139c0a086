// The wall as an implicit function: negative inside the material.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/mesh/closest_point.h"
#include "core/mesh/triangle_mesh.h"
#include "core/solidify/pattern_field.h"

namespace fretwork {

/// Which of the wall's surfaces is the nearest to be crossed.
enum class WallFace : std::uint8_t {
    kUpper,    ///< phi = upper: the outer face
    kLower,    ///< phi = lower: the inner face
    kPattern,  ///< the side of a hole
};

/// f = max(phi - upper, lower - phi, pattern), in voxels.
struct WallLimits {
    double lower = -2.0;
    double upper = 0.0;
    bool signed_distance = true;  ///< false for open surfaces: phi is the plain distance and lower is minus infinity

    [[nodiscard]] double slab(double phi) const { return std::max(phi - upper, lower - phi); }
    /// One of the wall's faces is the input surface itself.
    [[nodiscard]] bool touches_surface() const { return upper == 0.0 || lower == 0.0; }
};

/// Everything about one point near the surface.
struct WallSample {
    double phi = 0.0;
    double pattern = 0.0;
    Vec3 closest_mm = Vec3::Zero();
    std::uint32_t triangle = 0;
    bool found = false;
};

class WallField {
  public:
    WallField(const TriangleMesh& mesh, const SurfaceTree& tree, const PatternField& pattern, double voxel_mm,
              const WallLimits& limits);

    [[nodiscard]] const WallLimits& limits() const { return limits_; }
    [[nodiscard]] const SurfaceTree& tree() const { return tree_; }
    [[nodiscard]] double voxel_mm() const { return voxel_mm_; }
    /// Farther from the surface than this no node can be next to the wall, in voxels.
    [[nodiscard]] double reach_voxels() const { return reach_voxels_; }
    [[nodiscard]] const Vec3& triangle_normal(std::uint32_t triangle) const { return normals_[triangle]; }

    [[nodiscard]] double pattern_at(const Vec3& surface_point_mm, std::uint32_t triangle) const {
        return pattern_.signed_distance_voxels(surface_point_mm, triangle);
    }

    /// The point of one triangle that is closest to p.
    [[nodiscard]] Vec3 closest_on(std::uint32_t triangle, const Vec3& p) const;

    /// A little more than the longest edge of a Kuhn tetrahedron, in voxels: phi changes by no more along an edge.
    [[nodiscard]] static double longest_edge() { return 1.75; }

    /// \param sign  of phi, where the caller knows it; 0: from the side of the closest triangle
    /// \param hint  a triangle that is likely near, which saves time and changes nothing
    /// \param reach_voxels  the surface is known to be no farther, which saves time; 0: not known
    [[nodiscard]] WallSample sample(const Vec3& point_mm, double sign, std::uint32_t hint,
                                    double reach_voxels = 0.0) const;
    /// The same where the pattern is known to be so far from its border that its value does not matter.
    [[nodiscard]] WallSample sample_slab(const Vec3& point_mm, double sign, std::uint32_t hint, double reach_voxels,
                                         double pattern) const;
    /// Between two nodes of one edge that are both this deep in solid the pattern does not change sign.
    [[nodiscard]] static double surely_solid() { return -2.0; }

    [[nodiscard]] double value(const WallSample& s) const { return std::max(limits_.slab(s.phi), s.pattern); }
    [[nodiscard]] WallFace face(double phi, double pattern) const {
        const double up = phi - limits_.upper, down = limits_.lower - phi;
        if (pattern >= up && pattern >= down) return WallFace::kPattern;
        return up >= down ? WallFace::kUpper : WallFace::kLower;
    }

  private:
    const TriangleMesh& mesh_;
    const SurfaceTree& tree_;
    const PatternField& pattern_;
    double voxel_mm_;
    WallLimits limits_;
    double reach_voxels_;
    std::vector<Vec3> normals_;
};

}  // namespace fretwork
