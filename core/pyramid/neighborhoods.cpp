#include "core/pyramid/neighborhoods.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/parallel.h"
#include "core/shell/cell_rows.h"

namespace fretwork {
namespace {

constexpr std::size_t kGrain = 1024;
constexpr std::size_t kReverseGrain = 8192;
// Pairs whose normals, and all on the way, have at least this cosine lie on a smooth piece of the surface.
constexpr float kSmoothCosine = 0.8F;
// Marks a pair that needs its way unfolded, in the top bit of the neighbour's index.
constexpr std::uint32_t kCreased = 0x80000000u;

// Ways of at most two links between two entries.
class Ways {
  public:
    Ways(const PyramidLevel& level) : level_(level), cosine_(level.adjacency.neighbor.size()) {
        parallel_for(level.size(), kGrain, [&](std::size_t v) {
            for (std::uint32_t e = level.adjacency.first[v]; e < level.adjacency.first[v + 1]; ++e)
                cosine_[e] = level.normals[v].dot(level.normals[level.adjacency.neighbor[e]]);
        });
    }

    struct Way {
        VoxelIndex between;  // entry in the middle of two steps, or where they start for the direct link
        float cosine;        // the smaller of the steps; -1 where there is no way
    };

    [[nodiscard]] Way least_bent(VoxelIndex v, VoxelIndex w) const {
        const Adjacency& links = level_.adjacency;
        Way best = {v, -1.0F};
        std::uint32_t e = links.first[v];
        std::uint32_t f = links.first[w];
        while (e < links.first[v + 1] && f < links.first[w + 1]) {
            const VoxelIndex from_v = links.neighbor[e];
            const VoxelIndex from_w = links.neighbor[f];
            if (from_v == w && cosine_[e] > best.cosine) best = {v, cosine_[e]};
            if (from_v == from_w) {
                const float cosine = std::min(cosine_[e], cosine_[f]);
                if (cosine > best.cosine) best = {from_v, cosine};
            }
            e += from_v <= from_w;
            f += from_w <= from_v;
        }
        // The direct link may be the last of the row of v.
        for (; e < links.first[v + 1]; ++e)
            if (links.neighbor[e] == w && cosine_[e] > best.cosine) best = {v, cosine_[e]};
        return best;
    }

    [[nodiscard]] float cosine_of_link(std::size_t e) const { return cosine_[e]; }

  private:
    const PyramidLevel& level_;
    std::vector<float> cosine_;
};

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

// The cells of v and of all entries linked to it, as sets around the cell of v.
struct Surroundings {
    CellSet cells = 0;
    CellSet smooth = 0;    // over steps with at least kSmoothCosine
    bool crowded = false;  // some of the cells are listed more than once, so that a cell does not tell the entry
};

std::vector<Surroundings> survey(const PyramidLevel& level, const CellRows& rows, const Ways& ways) {
    constexpr CellSet own = CellSet{1} << 13;
    std::vector<Surroundings> all(level.size());
    parallel_for(level.size(), kGrain, [&](std::size_t v) {
        Surroundings& s = all[v];
        s.cells = s.smooth = own;
        s.crowded = rows.shares_cell(static_cast<VoxelIndex>(v));
        for (std::uint32_t e = level.adjacency.first[v]; e < level.adjacency.first[v + 1]; ++e) {
            if (ways.cosine_of_link(e) < kTurningRoundCosine) continue;
            const VoxelIndex w = level.adjacency.neighbor[e];
            const CellSet cell = CellSet{1} << touching_code(level.coords[v], level.coords[w]);
            s.cells |= cell;
            if (ways.cosine_of_link(e) >= kSmoothCosine) s.smooth |= cell;
            s.crowded |= rows.shares_cell(w);
        }
    });
    return all;
}

// Lists N(v) by following links. For crowded entries.
class LinkFollower {
  public:
    LinkFollower(const PyramidLevel& level, const Ways& ways, Window window)
        : level_(level), ways_(ways), window_(window), slot_(window.end - window.begin, 0) {}

    /// Appends the neighbours of `v`, ascending and marked; returns their number.
    std::uint32_t append(VoxelIndex v, std::vector<std::uint32_t>& neighbors) {
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
        for (const VoxelIndex w : found_) {
            std::uint32_t& slot = slot_[w - window_.begin];
            neighbors.push_back(best_[slot - 1] >= kSmoothCosine ? w : w | kCreased);
            slot = 0;
        }
        return static_cast<std::uint32_t>(found_.size());
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
    std::vector<VoxelIndex> found_;
    std::vector<float> best_;  // cosine of the least bent way
};

// Lists N(v) for runs of entries.
class NeighborFinder {
  public:
    NeighborFinder(const PyramidLevel& level, const Ways& ways)
        : level_(level),
          ways_(ways),
          rows_(extent_of(level.coords), level.coords),
          layers_(layer_starts(level.coords)),
          surroundings_(survey(level, rows_, ways)) {}

    /// Appends the neighbours of v in [begin, end), ascending, with the mark kCreased where no smooth way leads
    /// there, and adds the number of those of v to `count[v]`.
    void append(std::size_t begin, std::size_t end, std::vector<std::uint32_t>& neighbors, std::uint32_t* count) const {
        std::optional<LinkFollower> follower;
        while (begin < end) {
            std::size_t run = begin + 1;
            while (run < end && surroundings_[run].crowded == surroundings_[begin].crowded) ++run;
            if (surroundings_[begin].crowded) {
                if (!follower) follower.emplace(level_, ways_, window_around(level_, layers_, begin, end));
                for (std::size_t v = begin; v < run; ++v)
                    count[v] = follower->append(static_cast<VoxelIndex>(v), neighbors);
            } else {
                append_by_cells(begin, run, neighbors, count);
            }
            begin = run;
        }
    }

  private:
    void append_by_cells(std::size_t begin, std::size_t end, std::vector<std::uint32_t>& neighbors,
                         std::uint32_t* count) const {
        rows_.sweep<2>(begin, end, [&](VoxelIndex v, VoxelIndex w, int code) {
            const Surroundings& a = surroundings_[v];
            const Surroundings& b = surroundings_[w];
            // Two entries with a linked cell, or their own, in common are at most two steps apart.
            if (overlap_.common(a.cells, b.cells, code) == 0) return;
            neighbors.push_back(overlap_.common(a.smooth, b.smooth, code) != 0 ? w : w | kCreased);
            ++count[v];
        });
    }

    const PyramidLevel& level_;
    const Ways& ways_;
    CellRows rows_;
    std::vector<VoxelIndex> layers_;
    std::vector<Surroundings> surroundings_;
    CellSetOverlap overlap_;
};

// `step` turned into the plane of the unit normal `n`, length kept.
Vec3f lay_flat(const Vec3f& step, const Vec3f& n) {
    const Vec3f flat = step - n * n.dot(step);
    const float squared = flat.squaredNorm();
    return squared > 0.0F ? Vec3f(flat * std::sqrt(step.squaredNorm() / squared)) : Vec3f::Zero();
}

// A tangent vector of `from` carried to `to` by the smallest rotation between the two unit normals, which do
// not oppose.
Vec3f carry(const Vec3f& t, const Vec3f& from, const Vec3f& to) {
    const Vec3f axis = from.cross(to);
    return t + axis.cross(t) + axis.cross(axis.cross(t)) / (1.0F + from.dot(to));
}

class Unfolder {
  public:
    Unfolder(const PyramidLevel& level, const Ways& ways) : level_(level), ways_(ways) {}

    /// The way from v to w laid into the plane of v. A rounded edge is followed in two steps; a sharp one, over
    /// which no smooth way leads, is a hinge.
    [[nodiscard]] Vec3f unfold(VoxelIndex v, VoxelIndex w, bool smooth_way) const {
        const float cosine = level_.normals[v].dot(level_.normals[w]);
        if (smooth_way && cosine >= kSmoothCosine) return over_smooth(v, w, cosine);
        if (!smooth_way)
            if (const std::optional<Vec3f> hinged = around_hinge(v, w)) return *hinged;
        const VoxelIndex between = ways_.least_bent(v, w).between;
        if (between == v) return one_step(v, w);
        return one_step(v, between) + carry(one_step(between, w), level_.normals[between], level_.normals[v]);
    }

  private:
    [[nodiscard]] Vec3f over_smooth(VoxelIndex v, VoxelIndex w, float cosine) const {
        // Chord 2 sin(a / 2) against arc a, where the normals turn by a: their ratio is 1 + (1 - cos a) / 12
        // up to a^4.
        return (1.0F + (1.0F - cosine) / 12.0F) *
               lay_flat(level_.positions[w] - level_.positions[v], level_.normals[v]);
    }

    [[nodiscard]] Vec3f one_step(VoxelIndex v, VoxelIndex w) const {
        if (const std::optional<Vec3f> hinged = around_hinge(v, w)) return *hinged;
        return over_smooth(v, w, level_.normals[v].dot(level_.normals[w]));
    }

    // Takes the surface as the two tangent planes, folded along the line where they meet, and turns w about this
    // line into the plane of v. Exact on two flat faces. Nothing where the line does not lie between the two.
    [[nodiscard]] std::optional<Vec3f> around_hinge(VoxelIndex v, VoxelIndex w) const {
        const Vec3f& n = level_.normals[v];
        const Vec3f& m = level_.normals[w];
        const float cosine = n.dot(m);
        if (cosine >= kSmoothCosine || cosine < kTurningRoundCosine) return std::nullopt;
        const Vec3f line = n.cross(m).normalized();
        const Vec3f across_v = line.cross(n);  // in the plane of v, square to the line
        const Vec3f across_w = line.cross(m);
        const Vec3f way = level_.positions[w] - level_.positions[v];
        const float to_line = m.dot(way) / m.dot(across_v);
        const float from_line = n.dot(way) / n.dot(across_w);
        if (to_line * from_line < 0.0F) return std::nullopt;
        return (to_line + from_line) * across_v + line.dot(way) * line;
    }

    const PyramidLevel& level_;
    const Ways& ways_;
};

// Entries are visited in ascending order, so the places they take in the row of a neighbour follow each other.
void fill_reverse(Window window, Neighborhoods& n, std::size_t begin, std::size_t end) {
    constexpr std::uint32_t kUnset = 0xffffffffu;
    std::vector<std::uint32_t> next(window.end - window.begin, kUnset);
    for (std::size_t v = begin; v < end; ++v)
        for (std::uint32_t i = n.first[v]; i < n.first[v + 1]; ++i) {
            const VoxelIndex w = n.neighbor[i];
            std::uint32_t& at = next[w - window.begin];
            if (at == kUnset) {
                const auto row = n.neighbor.begin();
                at = static_cast<std::uint32_t>(
                    std::lower_bound(row + n.first[w], row + n.first[w + 1], static_cast<VoxelIndex>(v)) - row);
            }
            n.reverse[i] = at++;
        }
}

}  // namespace

Neighborhoods find_neighborhoods(const PyramidLevel& level, const RunControl& run) {
    Neighborhoods result;
    result.first.assign(level.size() + 1, 0);
    if (level.size() == 0) return result;
    const Ways ways(level);
    std::vector<std::vector<std::uint32_t>> chunks((level.size() + kGrain - 1) / kGrain);
    {
        const NeighborFinder finder(level, ways);
        parallel_chunks(level.size(), kGrain, [&](std::size_t begin, std::size_t end) {
            run.throw_if_stopped();
            std::vector<std::uint32_t>& all = chunks[begin / kGrain];
            all.reserve(48 * (end - begin));
            finder.append(begin, end, all, result.first.data() + 1);
        });
    }
    for (std::size_t v = 0; v < level.size(); ++v) result.first[v + 1] += result.first[v];

    result.neighbor.resize(result.first.back());
    result.offset.resize(result.first.back());
    result.reverse.resize(result.first.back());
    const Unfolder unfolder(level, ways);
    parallel_chunks(level.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        run.throw_if_stopped();
        const std::vector<std::uint32_t>& all = chunks[begin / kGrain];
        std::uint32_t i = result.first[begin];
        for (std::size_t v = begin; v < end; ++v)
            for (; i < result.first[v + 1]; ++i) {
                const std::uint32_t marked = all[i - result.first[begin]];
                const VoxelIndex w = marked & ~kCreased;
                result.neighbor[i] = w;
                result.offset[i] = unfolder.unfold(static_cast<VoxelIndex>(v), w, marked == w);
            }
        chunks[begin / kGrain] = {};
    });
    const std::vector<VoxelIndex> layers = layer_starts(level.coords);
    parallel_chunks(level.size(), kReverseGrain, [&](std::size_t begin, std::size_t end) {
        run.throw_if_stopped();
        fill_reverse(window_around(level, layers, begin, end), result, begin, end);
    });
    return result;
}

}  // namespace fretwork
