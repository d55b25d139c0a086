// Stage 10b: cells of 2 x 2 x 2 voxels, which carry what the smoother leaves. Internal to this folder and its tests.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/base/run_control.h"
#include "core/strength/factored_system.h"
#include "core/strength/fine_level.h"

namespace fretwork {

/// A cell is solid where any of its voxels is; its corners move, and the nodes inside follow trilinearly. Two cells
/// share a corner only where a chain of shared nodes of the fine level joins them there: strands that run past each
/// other stay apart, whatever the distance. The matrix is P^T K P exactly, summed cell by cell.
class CoarseLevel {
  public:
    /// \param fixed  per node of the fine level
    /// \throws MemoryLimit, Cancelled  see FactoredSystem
    CoarseLevel(const VoxelModel& model, const CubeElement& cube, const std::vector<std::uint8_t>& fixed,
                const std::vector<Slab>& slabs, std::size_t most_bytes, const RunControl& run);

    [[nodiscard]] std::int64_t rows() const { return system_->rows(); }
    [[nodiscard]] std::size_t factor_bytes() const { return system_->factor_bytes(); }

    /// P^T r, in a column for `solve`.
    [[nodiscard]] Eigen::VectorXd restricted(const NodeValues<float>& r) const;
    /// One column per right-hand side.
    [[nodiscard]] Eigen::MatrixXd solve(Eigen::MatrixXd loads, const RunControl& run) const {
        return system_->solve(std::move(loads), run);
    }
    /// d = P e; 0 where nodes are fixed.
    void prolonged(const Eigen::Ref<const Eigen::VectorXd>& e, NodeValues<float>& d) const;

  private:
    struct Follow {
        std::uint32_t cell;
        std::uint8_t place;  ///< x + 3 y + 9 z in half cells; kHeld where the node is fixed
    };
    static constexpr std::uint8_t kHeld = 27;

    std::vector<std::array<NodeIndex, 8>> corners_;  ///< of each cell, by bits x, y, z
    std::vector<Follow> follow_;                     ///< per node of the fine level
    std::vector<Slab> slabs_;
    std::unique_ptr<FactoredSystem> system_;
};

}  // namespace fretwork
