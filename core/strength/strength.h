// Stage 10: does the carved object hold? Linear elasticity of all its voxels, by a method that shares nothing with the
// beams it was designed by but the element's formula (section 7 of the paper, Table 3).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/run_control.h"
#include "core/fem/material.h"
#include "core/fem/solid_elements.h"
#include "core/strength/solve_by.h"
#include "core/strength/voxel_loads.h"
#include "core/strength/voxel_model.h"

namespace fretwork {

struct StrengthSettings {
    Material material;
    double safety_factor = 2.0;         ///< that is asked for; above 0
    Vec3 layers = Vec3::UnitZ();        ///< direction in which the layers are stacked; any length
    SolveBy solver = SolveBy::kChoice;  ///< kChoice: by a factor below `factor_below_voxels`
    double tolerance = 1e-5;            ///< error in the energy norm; range 1e-12 to 0.1
    std::size_t factor_below_voxels = 10000;
    /// Of what the analysis makes, without the mesh; above 0.
    std::uint64_t max_memory_bytes = std::uint64_t{4} << 30;
    bool keep_fields = false;  ///< displacement and stress of every case
};

/// Of |s1| + |s2| + |s3| in the middles of voxels: the paper's score.
struct StressStatistics {
    double average_pa = 0.0, median_pa = 0.0, p99_pa = 0.0, max_pa = 0.0;
};

/// Whatever is stronger than this many times the load counts as this.
inline constexpr double kMostFactor = 1e6;

struct StrengthCase {
    std::string name;
    StressStatistics stress_sum;
    double max_von_mises_pa = 0.0;
    double max_displacement_mm = 0.0;
    double least_factor = kMostFactor;  ///< of safety
    Vec3 applied_n = Vec3::Zero();      ///< all forces
    Vec3 reaction_n = Vec3::Zero();     ///< of the supports: their opposite
    int iterations = 0;                 ///< 0: by a factor
    std::vector<Vec3> displacement_mm;  ///< per node, with keep_fields
    std::vector<Stress> stress_mpa;     ///< per voxel, in its middle, with keep_fields
};

/// The weakest voxel of a neighbourhood.
struct WeakPlace {
    Vec3 at_mm = Vec3::Zero();
    double factor = kMostFactor;  ///< of safety
    double stress_sum_pa = 0.0, von_mises_pa = 0.0;
    std::uint32_t load_case = 0;  ///< the one that is worst there
};

struct StrengthReport {
    double voxel_mm = 0.0;
    std::size_t voxels = 0, nodes = 0, pieces = 0, joining_voxels = 0;
    double volume_mm3 = 0.0, weight_n = 0.0;
    bool by_factor = false;
    std::size_t factor_bytes = 0;  ///< of the largest factor
    std::vector<StrengthCase> cases;
    StressStatistics stress_sum;        ///< over voxels, of the worst case in each
    double least_factor = kMostFactor;  ///< of safety, over voxels and cases
    double safety_factor = 0.0;         ///< that was asked for
    std::vector<WeakPlace> weakest;     ///< at most kMostWeakPlaces, the weakest first, each apart from all before it
    std::vector<float> worst_stress_sum_pa;  ///< per voxel, over cases
    std::vector<float> worst_factor;         ///< of safety, per voxel, over cases

    [[nodiscard]] bool holds() const { return least_factor >= safety_factor; }
};

inline constexpr std::size_t kMostWeakPlaces = 10;

/// Factor of safety of one state of stress: the least of what the material stands within a layer (von Mises against
/// strength_xy) and between layers (tension across and shear along them, sqrt(s^2 + 3 t^2), against strength_z).
double safety_factor_of(const Stress& stress_mpa, const Vec3& layers, const Material& material);

/// Element  8-node cube with Wilson's incompatible modes; stress in its middle.
/// Cases    those with equal supports share what is factored; three go side by side.
/// Places   two are the same when closer than 4 % of the longest side or three voxels.
/// Memory   see `memory_for`; a factor that would go beyond ends in MemoryLimit.
/// Bits     do not depend on the number of threads.
/// Cost     300,000 voxels of a carved figure and three cases: docs/benchmarks.md.
/// \param cases  at least one
/// \throws InvalidSetting  no case; a setting or material out of range.
/// \throws MemoryLimit     it would take more than `max_memory_bytes`.
/// \throws SolverFailure   no convergence.
/// \throws Cancelled       `run` asked to stop; within 0.2 s.
StrengthReport analyze_strength(const VoxelModel& model, const std::vector<VoxelCase>& cases,
                                const StrengthSettings& settings, const RunControl& run = {});

/// What the analysis takes without its factor: known from the size of the model.
std::uint64_t memory_for(const VoxelModel& model, std::size_t cases);

}  // namespace fretwork
