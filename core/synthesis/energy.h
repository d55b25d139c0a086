// E of the paper, section 4.2.2, at one voxel, as an integer.
#pragma once

#include <cstdint>
#include <limits>

#include "core/synthesis/candidates.h"
#include "core/synthesis/forced_solid.h"
#include "core/synthesis/synthesis_problem.h"

namespace fretwork {

/// Energies count squared steps of 8-bit channels: a difference of one full channel is 255^2.
using Energy = std::int64_t;
inline constexpr Energy kEnergyUnit = 255 * 255;
inline constexpr Energy kNoEnergy = std::numeric_limits<Energy>::max();

/// Weighs candidates for one voxel against its neighbours as they are.
///
/// E_transition has two halves. In the first, what the neighbours expect at v does not depend on the
/// candidate: with N neighbours, S the sum and Q the sum of squares of their expectations it is
/// N |c|^2 - 2 c.S + Q for a candidate of colour c. Only the second needs a look-up per neighbour.
class VoxelEnergy {
  public:
    VoxelEnergy(const SynthesisProblem& problem, const ProblemLevel& level);

    /// Moves to voxel v.
    void look_at(VoxelIndex v, const Choices& choices);

    [[nodiscard]] const NeighborView& view() const { return view_; }
    [[nodiscard]] std::uint32_t neighbors() const { return count_; }
    [[nodiscard]] const NeighborBlock& block(std::uint32_t i) const { return blocks_[i / 8]; }

    /// Lower bounds from what is known of a random candidate before its label is made: the first half
    /// of the transition energy and the border, and with the plane the distortion too.
    /// \param first_half  of `texel`
    [[nodiscard]] Energy bound(const TexelPosition& texel, Energy first_half) const {
        return first_half + weigh(border(texel));
    }
    [[nodiscard]] Energy bound(const TexelPosition& texel, Energy first_half, PlaneIndex plane) const {
        return first_half + weigh(distortion(plane) + border(texel));
    }

    /// The energy of a candidate, or some value above `limit` if it exceeds that.
    [[nodiscard]] Energy of(const Candidate& candidate, Energy limit) const {
        return of(candidate, first_half(candidate.texel), limit);
    }
    /// The same where the first half of the transition energy is known.
    [[nodiscard]] Energy of(const Candidate& candidate, Energy first_half, Energy limit) const;

    /// Of the transition energy, where a candidate shows `texel` at the voxel.
    [[nodiscard]] Energy first_half(const TexelPosition& texel) const;

    /// Divisor that turns the energy of this voxel into the units of the paper.
    [[nodiscard]] double scale() const;

  private:
    [[nodiscard]] float distortion(PlaneIndex plane) const;
    [[nodiscard]] float border(const TexelPosition& texel) const;
    [[nodiscard]] float misorientation(const LinearPart& part) const;
    [[nodiscard]] Energy weigh(float penalty) const;

    const SynthesisProblem& problem_;
    const ProblemLevel& level_;
    float distortion_weight_, border_weight_, orientation_weight_;
    float pixels_per_voxel_;
    Energy unit_of_penalty_ = 1;  // |N(v)| where the sum is divided by it in the end
    VoxelIndex v_ = 0;
    const NeighborBlock* blocks_ = nullptr;
    std::uint32_t count_ = 0;
    NeighborView view_;
};

}  // namespace fretwork
