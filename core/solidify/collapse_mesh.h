// A closed triangle mesh that edges can be collapsed in, from several threads on separate blocks of vertices.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace fretwork {

/// Corner table: corner c = 3 t + k of triangle t; across(c) is the corner of the neighbouring triangle that faces
/// the same edge, the one opposite to c.
class CollapseMesh {
  public:
    using Corner = std::uint32_t;
    static constexpr std::uint32_t kNone = ~std::uint32_t{0};

    /// \param mesh  closed and manifold
    explicit CollapseMesh(const TriangleMesh& mesh);

    [[nodiscard]] const Vec3& position(std::uint32_t v) const { return positions_[v]; }
    [[nodiscard]] std::size_t vertex_count() const { return positions_.size(); }
    [[nodiscard]] bool alive(std::uint32_t v) const { return corner_of_[v] != kNone; }
    [[nodiscard]] const Triangle& triangle(std::uint32_t t) const { return triangles_[t]; }
    [[nodiscard]] std::size_t triangle_slots() const { return triangles_.size(); }
    [[nodiscard]] bool triangle_alive(std::uint32_t t) const { return triangles_[t][0] != kNone; }

    static Corner next(Corner c) { return c % 3 == 2 ? c - 2 : c + 1; }
    static Corner previous(Corner c) { return c % 3 == 0 ? c + 2 : c - 1; }
    [[nodiscard]] std::uint32_t vertex(Corner c) const { return triangles_[c / 3][c % 3]; }

    /// The corners at v, in turn around it.
    void corners_around(std::uint32_t v, std::vector<Corner>& corners) const;

    /// Whether merging u into v keeps the mesh a manifold: their common neighbours are the two apexes of the edge,
    /// and neither apex has only three neighbours.
    /// \param around_u  corners at u; \param edge  the one of them whose next corner is at v
    [[nodiscard]] bool may_collapse(const std::vector<Corner>& around_u, Corner edge) const;

    /// Merges u into v. Both triangles of the edge die; those left of u's get v.
    void collapse(const std::vector<Corner>& around_u, Corner edge);

    [[nodiscard]] TriangleMesh extract() const;

  private:
    [[nodiscard]] bool degree_at_least_four(Corner c) const;
    void link(Corner a, Corner b);

    std::vector<Vec3> positions_;
    std::vector<Triangle> triangles_;
    std::vector<Corner> across_;
    std::vector<Corner> corner_of_;
};

}  // namespace fretwork
