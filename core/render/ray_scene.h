// What a ray meets first, and whether it meets anything.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "core/base/run_control.h"
#include "core/base/vec.h"
#include "core/mesh/triangle_mesh.h"

namespace fretwork {

/// Rays against triangles with Embree, in float, watertight along shared edges. Coordinates are scaled to a model whose
/// bounding box has a half diagonal of 1 around the origin; `to_scene` leads there. Thread-safe once built.
class RayScene {
  public:
    RayScene(const TriangleMesh& mesh, const RunControl& run);
    ~RayScene();
    RayScene(const RayScene&) = delete;
    RayScene& operator=(const RayScene&) = delete;

    struct Hit {
        std::uint32_t triangle;
        float distance;
        float u, v;          ///< weights of the second and third corner
        Vec3f facet_normal;  ///< unit length, towards where the ray came from
    };

    [[nodiscard]] std::optional<Hit> first_hit(const Vec3f& origin, const Vec3f& direction) const;
    [[nodiscard]] bool is_blocked(const Vec3f& origin, const Vec3f& direction) const;

    [[nodiscard]] Vec3 to_scene(const Vec3& point_mm) const { return (point_mm - center_mm_) / half_diagonal_mm_; }

  private:
    struct Embree;
    std::unique_ptr<Embree> embree_;
    Vec3 center_mm_;
    double half_diagonal_mm_;
};

}  // namespace fretwork
