// Stage 10d: displacements -> stress, factors of safety, weakest places. Internal to this folder and its tests.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/strength/fine_level.h"
#include "core/strength/strength.h"

namespace fretwork {

/// Keeps the worst of all cases for every voxel.
class VoxelJudge {
  public:
    /// \param center_stress  corners' displacements -> stress in the middle of a voxel, MPa
    VoxelJudge(const VoxelModel& model, Eigen::Matrix<double, 6, 24> center_stress, const StrengthSettings& settings);

    /// Fills in what a case's displacements tell.
    void add_case(const NodeValues<double>& displacement_mm, std::uint32_t number, StrengthCase& result);

    /// Fills in what all cases together tell.
    void conclude(StrengthReport& report) const;

  private:
    struct Worst {
        float factor = static_cast<float>(kMostFactor);
        float stress_sum_pa = 0.0F;  ///< largest over cases, whichever has the least factor
        float von_mises_pa = 0.0F;
        std::uint32_t load_case = 0;
    };
    [[nodiscard]] std::vector<WeakPlace> weakest_places() const;

    const VoxelModel& model_;
    Eigen::Matrix<double, 6, 24> center_stress_;
    const StrengthSettings& settings_;
    std::vector<Worst> worst_;
};

double von_mises(const Stress& stress);

/// Average, median, 99th percentile (nearest rank) and maximum. \param values  at least one
StressStatistics statistics_of(std::vector<float> values);

}  // namespace fretwork
