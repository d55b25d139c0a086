#include "support/block_mesh.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>

namespace fretwork::testing {
namespace {

using Index3 = std::array<int, 3>;

class Builder {
  public:
    Builder(const BlockLattice& lattice, const std::function<Block(const Index3&)>& block)
        : lattice_(lattice), block_(block) {}

    TriangleMesh build() {
        Index3 b{};
        for (b[2] = 0; b[2] < gaps(2); ++b[2])
            for (b[1] = 0; b[1] < gaps(1); ++b[1])
                for (b[0] = 0; b[0] < gaps(0); ++b[0]) add_block(b);
        return std::move(mesh_);
    }

  private:
    [[nodiscard]] int gaps(int axis) const { return static_cast<int>(lattice_.cells[at(axis)].size()); }
    static std::size_t at(int i) { return static_cast<std::size_t>(i); }

    [[nodiscard]] bool filled(const Index3& b) const {
        for (int axis = 0; axis < 3; ++axis)
            if (b[at(axis)] < 0 || b[at(axis)] >= gaps(axis)) return false;
        return block_(b).filled;
    }

    void add_block(const Index3& b) {
        const Block block = block_(b);
        if (!block.filled) return;
        for (int axis = 0; axis < 3; ++axis)
            for (int side = 0; side < 2; ++side) {
                Index3 beyond = b;
                beyond[at(axis)] += side == 0 ? -1 : 1;
                if (!filled(beyond)) add_face(b, axis, side, block.drill_axis == axis);
            }
        if (block.drill_axis >= 0) add_hole_wall(b, block.drill_axis);
    }

    /// Position `step` cells past plane `gap`; the same number wherever it is asked for.
    [[nodiscard]] double line(int axis, int gap, int step) const {
        const std::vector<double>& lines = lattice_.lines_mm[at(axis)];
        const int cells = lattice_.cells[at(axis)][at(gap)];
        if (step == cells) return lines[at(gap) + 1];
        return lines[at(gap)] + (lines[at(gap) + 1] - lines[at(gap)]) * step / cells;
    }

    std::uint32_t vertex(int axis, double w, double u, double v) {
        std::array<double, 3> p{};
        p[at(axis)] = w;
        p[at((axis + 1) % 3)] = u;
        p[at((axis + 2) % 3)] = v;
        const auto [found, fresh] = vertices_.try_emplace(p, static_cast<std::uint32_t>(mesh_.positions_mm.size()));
        if (fresh) mesh_.positions_mm.emplace_back(p[0], p[1], p[2]);
        return found->second;
    }

    /// Corners counter-clockwise seen from +axis; turned round on request. A list, because compilers number the
    /// vertices of arguments in orders of their own.
    void quad(std::array<std::uint32_t, 4> corners, bool turned) {
        auto& [a, b, c, d] = corners;
        if (turned) std::swap(b, d);
        mesh_.triangles.push_back({a, b, c});
        mesh_.triangles.push_back({a, c, d});
    }

    void add_face(const Index3& b, int axis, int side, bool drilled) {
        const int u_axis = (axis + 1) % 3, v_axis = (axis + 2) % 3;
        const int bu = b[at(u_axis)], bv = b[at(v_axis)];
        const double w = lattice_.lines_mm[at(axis)][at(b[at(axis)] + side)];
        if (drilled) return add_holed_face(b, axis, w, side == 0);
        for (int j = 0; j < lattice_.cells[at(v_axis)][at(bv)]; ++j)
            for (int i = 0; i < lattice_.cells[at(u_axis)][at(bu)]; ++i) {
                const double u0 = line(u_axis, bu, i), u1 = line(u_axis, bu, i + 1);
                const double v0 = line(v_axis, bv, j), v1 = line(v_axis, bv, j + 1);
                quad({vertex(axis, w, u0, v0), vertex(axis, w, u1, v0), vertex(axis, w, u1, v1),
                      vertex(axis, w, u0, v1)},
                     side == 0);
            }
    }

    /// Point `i` of 4k round the border of the block's face, counter-clockwise from the low corner.
    [[nodiscard]] Vec2 border_point(const Index3& b, int axis, int i) const {
        const int u_axis = (axis + 1) % 3, v_axis = (axis + 2) % 3;
        const int bu = b[at(u_axis)], bv = b[at(v_axis)];
        const int k = lattice_.cells[at(u_axis)][at(bu)];
        const int along = i % k;
        switch ((i / k) % 4) {
            case 0:
                return {line(u_axis, bu, along), line(v_axis, bv, 0)};
            case 1:
                return {line(u_axis, bu, k), line(v_axis, bv, along)};
            case 2:
                return {line(u_axis, bu, k - along), line(v_axis, bv, k)};
            default:
                return {line(u_axis, bu, 0), line(v_axis, bv, k - along)};
        }
    }

    [[nodiscard]] Vec2 circle_point(const Index3& b, int axis, int i) const {
        const int u_axis = (axis + 1) % 3, v_axis = (axis + 2) % 3;
        const int bu = b[at(u_axis)], bv = b[at(v_axis)];
        const int k = lattice_.cells[at(u_axis)][at(bu)];
        const Vec2 center(0.5 * (line(u_axis, bu, 0) + line(u_axis, bu, k)),
                          0.5 * (line(v_axis, bv, 0) + line(v_axis, bv, k)));
        const double angle = 2.0 * std::numbers::pi * (i % (4 * k)) / (4 * k) - 0.75 * std::numbers::pi;
        return center + lattice_.hole_radius_mm * Vec2(std::cos(angle), std::sin(angle));
    }

    void add_holed_face(const Index3& b, int axis, double w, bool turned) {
        const int k = lattice_.cells[at((axis + 1) % 3)][at(b[at((axis + 1) % 3)])];
        const int rings = 2;
        const auto corner = [&](int i, int ring) {
            const Vec2 outer = border_point(b, axis, i), inner = circle_point(b, axis, i);
            const Vec2 p = ring == 0 ? outer : ring == rings ? inner : Vec2(outer + (inner - outer) * ring / rings);
            return vertex(axis, w, p[0], p[1]);
        };
        for (int i = 0; i < 4 * k; ++i)
            for (int ring = 0; ring < rings; ++ring)
                quad({corner(i, ring), corner(i + 1, ring), corner(i + 1, ring + 1), corner(i, ring + 1)}, turned);
    }

    void add_hole_wall(const Index3& b, int axis) {
        const int k = lattice_.cells[at((axis + 1) % 3)][at(b[at((axis + 1) % 3)])];
        const int gap = b[at(axis)];
        for (int step = 0; step < lattice_.cells[at(axis)][at(gap)]; ++step) {
            const double low = line(axis, gap, step), high = line(axis, gap, step + 1);
            for (int i = 0; i < 4 * k; ++i) {
                const Vec2 p = circle_point(b, axis, i), q = circle_point(b, axis, i + 1);
                quad({vertex(axis, low, q[0], q[1]), vertex(axis, low, p[0], p[1]), vertex(axis, high, p[0], p[1]),
                      vertex(axis, high, q[0], q[1])},
                     false);
            }
        }
    }

    const BlockLattice& lattice_;
    const std::function<Block(const Index3&)>& block_;
    TriangleMesh mesh_;
    std::map<std::array<double, 3>, std::uint32_t> vertices_;
};

}  // namespace

TriangleMesh block_mesh(const BlockLattice& lattice, const std::function<Block(const std::array<int, 3>&)>& block) {
    return Builder(lattice, block).build();
}

}  // namespace fretwork::testing
