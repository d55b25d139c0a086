// K of Algorithm 3: the labels tried for a voxel.
#pragma once

#include <cstdint>
#include <vector>

#include "core/synthesis/forced_solid.h"
#include "core/synthesis/synthesis_problem.h"

namespace fretwork {

/// A label seen from the voxel that might take it.
struct Candidate {
    Label label;
    LinearPart part;
    TexelPosition texel;
};

/// The neighbour's label carried to the plane that fits the voxel: the picture keeps its axes and
/// shows at the neighbour what the neighbour shows. `offset` leads from the voxel to the neighbour.
Candidate transported_candidate(const SynthesisProblem& problem, const ProblemLevel& level, VoxelIndex v,
                                const Choice& neighbor, const LevelOffset& offset);

/// The neighbour's label shifted by the least amount that makes the voxel's probe solid. Nothing is
/// promised where the feature distance has its ridges; the caller looks at the mask.
Candidate snapped_candidate(const SynthesisProblem& problem, const ProblemLevel& level, VoxelIndex v,
                            const FixedPoint& probe, const Choice& neighbor);

/// Random candidates in steps, as most fail by the texel alone, and most others by the plane: first the
/// texel, then the plane, then the rotation and the label that shows the texel. All from 64 bits.
class RandomCandidates {
  public:
    RandomCandidates(const SynthesisProblem& problem, const ProblemLevel& level);

    /// Any position of the exemplar.
    [[nodiscard]] static TexelPosition texel(std::uint64_t bits);
    /// A position in the solid part, half of the time in its deeper half.
    [[nodiscard]] TexelPosition solid_texel(std::uint64_t bits) const;
    /// The plane closest to a random direction in the cone around the voxel's normal.
    [[nodiscard]] PlaneIndex plane(VoxelIndex v, std::uint64_t bits) const;
    /// The label in `plane` that shows `texel` at `p`, turned to follow the orientation field.
    [[nodiscard]] Candidate candidate(VoxelIndex v, PlaneIndex plane, const TexelPosition& texel, const FixedPoint& p,
                                      std::uint64_t bits) const;

  private:
    [[nodiscard]] std::uint32_t rotation(VoxelIndex v, PlaneIndex plane, std::uint64_t bits) const;

    const SynthesisProblem& problem_;
    const ProblemLevel& level_;
    float cone_height_;  // 1 - cos(cone)
    std::vector<float> cosine_, sine_;
};

}  // namespace fretwork
