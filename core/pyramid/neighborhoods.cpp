#include "core/pyramid/neighborhoods.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/parallel.h"

namespace fretwork {
namespace {

constexpr std::size_t kGrain = 1024;
constexpr std::size_t kReverseGrain = 8192;
// Pairs whose normals, and all on the way, have at least this cosine lie on a smooth piece of the surface.
constexpr float kSmoothCosine = 0.8F;
// Marks a pair that needs its way unfolded, in the top bit of the neighbour's index.
constexpr std::uint32_t kCreased = 0x80000000u;

struct Window {
    VoxelIndex begin;
    VoxelIndex end;
};

// Where each layer of cells starts; entries are sorted by z first.
class Layers {
  public:
    explicit Layers(std::span<const VoxelCoord> coords)
        : coords_(coords), first_(static_cast<std::size_t>(coords.back()[2]) + 2, 0) {
        for (const VoxelCoord& c : coords) ++first_[static_cast<std::size_t>(c[2]) + 1];
        for (std::size_t z = 0; z + 1 < first_.size(); ++z) first_[z + 1] += first_[z];
    }

    /// All entries that may be neighbours of those in [begin, end).
    [[nodiscard]] Window around(std::size_t begin, std::size_t end) const {
        const int low = std::max(0, coords_[begin][2] - 2);
        const int high = std::min(static_cast<int>(first_.size()) - 1, coords_[end - 1][2] + 3);
        return {first_[static_cast<std::size_t>(low)], first_[static_cast<std::size_t>(high)]};
    }

  private:
    std::span<const VoxelCoord> coords_;
    std::vector<VoxelIndex> first_;
};

std::vector<float> cosines_of_links(const PyramidLevel& level) {
    std::vector<float> cosine(level.adjacency.neighbor.size());
    parallel_for(level.size(), kGrain, [&](std::size_t v) {
        for (std::uint32_t e = level.adjacency.first[v]; e < level.adjacency.first[v + 1]; ++e)
            cosine[e] = level.normals[v].dot(level.normals[level.adjacency.neighbor[e]]);
    });
    return cosine;
}

// Lists N(v) for a run of entries.
class NeighborFinder {
  public:
    NeighborFinder(const PyramidLevel& level, std::span<const float> cosine, Window window)
        : level_(level), cosine_(cosine), window_(window), slot_(window.end - window.begin, 0) {}

    /// Appends the neighbours of `v`, ascending, with the mark kCreased where it applies.
    void append(VoxelIndex v, std::vector<std::uint32_t>& neighbors) {
        found_.clear();
        const Adjacency& links = level_.adjacency;
        slot_[v - window_.begin] = kSelf;
        for (std::uint32_t e = links.first[v]; e < links.first[v + 1]; ++e)
            if (cosine_[e] >= kTurningRoundCosine) note(links.neighbor[e], cosine_[e]);
        for (std::uint32_t e = links.first[v]; e < links.first[v + 1]; ++e) {
            if (cosine_[e] < kTurningRoundCosine) continue;
            const VoxelIndex u = links.neighbor[e];
            for (std::uint32_t f = links.first[u]; f < links.first[u + 1]; ++f)
                if (cosine_[f] >= kTurningRoundCosine) note(links.neighbor[f], std::min(cosine_[e], cosine_[f]));
        }
        std::sort(found_.begin(), found_.end(), [](const Found& a, const Found& b) { return a.neighbor < b.neighbor; });
        for (const Found& f : found_) {
            const bool smooth = best_[slot_[f.neighbor - window_.begin] - 1u] >= kSmoothCosine &&
                                level_.normals[v].dot(level_.normals[f.neighbor]) >= kSmoothCosine;
            neighbors.push_back(smooth ? f.neighbor : f.neighbor | kCreased);
            slot_[f.neighbor - window_.begin] = 0;
        }
        slot_[v - window_.begin] = 0;
        best_.clear();
    }

  private:
    struct Found {
        VoxelIndex neighbor;
    };
    static constexpr std::uint32_t kSelf = 0xffffffffu;

    void note(VoxelIndex w, float cosine) {
        std::uint32_t& slot = slot_[w - window_.begin];
        if (slot == 0) {
            found_.push_back({w});
            best_.push_back(cosine);
            slot = static_cast<std::uint32_t>(best_.size());
        } else if (slot != kSelf) {
            best_[slot - 1] = std::max(best_[slot - 1], cosine);
        }
    }

    const PyramidLevel& level_;
    std::span<const float> cosine_;
    Window window_;
    std::vector<std::uint32_t> slot_;  // position in best_ plus one, per entry of the window
    std::vector<Found> found_;
    std::vector<float> best_;  // least bent way found: its smaller cosine
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
    Unfolder(const PyramidLevel& level, std::span<const float> cosine) : level_(level), cosine_(cosine) {}

    /// For pairs on a smooth piece of the surface.
    [[nodiscard]] Vec3f over_smooth(VoxelIndex v, VoxelIndex w) const {
        // Chord 2 sin(a / 2) against arc a, where the normals turn by a: their ratio is 1 + (1 - cos a) / 12
        // up to a^4.
        const float arc = 1.0F + (1.0F - level_.normals[v].dot(level_.normals[w])) / 12.0F;
        return lay_flat(level_.positions[w] - level_.positions[v], level_.normals[v]) * arc;
    }

    /// For all others.
    [[nodiscard]] Vec3f over_crease(VoxelIndex v, VoxelIndex w) const {
        // A rounded edge is followed in two steps; a sharp one is a hinge.
        const Way way = least_bent_way(v, w);
        if (way.cosine < kSmoothCosine)
            if (const std::optional<Vec3f> hinged = around_hinge(v, w)) return *hinged;
        if (way.between == v) return one_step(v, w);
        return one_step(v, way.between) +
               carry(one_step(way.between, w), level_.normals[way.between], level_.normals[v]);
    }

  private:
    [[nodiscard]] Vec3f one_step(VoxelIndex v, VoxelIndex w) const {
        if (level_.normals[v].dot(level_.normals[w]) < kSmoothCosine)
            if (const std::optional<Vec3f> hinged = around_hinge(v, w)) return *hinged;
        return over_smooth(v, w);
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

    struct Way {
        VoxelIndex between;  // entry in the middle of two steps, or where they start for the direct link
        float cosine;        // the smaller of the steps
    };

    [[nodiscard]] Way least_bent_way(VoxelIndex v, VoxelIndex w) const {
        const Adjacency& links = level_.adjacency;
        Way best = {v, cosine_between(v, w)};
        for (std::uint32_t e = links.first[v]; e < links.first[v + 1]; ++e) {
            const float cosine = std::min(cosine_[e], cosine_between(links.neighbor[e], w));
            if (cosine > best.cosine) best = {links.neighbor[e], cosine};
        }
        return best;
    }

    // Cosine of the link between the two, -1 where there is none.
    [[nodiscard]] float cosine_between(VoxelIndex v, VoxelIndex w) const {
        const auto row = level_.adjacency.of(v);
        const auto at = std::lower_bound(row.begin(), row.end(), w);
        if (at == row.end() || *at != w) return -1.0F;
        return cosine_[level_.adjacency.first[v] + static_cast<std::size_t>(at - row.begin())];
    }

    const PyramidLevel& level_;
    std::span<const float> cosine_;
};

// Entries are visited in ascending order, so the places they take in the row of a neighbour follow each other.
void fill_reverse(const Layers& layers, Neighborhoods& n, std::size_t begin, std::size_t end) {
    const Window window = layers.around(begin, end);
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
    const Layers layers(level.coords);
    const std::vector<float> cosine = cosines_of_links(level);

    std::vector<std::vector<std::uint32_t>> chunks((level.size() + kGrain - 1) / kGrain);
    parallel_chunks(level.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        run.throw_if_stopped();
        std::vector<std::uint32_t>& all = chunks[begin / kGrain];
        all.reserve(40 * (end - begin));
        NeighborFinder finder(level, cosine, layers.around(begin, end));
        for (std::size_t v = begin; v < end; ++v) {
            const std::size_t before = all.size();
            finder.append(static_cast<VoxelIndex>(v), all);
            result.first[v + 1] = static_cast<std::uint32_t>(all.size() - before);
        }
    });
    for (std::size_t v = 0; v < level.size(); ++v) result.first[v + 1] += result.first[v];

    result.neighbor.resize(result.first.back());
    result.offset.resize(result.first.back());
    result.reverse.resize(result.first.back());
    const Unfolder unfolder(level, cosine);
    parallel_chunks(level.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        run.throw_if_stopped();
        const std::vector<std::uint32_t>& all = chunks[begin / kGrain];
        std::uint32_t i = result.first[begin];
        for (std::size_t v = begin; v < end; ++v)
            for (; i < result.first[v + 1]; ++i) {
                const std::uint32_t marked = all[i - result.first[begin]];
                const VoxelIndex w = marked & ~kCreased;
                result.neighbor[i] = w;
                result.offset[i] = marked == w ? unfolder.over_smooth(static_cast<VoxelIndex>(v), w)
                                               : unfolder.over_crease(static_cast<VoxelIndex>(v), w);
            }
        chunks[begin / kGrain] = {};
    });
    parallel_chunks(level.size(), kReverseGrain, [&](std::size_t begin, std::size_t end) {
        run.throw_if_stopped();
        fill_reverse(layers, result, begin, end);
    });
    return result;
}

}  // namespace fretwork
