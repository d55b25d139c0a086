#include "core/solidify/marching_tets.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>

#include "core/base/parallel.h"
#include "core/solidify/edge_root.h"
#include "core/solidify/feature_point.h"
#include "core/solidify/kuhn_cell.h"

namespace fretwork {
namespace {

constexpr std::size_t kBlocksPerChunk = 8;

/// Corner vertices are numbered within their chunk until all chunks are known.
constexpr std::uint32_t kCornerFlag = 0x80000000U;

class TetMarcher {
  public:
    TetMarcher(const WallLattice& lattice, const NodeValues& values, const WallField& field, double clamp,
               const RunControl& run)
        : lattice_(lattice), values_(values), field_(field), clamp_(clamp), run_(run) {}

    WallMesh march() {
        count_edges();
        place_edge_vertices();
        place_triangle_vertices();
        return join(make_triangles());
    }

  private:
    struct Chunk {
        std::vector<WallVertex> corners;
        std::vector<Triangle> triangles;
    };

    [[nodiscard]] bool inside(NodeIndex node) const {
        if (node == WallLattice::kNone) return false;
        return std::max(field_.limits().slab(static_cast<double>(values_.phi[node])),
                        static_cast<double>(values_.pattern[node])) < 0.0;
    }

    [[nodiscard]] EdgeEnd end_at(NodeIndex node, const NodeCoord& c) const {
        return {lattice_.position_mm(c), static_cast<double>(values_.phi[node]),
                static_cast<double>(values_.pattern[node]), values_.triangle[node]};
    }

    static NodeCoord shifted(const NodeCoord& c, unsigned mask) {
        return {c[0] + static_cast<std::int32_t>(mask & 1U), c[1] + static_cast<std::int32_t>((mask >> 1) & 1U),
                c[2] + static_cast<std::int32_t>((mask >> 2) & 1U)};
    }

    /// Calls visit(node, coordinate, its cell's corners) for the nodes of a chunk whose cell the wall's surface
    /// crosses; a chunk's result does not depend on the others.
    template <class Visit>
    void for_each_crossed_cell(std::size_t begin, std::size_t end, const Visit& visit) const {
        for (std::size_t i = begin; i < end; ++i) {
            const auto node = static_cast<NodeIndex>(i);
            if (cell_crossed_[node] == 0) continue;
            const NodeCoord c = lattice_.coord(node);
            std::array<NodeIndex, 8> corner{};
            for (unsigned m = 0; m < 8; ++m) corner[m] = lattice_.upper(node, c, m);
            visit(node, c, corner);
        }
    }

    void count_edges() {
        const std::size_t n = lattice_.node_count();
        is_inside_.assign(n, 0);
        parallel_for(n, 1 << 16, [&](std::size_t i) { is_inside_[i] = inside(static_cast<NodeIndex>(i)) ? 1 : 0; });
        cell_crossed_.assign(n, 0);
        edge_mask_.assign(n, 0);
        edge_first_.assign(n + 1, 0);
        parallel_chunks(n, WallLattice::kBlockNodes * kBlocksPerChunk, [&](std::size_t begin, std::size_t end) {
            run_.throw_if_stopped();
            for (std::size_t i = begin; i < end; ++i) {
                const auto node = static_cast<NodeIndex>(i);
                const NodeCoord c = lattice_.coord(node);
                std::uint8_t mask = 0;
                unsigned insides = is_inside_[node];
                for (unsigned m = 1; m < 8; ++m) {
                    const NodeIndex up = lattice_.upper(node, c, m);
                    const std::uint8_t up_inside = up == WallLattice::kNone ? 0 : is_inside_[up];
                    insides += up_inside;
                    if (up != WallLattice::kNone && up_inside != is_inside_[node])
                        mask = static_cast<std::uint8_t>(mask | (1U << m));
                }
                edge_mask_[node] = mask;
                cell_crossed_[node] = insides > 0 && insides < 8 ? 1 : 0;
                edge_first_[i + 1] = static_cast<std::uint32_t>(std::popcount(mask));
            }
        });
        for (std::size_t i = 0; i < n; ++i) edge_first_[i + 1] += edge_first_[i];
    }

    [[nodiscard]] std::uint32_t edge_vertex(NodeIndex node, unsigned direction) const {
        const auto below = static_cast<unsigned>(edge_mask_[node]) & ((1U << direction) - 1U);
        return edge_first_[node] + static_cast<std::uint32_t>(std::popcount(below));
    }

    void place_edge_vertices() {
        const std::size_t n = lattice_.node_count();
        vertices_.resize(edge_first_[n]);
        parallel_chunks(n, WallLattice::kBlockNodes, [&](std::size_t begin, std::size_t end) {
            if (edge_first_[begin] == edge_first_[end]) return;
            run_.throw_if_stopped();
            for (std::size_t i = begin; i < end; ++i) {
                const auto node = static_cast<NodeIndex>(i);
                if (edge_mask_[node] == 0) continue;
                const NodeCoord c = lattice_.coord(node);
                const EdgeEnd low = end_at(node, c);
                for (unsigned m = 1; m < 8; ++m) {
                    if (((edge_mask_[node] >> m) & 1U) == 0) continue;
                    const EdgeEnd high = end_at(lattice_.upper(node, c, m), shifted(c, m));
                    vertices_[edge_vertex(node, m)] = is_inside_[node] != 0 ? edge_root(field_, low, high, clamp_)
                                                                            : edge_root(field_, high, low, clamp_);
                }
            }
        });
    }

    /// The two vertices on the sides of a crossed lattice triangle.
    [[nodiscard]] std::array<std::uint32_t, 2> side_vertices(const std::array<NodeIndex, 8>& corner,
                                                             const std::array<unsigned, 3>& mask) const {
        std::array<std::uint32_t, 2> found{};
        std::size_t count = 0;
        for (const auto& [p, q] : {std::pair{0U, 1U}, {0U, 2U}, {1U, 2U}}) {
            const NodeIndex a = corner[mask[p]], b = corner[mask[q]];
            if (is_inside_[a] != is_inside_[b] && count < 2) found[count++] = edge_vertex(a, mask[q] ^ mask[p]);
        }
        return found;
    }

    void place_triangle_vertices() {
        const std::size_t n = lattice_.node_count();
        constexpr std::size_t grain = WallLattice::kBlockNodes * kBlocksPerChunk;
        triangle_mask_.assign(n, 0);
        triangle_first_.assign(n + 1, 0);
        std::vector<std::vector<WallVertex>> found((n + grain - 1) / grain);
        parallel_chunks(n, grain, [&](std::size_t begin, std::size_t end) {
            for_each_crossed_cell(begin, end, [&](NodeIndex node, const NodeCoord& c, const auto& corner) {
                run_.throw_if_stopped();
                for (unsigned t = 0; t < kuhn::kTriangles.size(); ++t) {
                    const std::array<unsigned, 3> mask = {0, kuhn::kTriangles[t].middle, kuhn::kTriangles[t].top};
                    const std::optional<WallVertex> v = triangle_feature(c, corner, mask);
                    if (!v) continue;
                    triangle_mask_[node] = static_cast<std::uint16_t>(triangle_mask_[node] | (1U << t));
                    found[begin / grain].push_back(*v);
                    ++triangle_first_[node + 1];
                }
            });
        });
        triangle_first_[0] = static_cast<std::uint32_t>(vertices_.size());
        for (std::size_t i = 0; i < n; ++i) triangle_first_[i + 1] += triangle_first_[i];
        for (const std::vector<WallVertex>& part : found) vertices_.insert(vertices_.end(), part.begin(), part.end());
    }

    [[nodiscard]] std::optional<WallVertex> triangle_feature(const NodeCoord& c, const std::array<NodeIndex, 8>& corner,
                                                             const std::array<unsigned, 3>& mask) const {
        unsigned insides = 0;
        for (const unsigned m : mask) {
            if (corner[m] == WallLattice::kNone) return std::nullopt;
            insides += is_inside_[corner[m]];
        }
        if (insides == 0 || insides == 3) return std::nullopt;
        const auto [a, b] = side_vertices(corner, mask);
        if (!edge_runs_between(vertices_[a], vertices_[b])) return std::nullopt;
        std::array<EdgeEnd, 3> ends;
        for (std::size_t k = 0; k < 3; ++k) ends[k] = end_at(corner[mask[k]], shifted(c, mask[k]));
        return feature_on_triangle(field_, ends, vertices_[a], vertices_[b], clamp_);
    }

    /// The vertex inside a lattice triangle of this cell, if it has one. Masks are sorted by inclusion.
    [[nodiscard]] std::optional<std::uint32_t> triangle_vertex(const std::array<NodeIndex, 8>& corner,
                                                               const std::array<unsigned, 3>& mask) const {
        const NodeIndex node = corner[mask[0]];
        const unsigned type =
            kuhn::triangle_type(static_cast<kuhn::Mask>(mask[1] ^ mask[0]), static_cast<kuhn::Mask>(mask[2] ^ mask[0]));
        if (((triangle_mask_[node] >> type) & 1U) == 0) return std::nullopt;
        const auto below = static_cast<unsigned>(triangle_mask_[node]) & ((1U << type) - 1U);
        return triangle_first_[node] + static_cast<std::uint32_t>(std::popcount(below));
    }

    std::vector<Chunk> make_triangles() const {
        const std::size_t n = lattice_.node_count();
        constexpr std::size_t grain = WallLattice::kBlockNodes * kBlocksPerChunk;
        std::vector<Chunk> chunks((n + grain - 1) / grain);
        parallel_chunks(n, grain, [&](std::size_t begin, std::size_t end) {
            run_.throw_if_stopped();
            Chunk& chunk = chunks[begin / grain];
            for_each_crossed_cell(begin, end, [&](NodeIndex, const NodeCoord& c, const auto& corner) {
                for (const kuhn::Tetrahedron& tet : kuhn::kTetrahedra) cut(c, corner, tet, chunk);
            });
        });
        return chunks;
    }

    struct Loop {
        std::array<std::uint32_t, 8> vertex{};
        std::array<bool, 8> on_triangle{};
        std::size_t size = 0;
        std::size_t features = 0;

        void add(std::uint32_t v, bool feature) {
            on_triangle[size] = feature;
            vertex[size++] = v;
            if (feature) ++features;
        }
    };

    /// Corners 0..3 of the tetrahedron by inside first, in an even order: then the loops below face outwards.
    [[nodiscard]] std::size_t sort_corners(const std::array<NodeIndex, 8>& corner, const kuhn::Tetrahedron& tet,
                                           std::array<unsigned, 4>& order) const {
        std::size_t insides = 0;
        std::array<unsigned, 4> rank{};
        std::size_t outside_at = 3;
        for (unsigned k = 0; k < 4; ++k) {
            if (is_inside_[corner[tet.corner[k]]] != 0)
                rank[insides++] = k;
            else
                rank[outside_at--] = k;
        }
        if (insides == 0 || insides == 4) return insides;
        bool even = tet.positive;
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t j = i + 1; j < 4; ++j)
                if (rank[i] > rank[j]) even = !even;
        if (!even) {
            // Exchange two of one side.
            if (insides >= 2)
                std::swap(rank[0], rank[1]);
            else
                std::swap(rank[2], rank[3]);
        }
        for (std::size_t i = 0; i < 4; ++i) order[i] = tet.corner[rank[i]];
        return insides;
    }

    [[nodiscard]] std::uint32_t crossing(const std::array<NodeIndex, 8>& corner, unsigned p, unsigned q) const {
        const unsigned low = std::min(p, q), high = std::max(p, q);
        return edge_vertex(corner[low], high ^ low);
    }

    [[nodiscard]] Loop make_loop(const std::array<NodeIndex, 8>& corner, const std::array<unsigned, 4>& w,
                                 std::size_t insides) const {
        using Side = std::array<unsigned, 2>;
        std::array<Side, 4> sides{};
        std::size_t count = 3;
        if (insides == 1) {
            sides = {{{w[0], w[1]}, {w[0], w[2]}, {w[0], w[3]}, {}}};
        } else if (insides == 3) {
            sides = {{{w[3], w[0]}, {w[3], w[1]}, {w[3], w[2]}, {}}};
        } else {
            sides = {{{w[0], w[2]}, {w[0], w[3]}, {w[1], w[3]}, {w[1], w[2]}}};
            count = 4;
        }
        Loop loop;
        for (std::size_t k = 0; k < count; ++k) {
            const Side& here = sides[k];
            const Side& next = sides[(k + 1) % count];
            loop.add(crossing(corner, here[0], here[1]), false);
            const unsigned third = next[0] == here[0] || next[0] == here[1] ? next[1] : next[0];
            std::array<unsigned, 3> mask = {here[0], here[1], third};
            std::sort(mask.begin(), mask.end());
            if (const auto v = triangle_vertex(corner, mask)) loop.add(*v, true);
        }
        return loop;
    }

    void cut(const NodeCoord& c, const std::array<NodeIndex, 8>& corner, const kuhn::Tetrahedron& tet,
             Chunk& chunk) const {
        for (const kuhn::Mask m : tet.corner)
            if (corner[m] == WallLattice::kNone) return;
        std::array<unsigned, 4> order{};
        const std::size_t insides = sort_corners(corner, tet, order);
        if (insides == 0 || insides == 4) return;
        const Loop loop = make_loop(corner, order, insides);
        if (loop.features >= 3 && cut_round_corner(c, corner, tet, loop, chunk)) return;
        std::size_t apex = 0;
        if (loop.features > 0) {
            while (!loop.on_triangle[apex]) ++apex;
        } else if (loop.size == 4) {
            apex = shorter_diagonal(loop);
        }
        for (std::size_t k = 1; k + 1 < loop.size; ++k)
            chunk.triangles.push_back(
                {loop.vertex[apex], loop.vertex[(apex + k) % loop.size], loop.vertex[(apex + k + 1) % loop.size]});
    }

    [[nodiscard]] std::size_t shorter_diagonal(const Loop& loop) const {
        const auto at = [&](std::size_t k) -> const Vec3& { return vertices_[loop.vertex[k]].position_mm; };
        return (at(0) - at(2)).squaredNorm() <= (at(1) - at(3)).squaredNorm() ? 0 : 1;
    }

    bool cut_round_corner(const NodeCoord& c, const std::array<NodeIndex, 8>& corner, const kuhn::Tetrahedron& tet,
                          const Loop& loop, Chunk& chunk) const {
        std::array<EdgeEnd, 4> ends;
        for (std::size_t k = 0; k < 4; ++k) ends[k] = end_at(corner[tet.corner[k]], shifted(c, tet.corner[k]));
        std::array<const WallVertex*, 8> around{};
        for (std::size_t k = 0; k < loop.size; ++k) around[k] = &vertices_[loop.vertex[k]];
        const std::optional<WallVertex> center =
            corner_in_tetrahedron(field_, ends, {around.data(), loop.size}, clamp_);
        if (!center) return false;
        const auto id = kCornerFlag | static_cast<std::uint32_t>(chunk.corners.size());
        chunk.corners.push_back(*center);
        for (std::size_t k = 0; k < loop.size; ++k)
            chunk.triangles.push_back({id, loop.vertex[k], loop.vertex[(k + 1) % loop.size]});
        return true;
    }

    WallMesh join(std::vector<Chunk> chunks) {
        WallMesh mesh;
        mesh.vertices = std::move(vertices_);
        for (Chunk& chunk : chunks) {
            const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
            mesh.vertices.insert(mesh.vertices.end(), chunk.corners.begin(), chunk.corners.end());
            for (Triangle t : chunk.triangles) {
                for (std::uint32_t& v : t)
                    if ((v & kCornerFlag) != 0) v = base + (v & ~kCornerFlag);
                mesh.triangles.push_back(t);
            }
            chunk = {};
        }
        return mesh;
    }

    const WallLattice& lattice_;
    const NodeValues& values_;
    const WallField& field_;
    double clamp_;
    const RunControl& run_;
    std::vector<std::uint8_t> is_inside_;
    std::vector<std::uint8_t> cell_crossed_;
    std::vector<std::uint8_t> edge_mask_;
    std::vector<std::uint32_t> edge_first_;
    std::vector<std::uint16_t> triangle_mask_;
    std::vector<std::uint32_t> triangle_first_;
    std::vector<WallVertex> vertices_;
};

}  // namespace

WallMesh march_tetrahedra(const WallLattice& lattice, const NodeValues& values, const WallField& field, double clamp,
                          const RunControl& run) {
    return TetMarcher(lattice, values, field, clamp, run).march();
}

}  // namespace fretwork
