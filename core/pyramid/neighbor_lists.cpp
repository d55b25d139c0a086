#include "core/pyramid/neighbor_lists.h"

#include <algorithm>
#include <array>
#include <bit>
#include <optional>

#include "core/base/parallel.h"
#include "core/pyramid/flat_ways.h"

namespace fretwork {
namespace {

constexpr std::size_t kGrain = 1024;
// Cells that touch an entry lie within the lowest 63 bits of its cube, moved there; this one is free for a mark: some
// of the cells are listed more than once, so that a cell does not tell the entry.
constexpr std::uint64_t kCrowded = std::uint64_t{1} << 63;

// Bit of a touching cell, counted from the cell before v along each axis.
int touching_bit(const VoxelCoord& v, const VoxelCoord& w) {
    return (w[0] - v[0] + 1) + 5 * (w[1] - v[1] + 1) + 25 * (w[2] - v[2] + 1);
}

// Where each layer of cells starts; entries are sorted by z first.
std::vector<VoxelIndex> layer_starts(std::span<const VoxelCoord> coords) {
    std::vector<VoxelIndex> first(static_cast<std::size_t>(coords.back()[2]) + 2, 0);
    for (const VoxelCoord& c : coords) ++first[static_cast<std::size_t>(c[2]) + 1];
    for (std::size_t z = 0; z + 1 < first.size(); ++z) first[z + 1] += first[z];
    return first;
}

struct Window {
    VoxelIndex begin;
    VoxelIndex end;
};

// All entries that may be neighbours of those in [begin, end).
Window window_around(const PyramidLevel& level, std::span<const VoxelIndex> layers, std::size_t begin,
                     std::size_t end) {
    const auto low = static_cast<std::size_t>(std::max(0, level.coords[begin][2] - 2));
    const auto high = std::min(layers.size() - 1, static_cast<std::size_t>(level.coords[end - 1][2]) + 3);
    return {layers[low], layers[high]};
}

// Lists N(v) by following links. For crowded entries.
class LinkFollower {
  public:
    LinkFollower(const PyramidLevel& level, const Ways& ways, Window window)
        : level_(level), ways_(ways), window_(window), slot_(window.end - window.begin, 0) {}

    // The neighbours of `v`, ascending and marked; valid until the next call.
    std::span<const std::uint32_t> list(VoxelIndex v) {
        const Adjacency& links = level_.adjacency;
        found_.clear();
        best_.clear();
        for (std::uint32_t e = links.first[v]; e < links.first[v + 1]; ++e) {
            const float first_step = ways_.cosine_of_link(e);
            if (first_step < kTurningRoundCosine) continue;
            const VoxelIndex u = links.neighbor[e];
            note(u, first_step);
            for (std::uint32_t f = links.first[u]; f < links.first[u + 1]; ++f)
                if (links.neighbor[f] != v && ways_.cosine_of_link(f) >= kTurningRoundCosine)
                    note(links.neighbor[f], std::min(first_step, ways_.cosine_of_link(f)));
        }
        std::sort(found_.begin(), found_.end());
        for (std::uint32_t& w : found_) {
            std::uint32_t& slot = slot_[w - window_.begin];
            if (best_[slot - 1] < kSmoothCosine) w |= kCreased;
            slot = 0;
        }
        return found_;
    }

  private:
    void note(VoxelIndex w, float cosine) {
        std::uint32_t& slot = slot_[w - window_.begin];
        if (slot == 0) {
            found_.push_back(w);
            best_.push_back(cosine);
            slot = static_cast<std::uint32_t>(best_.size());
        } else {
            best_[slot - 1] = std::max(best_[slot - 1], cosine);
        }
    }

    const PyramidLevel& level_;
    const Ways& ways_;
    Window window_;
    std::vector<std::uint32_t> slot_;  // place in best_ plus one, per entry of the window
    std::vector<std::uint32_t> found_;
    std::vector<float> best_;  // cosine of the least bent way
};

// A cell of the cube around an entry: its row among the 25, and the set of cells before it in this row.
struct CubeCell {
    std::uint8_t row;
    std::uint8_t before;
};

constexpr std::array<CubeCell, 125> cube_cells() {
    std::array<CubeCell, 125> cells{};
    for (std::size_t bit = 0; bit < 125; ++bit)
        cells[bit] = {static_cast<std::uint8_t>(bit / 5), static_cast<std::uint8_t>((1u << bit % 5) - 1)};
    return cells;
}

constexpr std::array<CubeCell, 125> kCubeCells = cube_cells();
// Bits of four that are set.
constexpr std::array<std::uint8_t, 16> kOnes = {0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4};

}  // namespace

// Finds the entries of cells by sliding along the 25 rows around a row of entries.
class NeighborLists::RowCursors {
  public:
    RowCursors(const CellRows& rows, const std::vector<VoxelCoord>& coords) : rows_(rows), coords_(coords) {}

    // v ascends from call to call.
    std::span<const std::uint32_t> list(VoxelIndex v, const Reached& reached) {
        slide_to(coords_[v]);
        constexpr std::uint64_t own = std::uint64_t{1} << 62;
        std::size_t found = add_cells(reached.cells.low & ~own, reached.smooth.low, 0, 0);
        found = add_cells(reached.cells.high, reached.smooth.high, 64, found);
        return {found_.data(), found};
    }

  private:
    // The cells x - 2 .. x + 2 of one row.
    struct Window {
        std::uint32_t begin = 0;  // entries from the first of these cells on ..
        std::uint32_t end = 0;    // .. to the last
        std::uint32_t row_end = 0;
        std::uint32_t occupied = 0;  // cells that hold an entry
        bool single = true;          // none of them holds more
    };

    void slide_to(const VoxelCoord& c) {
        if (!started_ || c[1] != at_[1] || c[2] != at_[2]) {
            std::size_t k = 0;
            for (int dz = -2; dz <= 2; ++dz)
                for (int dy = -2; dy <= 2; ++dy) {
                    const CellRows::Row row = rows_.row(c[1] + dy, c[2] + dz);
                    windows_[k++] = {row.begin, row.begin, row.end, 0, true};
                }
            for (Window& w : windows_) open(w, c[0]);
        } else if (c[0] == at_[0] + 1) {
            for (Window& w : windows_) step(w, c[0]);
        } else if (c[0] != at_[0]) {
            for (Window& w : windows_) open(w, c[0]);
        }
        started_ = true;
        at_ = c;
    }

    void open(Window& w, int x) const {
        while (w.begin < w.row_end && rows_.x_of(w.begin) < x - 2) ++w.begin;
        w.occupied = 0;
        w.single = true;
        for (w.end = w.begin; w.end < w.row_end && rows_.x_of(w.end) <= x + 2; ++w.end) {
            const std::uint32_t cell = 1u << (rows_.x_of(w.end) - x + 2);
            w.single = w.single && (w.occupied & cell) == 0;
            w.occupied |= cell;
        }
    }

    // From the window around x - 1; without a branch where cells hold one entry.
    void step(Window& w, int x) const {
        if (!w.single) return open(w, x);
        w.begin += w.occupied & 1u;
        w.occupied >>= 1;
        if (w.end == w.row_end || rows_.x_of(w.end) != x + 2) return;
        if (w.end + 1 < w.row_end && rows_.x_of(w.end + 1) == x + 2) return open(w, x);
        w.occupied |= 1u << 4;
        ++w.end;
    }

    // The entry of each of 64 cells of the cube, from cell `first` on.
    std::size_t add_cells(std::uint64_t cells, std::uint64_t smooth, std::size_t first, std::size_t found) {
        for (; cells != 0; cells &= cells - 1) {
            const auto bit = static_cast<std::size_t>(std::countr_zero(cells));
            const CubeCell& cell = kCubeCells[first + bit];
            const Window& w = windows_[cell.row];
            const std::uint32_t entry = w.single ? w.begin + kOnes[w.occupied & cell.before] : entry_at(w, cell.before);
            found_[found++] = entry | static_cast<std::uint32_t>(~smooth >> bit & 1u) << 31;
        }
        return found;
    }

    // The entry after those in the cells `before`. A cell in N(v) holds one entry, others may hold more.
    [[nodiscard]] std::uint32_t entry_at(const Window& w, std::uint32_t before) const {
        const int x = at_[0] - 2 + std::popcount(before);
        std::uint32_t entry = w.begin;
        while (rows_.x_of(entry) < x) ++entry;
        return entry;
    }

    const CellRows& rows_;
    const std::vector<VoxelCoord>& coords_;
    bool started_ = false;
    VoxelCoord at_ = {0, 0, 0};
    std::array<Window, 25> windows_;
    std::array<std::uint32_t, 125> found_;
};

NeighborLists::NeighborLists(const PyramidLevel& level, const Ways& ways, const RunControl& run)
    : level_(level), ways_(ways), rows_(extent_of(level.coords), level.coords), layers_(layer_starts(level.coords)) {
    touching_.resize(level.size());
    reached_.resize(level.size());
    crowded_.resize(level.size());
    count_.resize(level.size());
    parallel_for(level.size(), kGrain, [&](std::size_t v) { touching_[v] = survey(static_cast<VoxelIndex>(v)); });
    parallel_chunks(level.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        run.throw_if_stopped();
        count(begin, end);
    });
}

NeighborLists::Touching NeighborLists::survey(VoxelIndex v) const {
    constexpr std::uint64_t own = std::uint64_t{1} << 31;
    Touching t{own, own};
    if (rows_.shares_cell(v)) t.cells |= kCrowded;
    for (std::uint32_t e = level_.adjacency.first[v]; e < level_.adjacency.first[v + 1]; ++e) {
        if (ways_.cosine_of_link(e) < kTurningRoundCosine) continue;
        const VoxelIndex w = level_.adjacency.neighbor[e];
        const std::uint64_t cell = std::uint64_t{1} << touching_bit(level_.coords[v], level_.coords[w]);
        t.cells |= cell;
        if (ways_.cosine_of_link(e) >= kSmoothCosine) t.smooth |= cell;
        if (rows_.shares_cell(w)) t.cells |= kCrowded;
    }
    return t;
}

bool NeighborLists::reach(VoxelIndex v, Reached& reached) const {
    constexpr int own = 31;
    std::uint64_t marks = touching_[v].cells;
    reached.cells.add(touching_[v].cells & ~kCrowded, own);
    reached.smooth.add(touching_[v].smooth, own);
    for (std::uint32_t e = level_.adjacency.first[v]; e < level_.adjacency.first[v + 1]; ++e) {
        if (ways_.cosine_of_link(e) < kTurningRoundCosine) continue;
        const VoxelIndex w = level_.adjacency.neighbor[e];
        const int bit = touching_bit(level_.coords[v], level_.coords[w]);
        marks |= touching_[w].cells;
        reached.cells.add(touching_[w].cells & ~kCrowded, bit);
        if (ways_.cosine_of_link(e) >= kSmoothCosine) reached.smooth.add(touching_[w].smooth, bit);
    }
    return (marks & kCrowded) == 0;
}

void NeighborLists::count(std::size_t begin, std::size_t end) {
    std::optional<LinkFollower> follower;
    for (std::size_t i = begin; i < end; ++i) {
        const auto v = static_cast<VoxelIndex>(i);
        Reached reached;
        crowded_[v] = reach(v, reached) ? 0 : 1;
        reached_[v] = reached;
        if (crowded_[v] == 0) {
            count_[v] =
                static_cast<std::uint32_t>(std::popcount(reached.cells.low) + std::popcount(reached.cells.high) - 1);
        } else {
            if (!follower) follower.emplace(level_, ways_, window_around(level_, layers_, begin, end));
            count_[v] = static_cast<std::uint32_t>(follower->list(v).size());
        }
    }
}

void NeighborLists::list(std::size_t begin, std::size_t end, const Visit& visit) const {
    std::optional<LinkFollower> follower;
    RowCursors cursors(rows_, level_.coords);
    for (std::size_t i = begin; i < end; ++i) {
        const auto v = static_cast<VoxelIndex>(i);
        if (crowded_[v] == 0) {
            visit(v, cursors.list(v, reached_[v]));
            continue;
        }
        if (!follower) follower.emplace(level_, ways_, window_around(level_, layers_, begin, end));
        visit(v, follower->list(v));
    }
}

}  // namespace fretwork
