#include "core/solidify/lattice_pieces.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/base/disjoint_sets.h"
#include "core/base/parallel.h"

namespace fretwork {
namespace {

constexpr std::size_t kBlockNodes = WallLattice::kBlockNodes;
constexpr std::size_t kBlocksAtOnce = 16;
constexpr std::uint32_t kNone = LatticePieces::kNone;

struct Step {
    std::array<std::int32_t, 3> by;
};

/// The edges of the tetrahedra at a node, both ways.
constexpr std::array<Step, 14> edge_steps() {
    std::array<Step, 14> steps{};
    for (std::int32_t m = 1; m < 8; ++m) {
        const std::int32_t x = m & 1, y = (m >> 1) & 1, z = m >> 2;
        steps[static_cast<std::size_t>(2 * m - 2)] = {{x, y, z}};
        steps[static_cast<std::size_t>(2 * m - 1)] = {{-x, -y, -z}};
    }
    return steps;
}
constexpr std::array<Step, 14> kSteps = edge_steps();

/// One block's share of the work.
class BlockPieces {
  public:
    BlockPieces(const WallLattice& lattice, const std::vector<std::uint8_t>& wanted, std::vector<std::uint32_t>& piece,
                std::size_t block)
        : lattice_(lattice), wanted_(wanted), piece_(piece), first_(static_cast<NodeIndex>(block * kBlockNodes)) {}

    /// Numbers the pieces inside the block from 0. \return how many
    std::uint32_t flood() {
        std::uint32_t count = 0;
        std::array<std::uint16_t, kBlockNodes> stack{};
        for (std::uint32_t seed = 0; seed < kBlockNodes; ++seed) {
            if (wanted_[first_ + seed] == 0 || piece_[first_ + seed] != kNone) continue;
            std::size_t size = 1;
            stack[0] = static_cast<std::uint16_t>(seed);
            piece_[first_ + seed] = count;
            while (size > 0) {
                const std::int32_t at = stack[--size];
                for (const Step& step : kSteps) {
                    const auto next = within(at, step);
                    if (next < 0 || wanted_[first_ + static_cast<NodeIndex>(next)] == 0) continue;
                    std::uint32_t& other = piece_[first_ + static_cast<NodeIndex>(next)];
                    if (other != kNone) continue;
                    other = count;
                    stack[size++] = static_cast<std::uint16_t>(next);
                }
            }
            ++count;
        }
        return count;
    }

    /// Calls join(piece, piece of a neighbouring block) or end(piece) for the edges that leave the block.
    template <class Join, class End>
    void leave(const Join& join, const End& end) const {
        const NodeCoord base = lattice_.coord(first_);
        std::array<NodeIndex, 27> around{};
        for (std::int32_t i = 0; i < 27; ++i)
            around[static_cast<std::size_t>(i)] =
                lattice_.find({base[0] + 8 * (i % 3 - 1), base[1] + 8 * (i / 3 % 3 - 1), base[2] + 8 * (i / 9 - 1)});
        for (std::int32_t at = 0; at < static_cast<std::int32_t>(kBlockNodes); ++at) {
            const std::uint32_t own = piece_[first_ + static_cast<NodeIndex>(at)];
            if (own == kNone || !on_side(at)) continue;
            for (const Step& step : kSteps) {
                if (within(at, step) >= 0) continue;
                const std::array<std::int32_t, 3> c = {(at & 7) + step.by[0], ((at >> 3) & 7) + step.by[1],
                                                       (at >> 6) + step.by[2]};
                const std::int32_t side = ((c[2] >> 3) + 1) * 9 + ((c[1] >> 3) + 1) * 3 + (c[0] >> 3) + 1;
                const NodeIndex block = around[static_cast<std::size_t>(side)];
                if (block == WallLattice::kNone) {
                    end(own);
                    continue;
                }
                const std::uint32_t other =
                    piece_[block + static_cast<NodeIndex>(((c[2] & 7) << 6) + ((c[1] & 7) << 3) + (c[0] & 7))];
                if (other != kNone && block > first_) join(own, other);
            }
        }
    }

  private:
    /// The node a step away, or -1 if that is in another block.
    static std::int32_t within(std::int32_t at, const Step& step) {
        const std::int32_t x = (at & 7) + step.by[0], y = ((at >> 3) & 7) + step.by[1], z = (at >> 6) + step.by[2];
        return ((x | y | z) & ~7) != 0 ? -1 : (z << 6) + (y << 3) + x;
    }
    static bool on_side(std::int32_t at) {
        const auto rim = [](std::int32_t x) { return x == 0 || x == 7; };
        return rim(at & 7) || rim((at >> 3) & 7) || rim(at >> 6);
    }

    const WallLattice& lattice_;
    const std::vector<std::uint8_t>& wanted_;
    std::vector<std::uint32_t>& piece_;
    NodeIndex first_;
};

}  // namespace

LatticePieces find_pieces(const WallLattice& lattice, const std::vector<std::uint8_t>& wanted, const RunControl& run) {
    const std::size_t blocks = lattice.block_count();
    LatticePieces pieces;
    std::vector<std::uint32_t>& piece = pieces.of_node;
    piece.assign(lattice.node_count(), kNone);
    std::vector<std::uint32_t> base(blocks + 1, 0);
    parallel_for(blocks, kBlocksAtOnce, [&](std::size_t b) {
        run.throw_if_stopped();
        base[b + 1] = BlockPieces(lattice, wanted, piece, b).flood();
    });
    for (std::size_t b = 0; b < blocks; ++b) base[b + 1] += base[b];
    parallel_for(lattice.node_count(), kBlocksAtOnce * kBlockNodes, [&](std::size_t i) {
        if (piece[i] != kNone) piece[i] += base[i / kBlockNodes];
    });

    using Joint = std::pair<std::uint32_t, std::uint32_t>;
    std::vector<std::vector<Joint>> joints((blocks + kBlocksAtOnce - 1) / kBlocksAtOnce);
    std::vector<std::uint8_t> ends(base[blocks], 0);
    parallel_for(blocks, kBlocksAtOnce, [&](std::size_t b) {
        run.throw_if_stopped();
        std::vector<Joint>& own = joints[b / kBlocksAtOnce];
        BlockPieces(lattice, wanted, piece, b)
            .leave(
                [&](std::uint32_t from, std::uint32_t to) {
                    if (own.empty() || own.back() != Joint{from, to}) own.emplace_back(from, to);
                },
                [&](std::uint32_t from) { ends[from] = 1; });
    });
    DisjointSets sets(base[blocks]);
    for (const std::vector<Joint>& part : joints)
        for (const auto& [from, to] : part) sets.unite(from, to);

    std::vector<std::uint32_t> number(base[blocks], kNone);
    for (std::uint32_t p = 0; p < number.size(); ++p) {
        const std::uint32_t root = sets.find(p);
        if (root == p) {
            number[p] = static_cast<std::uint32_t>(pieces.nodes.size());
            pieces.nodes.push_back(0);
            pieces.at_end.push_back(0);
        }
        number[p] = number[root];
        if (ends[p] != 0) pieces.at_end[number[p]] = 1;
    }
    parallel_for(lattice.node_count(), kBlocksAtOnce * kBlockNodes, [&](std::size_t i) {
        if (piece[i] != kNone) piece[i] = number[piece[i]];
    });
    for (const std::uint32_t p : piece)
        if (p != kNone) ++pieces.nodes[p];
    return pieces;
}

}  // namespace fretwork
