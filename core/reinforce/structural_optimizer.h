// Stage 6: Algorithm 4. Decides which empty voxels must become solid.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/base/run_control.h"
#include "core/fem/force_profile.h"
#include "core/fem/material.h"
#include "core/shell/surface_voxels.h"

namespace fretwork {

enum class ReinforceRules {
    kPaper,    ///< order, scores and thresholds as printed in section 5.2
    kDefault,  ///< with the changes listed in docs/paper_map.md
};

struct ReinforceSettings {
    ReinforceRules rules = ReinforceRules::kDefault;
    double thickness_mm = 2.0;           ///< final wall, seen by the finite elements
    double inner_wall_mm = 0.0;          ///< how far the wall reaches inside the surface; 0: not at all
    double pattern_radius_voxels = 3.0;  ///< r_pattern; at least 1.5
    int samples = 1000;                  ///< |S|; the paper uses 500 to 1000
    double safety_factor = 2.0;          ///< allowable stress = strength_z / safety_factor
    double geodesic_factor = 1.5;        ///< of the extent; 0 switches the criterion off
    double soft_factor = 1e-3;           ///< rho_min
    double stress_ratio = 10.0;          ///< stop when max <= ratio x median frozen after connecting
    double material_budget = 0.15;       ///< voxels that may be added after connecting, share of the shell's
    int batch = 8;                       ///< bridges between two factorisations
    int max_iterations = 30;             ///< turns at most; the last one only connects and takes stock
    std::uint64_t seed = 1;
};

/// What one turn of Algorithm 1 did.
struct ReinforceRecord {
    int iteration = 0;
    std::size_t components_before = 0;  ///< of the solid voxels, over G_surface
    std::size_t specks_dropped = 0;
    std::size_t bridges_connect = 0;
    std::size_t bridges_stress = 0;
    std::size_t bridges_geodesic = 0;
    std::size_t voxels_added = 0;
    double max_score_pa = 0.0;  ///< over solid edges, before this turn's bridges against stress
    double p99_score_pa = 0.0;
    double median_score_pa = 0.0;
    double average_score_pa = 0.0;
    double max_geodesic = 0.0;  ///< in extents
    double allowable_pa = 0.0;
    bool connected = false;  ///< one piece per component of the input
    std::string
        stopped_by;  ///< empty while going on; else "limits met", "budget", "iterations", "no candidate", "no gain"
};

/// What solid edges of the abstract graph were found to bear, and where they run.
struct ScoredPaths {
    std::vector<double> scores_pa;     ///< one per solid edge
    std::vector<std::uint32_t> first;  ///< compressed rows into `voxels`: one more than edges, or none at all
    std::vector<VoxelIndex> voxels;    ///< along each edge, from sample to sample
};

struct ReinforceStep {
    std::vector<VoxelIndex> forced_solid;  ///< newly forced, ascending
    std::vector<VoxelIndex> dropped;       ///< solid voxels of specks too small to print, ascending
    /// Nothing is left that asks for resynthesis. What `forced_solid` and `dropped` still hold (voxels
    /// at contacts, bridges of the last iteration) is to be applied as it is; the result is in one firm
    /// piece per component of the input (`pattern_pieces.h`).
    bool done = false;
    ReinforceRecord record;
    ScoredPaths scored;  ///< what the record's figures of stress are of
};

/// STRUCTURALOPTIM. Keeps what does not change between turns (G_surface, its components and firm
/// links, all voxels forced so far, the frozen median, the budget spent). References must outlive it.
///
/// Ends  voxels once forced are solid for ever, whatever the caller passes; the turn number
///       `max_iterations` only connects and is always the last. Every turn, painted without
///       resynthesis, leaves one piece per component of the input.
/// Same in, same out for any number of threads.
class StructuralOptimizer {
  public:
    /// \param keep  one byte per voxel, nonzero for voxels whose solid state the user asked for: they are
    ///              never dropped as specks. May be empty.
    /// \throws InvalidSetting  a setting outside its range.
    /// \throws InvalidInput    an empty shell, `keep` of another length, a voxel of the profile past
    ///                         the end, a profile without a case.
    StructuralOptimizer(const SurfaceVoxels& shell, const ForceProfile& profile, const Material& material,
                        const ReinforceSettings& settings, std::vector<std::uint8_t> keep = {});
    ~StructuralOptimizer();
    StructuralOptimizer(StructuralOptimizer&&) noexcept;
    StructuralOptimizer& operator=(StructuralOptimizer&&) noexcept;

    /// One turn.
    /// \throws InvalidInput   `solid` is not as long as the shell.
    /// \throws SolverFailure  the finite elements could not be solved.
    /// \throws Cancelled      `run` asked to stop; the optimizer is as it was before the call.
    ReinforceStep step(const SolidStates& solid, const RunControl& run = {});

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace fretwork
