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
        Way best = {v, cosine_between(v, w)};
        for (std::uint32_t e = links.first[v]; e < links.first[v + 1]; ++e) {
            const float cosine = std::min(cosine_[e], cosine_between(links.neighbor[e], w));
            if (cosine > best.cosine) best = {links.neighbor[e], cosine};
        }
        return best;
    }

    [[nodiscard]] float cosine_of_link(std::size_t e) const { return cosine_[e]; }

  private:
    [[nodiscard]] float cosine_between(VoxelIndex v, VoxelIndex w) const {
        const auto row = level_.adjacency.of(v);
        const auto at = std::lower_bound(row.begin(), row.end(), w);
        if (at == row.end() || *at != w) return -1.0F;
        return cosine_[level_.adjacency.first[v] + static_cast<std::size_t>(at - row.begin())];
    }

    const PyramidLevel& level_;
    std::vector<float> cosine_;
};

// The cells of v and of all entries linked to it, as sets around the cell of v: those listed once, where the cell
// tells the entry, and those listed more often.
struct Surroundings {
    CellSet single = 0;
    CellSet several = 0;
    CellSet smooth_single = 0;  // the same over steps with at least kSmoothCosine
    CellSet smooth_several = 0;
};

std::vector<Surroundings> survey(const PyramidLevel& level, const CellRows& rows, const Ways& ways) {
    constexpr CellSet own = CellSet{1} << 13;
    std::vector<Surroundings> all(level.size());
    parallel_for(level.size(), kGrain, [&](std::size_t v) {
        Surroundings& s = all[v];
        (rows.shares_cell(static_cast<VoxelIndex>(v)) ? s.several : s.single) |= own;
        (rows.shares_cell(static_cast<VoxelIndex>(v)) ? s.smooth_several : s.smooth_single) |= own;
        for (std::uint32_t e = level.adjacency.first[v]; e < level.adjacency.first[v + 1]; ++e) {
            const VoxelIndex w = level.adjacency.neighbor[e];
            if (ways.cosine_of_link(e) < kTurningRoundCosine) continue;
            const CellSet cell = CellSet{1} << touching_code(level.coords[v], level.coords[w]);
            (rows.shares_cell(w) ? s.several : s.single) |= cell;
            if (ways.cosine_of_link(e) >= kSmoothCosine)
                (rows.shares_cell(w) ? s.smooth_several : s.smooth_single) |= cell;
        }
    });
    return all;
}

// Lists N(v) for runs of entries.
class NeighborFinder {
  public:
    NeighborFinder(const PyramidLevel& level, const CellRows& rows, const Ways& ways)
        : rows_(rows), ways_(ways), surroundings_(survey(level, rows, ways)) {}

    /// Appends the neighbours of v in [begin, end), ascending, with the mark kCreased where no smooth way leads
    /// there, and writes the number of those of v to `count[v]`.
    void append(std::size_t begin, std::size_t end, std::vector<std::uint32_t>& neighbors, std::uint32_t* count) const {
        rows_.sweep<2>(begin, end, [&](VoxelIndex v, VoxelIndex w, int code) {
            const Surroundings& a = surroundings_[v];
            const Surroundings& b = surroundings_[w];
            // Two entries with a linked cell (or their own) in common are at most two steps apart.
            bool smooth = overlap_.common(a.smooth_single, b.smooth_single, code) != 0;
            if (!smooth) {
                const bool reached = overlap_.common(a.single, b.single, code) != 0;
                if (!reached && overlap_.common(a.several, b.several, code) == 0) return;
                // The cells in common may hold one entry for each of the two: only the lists tell.
                if (!reached || overlap_.common(a.smooth_several, b.smooth_several, code) != 0) {
                    const float cosine = ways_.least_bent(v, w).cosine;
                    if (cosine < kTurningRoundCosine) return;
                    smooth = cosine >= kSmoothCosine;
                }
            }
            neighbors.push_back(smooth ? w : w | kCreased);
            ++count[v];
        });
    }

  private:
    const CellRows& rows_;
    const Ways& ways_;
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

    /// The way from v to w laid into the plane of v.
    [[nodiscard]] Vec3f unfold(VoxelIndex v, VoxelIndex w, bool smooth_way) const {
        const float cosine = level_.normals[v].dot(level_.normals[w]);
        return smooth_way && cosine >= kSmoothCosine ? over_smooth(v, w, cosine) : over_crease(v, w);
    }

  private:
    [[nodiscard]] Vec3f over_smooth(VoxelIndex v, VoxelIndex w, float cosine) const {
        // Chord 2 sin(a / 2) against arc a, where the normals turn by a: their ratio is 1 + (1 - cos a) / 12
        // up to a^4.
        return (1.0F + (1.0F - cosine) / 12.0F) *
               lay_flat(level_.positions[w] - level_.positions[v], level_.normals[v]);
    }

    [[nodiscard]] Vec3f over_crease(VoxelIndex v, VoxelIndex w) const {
        // A rounded edge is followed in two steps; a sharp one is a hinge.
        const Ways::Way way = ways_.least_bent(v, w);
        if (way.cosine < kSmoothCosine)
            if (const std::optional<Vec3f> hinged = around_hinge(v, w)) return *hinged;
        if (way.between == v) return one_step(v, w);
        return one_step(v, way.between) +
               carry(one_step(way.between, w), level_.normals[way.between], level_.normals[v]);
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

// Where each layer of cells starts; entries are sorted by z first.
std::vector<VoxelIndex> layer_starts(std::span<const VoxelCoord> coords) {
    std::vector<VoxelIndex> first(static_cast<std::size_t>(coords.back()[2]) + 2, 0);
    for (const VoxelCoord& c : coords) ++first[static_cast<std::size_t>(c[2]) + 1];
    for (std::size_t z = 0; z + 1 < first.size(); ++z) first[z + 1] += first[z];
    return first;
}

// Entries are visited in ascending order, so the places they take in the row of a neighbour follow each other.
void fill_reverse(const PyramidLevel& level, const std::vector<VoxelIndex>& layers, Neighborhoods& n, std::size_t begin,
                  std::size_t end) {
    constexpr std::uint32_t kUnset = 0xffffffffu;
    const auto low = static_cast<std::size_t>(std::max(0, level.coords[begin][2] - 2));
    const auto high = std::min(layers.size() - 1, static_cast<std::size_t>(level.coords[end - 1][2]) + 3);
    std::vector<std::uint32_t> next(layers[high] - layers[low], kUnset);
    for (std::size_t v = begin; v < end; ++v)
        for (std::uint32_t i = n.first[v]; i < n.first[v + 1]; ++i) {
            const VoxelIndex w = n.neighbor[i];
            std::uint32_t& at = next[w - layers[low]];
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
        const CellRows rows(extent_of(level.coords), level.coords);
        const NeighborFinder finder(level, rows, ways);
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
        fill_reverse(level, layers, result, begin, end);
    });
    return result;
}

}  // namespace fretwork
