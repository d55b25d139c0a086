// Collapses the edges of one block of vertices.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/solidify/simplify_state.h"

namespace fretwork {

/// Work of one thread on one block. Touches only triangles whose corners all lie in the block.
class BlockSimplifier {
  public:
    using Corner = CollapseMesh::Corner;

    /// \param block       per vertex
    /// \param border_mm   how far the border between two areas may move when a vertex of it goes; infinite: areas do
    ///                    not matter
    /// \param log         gets, for each collapse: its edge's corner, the number of corners that stayed, those corners
    BlockSimplifier(SimplifyState& state, const std::vector<std::uint32_t>& block, double border_mm,
                    std::vector<Corner>& log)
        : state_(state), mesh_(state.mesh), block_(block), border_mm_(border_mm), log_(log) {}

    /// Tries each vertex once. \param full  `allowed` is the whole tolerance: who cannot go now is settled
    void sweep(std::span<const std::uint32_t> vertices, double allowed, bool full);

  private:
    /// A neighbour of u and the triangle from it to the next one.
    struct Spoke {
        Corner corner;  ///< at u
        std::uint32_t vertex;
        Vec3 offset;  ///< from u
        TriangleShape shape;
    };
    struct Candidate {
        std::size_t spoke;
        double cost;
    };
    /// A triangle of the ring after the collapse, around v.
    struct NewTriangle {
        std::uint32_t triangle, p, q;
        Vec3 normal;
        Vec3 edge_v, edge_p;  ///< in the plane, inwards from the sides v p and p q
        Vec3 edge_q;          ///< and q v
    };
    struct Filed {
        std::uint32_t vertex, triangle;
    };

    bool try_vertex(std::uint32_t u, double allowed);
    [[nodiscard]] bool gather_spokes(std::uint32_t u);
    [[nodiscard]] bool minds_areas() const { return border_mm_ < std::numeric_limits<double>::infinity(); }
    [[nodiscard]] std::uint8_t area(std::size_t spoke) const;
    [[nodiscard]] std::size_t find_border();
    [[nodiscard]] bool keeps_border(std::size_t toward, std::size_t borders) const;
    [[nodiscard]] bool stands_for(std::uint32_t triangle, std::uint32_t sample) const;
    void rank_candidates(double allowed);
    [[nodiscard]] bool good_shape(std::size_t toward, double& worst) const;
    [[nodiscard]] bool try_candidate(std::uint32_t u, const Candidate& candidate, double allowed);
    void make_ring(std::size_t toward);
    [[nodiscard]] bool find_samples(std::uint32_t u, std::uint32_t v, double allowed);
    [[nodiscard]] bool file_sample(std::uint32_t sample, const Vec3& v, double allowed);
    [[nodiscard]] bool meets_neighbors(std::uint32_t u, std::uint32_t v);
    [[nodiscard]] bool clearly_apart(std::uint32_t u) const;
    [[nodiscard]] bool meet(const NewTriangle& s, std::uint32_t v, std::uint32_t t) const;
    template <class Visit>
    void for_each_neighbor(std::uint32_t u, const Visit& visit) const;
    void commit(std::size_t toward);

    SimplifyState& state_;
    CollapseMesh& mesh_;
    const std::vector<std::uint32_t>& block_;
    double border_mm_;
    std::array<std::size_t, 2> border_spokes_{};
    std::vector<Corner>& log_;
    std::vector<Corner> around_;
    std::vector<Spoke> spokes_;
    std::vector<Candidate> candidates_;
    std::vector<NewTriangle> ring_;
    std::vector<Filed> filed_;
    std::vector<std::uint32_t> neighbors_;
};

}  // namespace fretwork
