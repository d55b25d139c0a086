// A closed triangle mesh that edges can be collapsed in, from several threads on separate blocks of vertices.
#pragma once

#include <array>
#include <cstdint>
#include <span>
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
    [[nodiscard]] const std::vector<Vec3>& positions() const { return positions_; }
    [[nodiscard]] std::size_t vertex_count() const { return positions_.size(); }
    [[nodiscard]] bool alive(std::uint32_t v) const { return corner_of_[v] != kNone; }
    [[nodiscard]] const Triangle& triangle(std::uint32_t t) const { return triangles_[t]; }
    [[nodiscard]] std::size_t triangle_slots() const { return triangles_.size(); }
    [[nodiscard]] bool triangle_alive(std::uint32_t t) const { return dead_[t] == 0; }

    static Corner next(Corner c) { return c % 3 == 2 ? c - 2 : c + 1; }
    static Corner previous(Corner c) { return c % 3 == 0 ? c + 2 : c - 1; }
    [[nodiscard]] std::uint32_t vertex(Corner c) const { return triangles_[c / 3][c % 3]; }

    /// The corner at the same vertex in the triangle across the edge to the previous corner's vertex.
    [[nodiscard]] Corner turned(Corner c) const { return next(across_[next(c)]); }

    /// The corners at v, in turn around it.
    void corners_around(std::uint32_t v, std::vector<Corner>& corners) const;

    /// Whether merging u into v keeps the mesh a manifold: their common neighbours are the two apexes of the edge,
    /// and neither apex has only three neighbours.
    /// \param around_u  corners at u; \param edge  the one of them whose next corner is at v
    [[nodiscard]] bool may_collapse(const std::vector<Corner>& around_u, Corner edge) const;

    /// Merges u into v. Both triangles of the edge die; those left of u's get v.
    void collapse(const std::vector<Corner>& around_u, Corner edge);

    /// Takes a collapse back. Everything it touched, see `touched_by`, must be as it left it.
    /// \param edge  as it was collapsed; \param stayed  the corners at u that became corners at v
    void undo(Corner edge, std::span<const Corner> stayed);

    /// The triangles a collapse changed, besides those of the corners that `stayed`: the two that died and the two
    /// beyond them at v.
    [[nodiscard]] std::array<std::uint32_t, 4> touched_by(Corner edge) const;

    /// The other triangle that died with the one of `edge`: its corner that faced the edge.
    [[nodiscard]] Corner facing(Corner edge) const { return across_[previous(edge)]; }

  private:
    [[nodiscard]] bool degree_at_least_four(Corner c) const;
    void link_partners(std::span<const Corner> filed);
    void link(Corner a, Corner b);

    std::vector<Vec3> positions_;
    std::vector<Triangle> triangles_;
    std::vector<Corner> across_;  ///< a dead triangle keeps what it had when it died
    std::vector<Corner> corner_of_;
    std::vector<std::uint8_t> dead_;
};

}  // namespace fretwork
