#include "core/enlarge/enlarge_features.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/base/error.h"
#include "core/enlarge/geodesic_links.h"
#include "core/enlarge/join_islands.h"
#include "core/enlarge/opening.h"
#include "core/enlarge/ridge_skeleton.h"
#include "core/enlarge/settle_widths.h"

namespace fretwork {
namespace {

constexpr const char* kStage = "enlarge";

/// The border is drawn later, between voxels, and may cut a little deeper than the states say: features are that much
/// wider here, in voxels, so that what is printed has the asked width.
constexpr double kDrawnSolidBorder = 0.5;

/// The same for holes. The drawn border leans towards the empty side, by a quarter of a voxel on each bank, and
/// distances along links are a little longer than the ways they stand for.
constexpr double kDrawnHoleBorder = 1.1;

std::string shortest(double value) {
    std::string text = std::to_string(value);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text;
}

/// Turns a width into voxels.
double checked_width(const SurfaceVoxels& shell, const char* name, double width_mm, double least_voxels) {
    if (!(width_mm > 0.0) || !std::isfinite(width_mm))
        throw InvalidSetting(std::string(name) + " = " + shortest(width_mm) + ": expected a width above 0 mm");
    const double voxel = shell.grid.voxel_mm;
    Vec3 low = shell.points_mm.front(), high = low;
    for (const Vec3& p : shell.points_mm) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    const double side_mm = (high - low).maxCoeff();
    if (width_mm < least_voxels * voxel * (1.0 - 1e-9))
        throw ConstraintsNotMet(std::string(name) + " = " + shortest(width_mm) + " mm is " +
                                shortest(width_mm / voxel) + " voxels of " + shortest(voxel) + " mm, under " +
                                shortest(least_voxels) + ": raise the resolution to " +
                                std::to_string(static_cast<long>(std::ceil(least_voxels * side_mm / width_mm))) +
                                " or the width to " + shortest(least_voxels * voxel) + " mm");
    if (width_mm > 0.5 * side_mm)
        throw ConstraintsNotMet(std::string(name) + " = " + shortest(width_mm) + " mm is over half of the object, " +
                                shortest(side_mm) + " mm: lower it to " + shortest(0.5 * side_mm) + " mm or less");
    return width_mm / voxel;
}

class Enlarger {
  public:
    Enlarger(const SurfaceVoxels& shell, const GeodesicLinks& links, const SolidStates& states,
             const std::vector<std::uint8_t>& protect, double feature_voxels, double hole_voxels, const RunControl& run)
        : shell_(shell),
          run_(run),
          links_(links),
          feature_(feature_voxels),
          hole_(hole_voxels),
          solid_(shell.size(), 0),
          may_fill_(shell.size(), 0),
          may_clear_(shell.size(), 0) {
        for (std::size_t v = 0; v < shell.size(); ++v) {
            solid_[v] = states[v] == SolidState::kSolid ? 1 : 0;
            const bool kept = !protect.empty() && protect[v] != 0;
            may_fill_[v] = solid_[v] == 0 && !kept ? 1 : 0;
            may_clear_[v] = kept ? 0 : 1;
        }
    }

    EnlargeResult run() {
        run_.checkpoint(kStage, 0.1);
        drop_specks();
        fill_bare_components();
        enlarge_skeleton();
        run_.checkpoint(kStage, 0.4);
        drop_hairs();
        fill_bare_components();
        run_.checkpoint(kStage, 0.5);
        const SettleCounts settled =
            settle_widths(shell_, links_, solid_, may_fill_, feature_, hole_, run_.slice(0.5, 1.0));
        result_.voxels_enlarged += settled.enlarged;
        result_.voxels_filled = settled.filled;
        result_.islands_joined = settled.joined;
        result_.components = settled.components;
        result_.solid.resize(shell_.size());
        for (std::size_t v = 0; v < shell_.size(); ++v)
            result_.solid[v] = solid_[v] != 0 ? SolidState::kSolid : SolidState::kEmpty;
        run_.checkpoint(kStage, 1.0);
        return std::move(result_);
    }

  private:
    [[nodiscard]] VoxelMask empty() const {
        VoxelMask mask(solid_.size());
        for (std::size_t v = 0; v < mask.size(); ++v) mask[v] = solid_[v] == 0 ? 1 : 0;
        return mask;
    }

    std::size_t make_solid(VoxelIndex v) {
        if (may_fill_[v] == 0) return 0;
        may_fill_[v] = 0;
        solid_[v] = 1;
        return 1;
    }

    void clear(std::size_t v) {
        solid_[v] = 0;
        may_fill_[v] = 1;
    }

    /// Loose pieces with less area than the smallest printable disc go, except the largest of a shell component.
    void drop_specks() {
        const FaceComponents pieces = face_components(shell_, solid_);
        std::vector<VoxelMask::value_type> stays(pieces.count(), 0);
        std::vector<std::uint32_t> shell_component(pieces.count(), 0);
        for (std::size_t v = 0; v < shell_.size(); ++v) {
            if (solid_[v] == 0) continue;
            shell_component[pieces.of_voxel[v]] = shell_.components[v];
            if (may_clear_[v] == 0) stays[pieces.of_voxel[v]] = 1;
        }
        std::vector<std::size_t> largest;
        for (std::size_t p = 0; p < pieces.count(); ++p) {
            if (largest.size() <= shell_component[p]) largest.resize(shell_component[p] + 1, pieces.count());
            std::size_t& best = largest[shell_component[p]];
            if (best == pieces.count() || pieces.area_voxels[p] > pieces.area_voxels[best]) best = p;
        }
        const double disc = std::numbers::pi / 4.0 * feature_ * feature_;
        for (std::size_t p = 0; p < pieces.count(); ++p) {
            if (pieces.area_voxels[p] >= disc || largest[shell_component[p]] == p) stays[p] = 1;
            if (stays[p] == 0) ++result_.islands_dropped;
        }
        for (std::size_t v = 0; v < shell_.size(); ++v)
            if (solid_[v] != 0 && stays[pieces.of_voxel[v]] == 0) clear(v);
    }

    /// A part of the object without any pattern, or too small for it, stays whole: it must not vanish.
    void fill_bare_components() {
        std::vector<std::uint8_t> bare;
        for (std::size_t v = 0; v < shell_.size(); ++v) {
            if (bare.size() <= shell_.components[v]) bare.resize(shell_.components[v] + 1, 1);
            if (solid_[v] != 0) bare[shell_.components[v]] = 0;
        }
        for (VoxelIndex v = 0; v < shell_.size(); ++v)
            if (bare[shell_.components[v]] != 0) result_.voxels_enlarged += make_solid(v);
    }

    void enlarge_skeleton() {
        const double radius = 0.5 * feature_;
        const VoxelMask outside = empty();
        const std::vector<float> to_empty = geodesic_distance(links_, outside, radius + 1.0, run_);
        const SkeletonSettings settings{
            .core_radius_voxels = radius - kWidthSlack,
            .shortest_leaf_voxels = feature_,
            // A ring of the printable width around a printable hole is not shorter.
            .shortest_loop_voxels = std::numbers::pi * (feature_ + hole_),
        };
        const VoxelMask skeleton =
            ridge_skeleton(shell_, solid_, to_empty, opened(links_, outside, to_empty, feature_, run_), settings, run_);
        const std::vector<float> to_skeleton = geodesic_distance(links_, skeleton, radius + kWidthSlack, run_);
        for (VoxelIndex v = 0; v < shell_.size(); ++v)
            if (to_skeleton[v] != kBeyondReach) result_.voxels_enlarged += make_solid(v);
    }

    /// What the skeleton has left thin are pruned leaves.
    void drop_hairs() {
        const VoxelMask outside = empty();
        const std::vector<float> to_empty = geodesic_distance(links_, outside, 0.5 * feature_ + 1.0, run_);
        const VoxelMask covered = opened(links_, outside, to_empty, feature_, run_);
        for (std::size_t v = 0; v < shell_.size(); ++v)
            if (solid_[v] != 0 && covered[v] == 0 && may_clear_[v] != 0) clear(v);
    }

    const SurfaceVoxels& shell_;
    const RunControl& run_;
    const GeodesicLinks& links_;
    double feature_;
    double hole_;
    VoxelMask solid_;
    VoxelMask may_fill_;
    VoxelMask may_clear_;
    EnlargeResult result_;
};

}  // namespace

EnlargeResult enlarge_features(const SurfaceVoxels& shell, const GeodesicLinks& links, const SolidStates& solid,
                               const std::vector<std::uint8_t>& protect, const EnlargeSettings& settings,
                               const RunControl& run) {
    if (shell.size() == 0) throw InvalidInput("enlarge: the shell has no voxels");
    if (solid.size() != shell.size() || (!protect.empty() && protect.size() != shell.size()))
        throw InvalidInput("enlarge: " + std::to_string(solid.size()) + " states and " +
                           std::to_string(protect.size()) + " marks for " + std::to_string(shell.size()) + " voxels");
    const double feature =
        checked_width(shell, "min_feature_mm", settings.min_feature_mm, settings.draft ? 0.0 : kLeastFeatureVoxels) +
        kDrawnSolidBorder;
    const double hole =
        checked_width(shell, "min_hole_mm", settings.min_hole_mm, settings.draft ? 0.0 : kLeastHoleVoxels) +
        kDrawnHoleBorder;
    run.checkpoint(kStage, 0.0);
    return Enlarger(shell, links, solid, protect, feature, hole, run).run();
}

}  // namespace fretwork
