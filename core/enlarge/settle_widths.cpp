#include "core/enlarge/settle_widths.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include "core/base/disjoint_sets.h"
#include "core/enlarge/join_islands.h"
#include "core/enlarge/opening.h"

namespace fretwork {
namespace {

class Settler {
  public:
    Settler(const SurfaceVoxels& shell, const GeodesicLinks& links, VoxelMask& solid, VoxelMask& may_fill,
            double feature_voxels, double hole_voxels, const RunControl& run)
        : shell_(shell),
          links_(links),
          solid_(solid),
          may_fill_(may_fill),
          feature_(feature_voxels),
          hole_(hole_voxels),
          run_(run),
          disc_(links),
          pieces_(shell.size()) {
        std::vector<std::uint8_t> carries;
        for (VoxelIndex v = 0; v < shell.size(); ++v) {
            if (solid_[v] == 0) continue;
            take_in(v);
            if (carries.size() <= shell.components[v]) carries.resize(shell.components[v] + 1, 0);
            carries[shell.components[v]] = 1;
        }
        least_pieces_ = static_cast<std::size_t>(std::count(carries.begin(), carries.end(), 1));
    }

    SettleCounts run() {
        double done = 0.0;
        for (bool changed = true; changed;) {
            changed = join_pieces();
            changed = fill_narrow_holes() || changed;
            changed = widen_thin_places() || changed;
            done += 0.5 * (1.0 - done);
            run_.checkpoint("enlarge", done);
        }
        counts_.components = piece_count_;
        return counts_;
    }

  private:
    /// Where in `grown_` an operation stood when it looked last; none: it never has.
    using Mark = std::optional<std::size_t>;

    std::size_t make_solid(VoxelIndex v) {
        if (may_fill_[v] == 0) return 0;
        may_fill_[v] = 0;
        solid_[v] = 1;
        grown_.push_back(v);
        take_in(v);
        return 1;
    }

    /// Keeps count of the pieces that hold by faces.
    void take_in(VoxelIndex v) {
        ++piece_count_;
        for (const VoxelIndex u : shell_.adjacency.of(v))
            if (solid_[u] != 0 && share_face(shell_, u, v) && pieces_.unite(u, v)) --piece_count_;
    }

    /// What lies within reach of what has become solid since `mark`, which moves on.
    [[nodiscard]] Nearby changed_since(Mark& mark, double reach_voxels) const {
        const Mark before = std::exchange(mark, grown_.size());
        if (!before) return {};
        VoxelMask changed(shell_.size(), 0);
        for (std::size_t i = *before; i < grown_.size(); ++i) changed[grown_[i]] = 1;
        return Nearby(geodesic_distance(links_, changed, reach_voxels, run_));
    }

    /// Hinges that there may be: at all voxels, or at those that have become solid and their neighbours.
    [[nodiscard]] std::vector<VoxelIndex> hinge_candidates() {
        const Mark before = std::exchange(hinges_seen_, grown_.size());
        std::vector<VoxelIndex> near;
        if (!before) {
            for (VoxelIndex v = 0; v < shell_.size(); ++v)
                if (solid_[v] != 0) near.push_back(v);
            return near;
        }
        for (std::size_t i = *before; i < grown_.size(); ++i) {
            near.push_back(grown_[i]);
            for (const VoxelIndex u : shell_.adjacency.of(grown_[i]))
                if (solid_[u] != 0) near.push_back(u);
        }
        std::sort(near.begin(), near.end());
        near.erase(std::unique(near.begin(), near.end()), near.end());
        return near;
    }

    bool join_pieces() {
        std::size_t added = 0;
        for (const VoxelIndex v : hinge_fillers(shell_, solid_, may_fill_, hinge_candidates())) added += make_solid(v);
        if (piece_count_ > least_pieces_) {
            const IslandLinks links = link_islands(shell_, face_components(shell_, solid_), may_fill_, run_);
            for (const VoxelIndex v : links.path)
                disc_.visit(v, 0.5 * feature_ + kWidthSlack, [&](VoxelIndex u, float) { added += make_solid(u); });
            if (added > 0) counts_.joined += links.joined;
        }
        counts_.enlarged += added;
        return added > 0;
    }

    /// A voxel's hole is narrow or not by what is solid within the width of a hole.
    bool fill_narrow_holes() {
        const double asked = hole_ + kMargin, known = asked + 0.5 * hole_, measured = 0.5 * hole_ + kMargin;
        const Nearby near = changed_since(holes_seen_, known + measured);
        VoxelMask sources = solid_;
        for (std::size_t v = 0; v < sources.size(); ++v)
            if (!near.holds(v, known + measured)) sources[v] = 0;
        const std::vector<float> to_solid = geodesic_distance(links_, sources, measured, run_);
        const VoxelMask wide = opened(links_, solid_, to_solid, hole_, run_, near, known);
        std::size_t added = 0;
        for (VoxelIndex v = 0; v < shell_.size(); ++v)
            if (solid_[v] == 0 && wide[v] == 0 && near.holds(v, asked)) added += make_solid(v);
        counts_.filled += added;
        return added > 0;
    }

    /// Filled corners and kept regions may be thin; each such voxel gets a disc, centred within reach where the
    /// solid is already widest.
    bool widen_thin_places() {
        const double asked = feature_ + kMargin, known = asked + 0.5 * feature_, measured = 0.5 * feature_ + kMargin;
        const Nearby near = changed_since(widths_seen_, known + measured);
        VoxelMask outside(solid_.size()), sources(solid_.size());
        for (std::size_t v = 0; v < outside.size(); ++v) {
            outside[v] = solid_[v] == 0 ? 1 : 0;
            sources[v] = outside[v] != 0 && near.holds(v, known + measured) ? 1 : 0;
        }
        const std::vector<float> to_empty = geodesic_distance(links_, sources, measured, run_);
        VoxelMask covered = opened(links_, outside, to_empty, feature_, run_, near, known);
        std::size_t added = 0;
        for (VoxelIndex v = 0; v < shell_.size(); ++v)
            if (outside[v] == 0 && covered[v] == 0 && near.holds(v, asked))
                added += widen(v, outside, to_empty, covered);
        counts_.enlarged += added;
        return added > 0;
    }

    std::size_t widen(VoxelIndex v, const VoxelMask& outside, const std::vector<float>& to_empty, VoxelMask& covered) {
        run_.throw_if_stopped();
        const double radius = 0.5 * feature_;
        VoxelIndex center = v;
        disc_.visit(v, radius - 2.0 * kWidthSlack, [&](VoxelIndex u, float) {
            if (outside[u] == 0 && to_empty[u] > to_empty[center]) center = u;
        });
        std::size_t added = 0;
        disc_.visit(center, radius + kWidthSlack, [&](VoxelIndex u, float d) {
            added += make_solid(u);
            if (d < radius - kWidthSlack) covered[u] = 1;
        });
        return added;
    }

    /// Voxels that distances are followed for beyond what is compared with them.
    static constexpr double kMargin = 1.0;

    const SurfaceVoxels& shell_;
    const GeodesicLinks& links_;
    VoxelMask& solid_;
    VoxelMask& may_fill_;
    double feature_, hole_;
    const RunControl& run_;
    GeodesicDisc disc_;
    DisjointSets pieces_;
    std::size_t piece_count_ = 0;
    std::size_t least_pieces_ = 0;   ///< components of the shell that carry any
    std::vector<VoxelIndex> grown_;  ///< in the order in which they became solid
    Mark hinges_seen_, holes_seen_, widths_seen_;
    SettleCounts counts_;
};

}  // namespace

SettleCounts settle_widths(const SurfaceVoxels& shell, const GeodesicLinks& links, VoxelMask& solid,
                           VoxelMask& may_fill, double feature_voxels, double hole_voxels, const RunControl& run) {
    return Settler(shell, links, solid, may_fill, feature_voxels, hole_voxels, run).run();
}

}  // namespace fretwork
