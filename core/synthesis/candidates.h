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

/// A label that neighbours have chosen.
struct CoherentLabel {
    Label label;
    std::uint32_t votes = 0;
    std::uint32_t first_seen = 0;  ///< position in the voxel's list of neighbours
};

/// The distinct labels of a voxel's neighbours, most votes first, then by label. Owns its memory, so
/// that one object serves many voxels without allocating.
class CoherentLabels {
  public:
    CoherentLabels();
    void collect(const NeighborView& view, std::uint32_t count);
    [[nodiscard]] const std::vector<CoherentLabel>& labels() const { return labels_; }

  private:
    static constexpr std::uint32_t kSlots = 512;
    std::vector<std::uint16_t> slot_;  // position in labels_ plus one
    std::vector<std::uint32_t> used_;
    std::vector<CoherentLabel> labels_;
};

/// The neighbour's label, as it stands.
Candidate coherent_candidate(const SynthesisProblem& problem, const ProblemLevel& level, VoxelIndex v,
                             const Choice& neighbor);

/// The neighbour's label carried to the plane that fits the voxel: the picture keeps its axes and
/// shows at the neighbour what the neighbour shows. `offset` leads from the voxel to the neighbour.
Candidate transported_candidate(const SynthesisProblem& problem, const ProblemLevel& level, VoxelIndex v,
                                const Choice& neighbor, const LevelOffset& offset);

/// The neighbour's label shifted by the least amount that makes the voxel's probe solid. Nothing is
/// promised where the feature distance has its ridges; the caller looks at the mask.
Candidate snapped_candidate(const SynthesisProblem& problem, const ProblemLevel& level, VoxelIndex v,
                            const FixedPoint& probe, const Choice& neighbor);

/// Draws the plane and the texel of random candidates, and the rest of the label only on demand, as
/// most candidates fail by these two.
class RandomCandidates {
  public:
    RandomCandidates(const SynthesisProblem& problem, const ProblemLevel& level);

    struct Draw {
        PlaneIndex plane = 0;
        TexelPosition texel;  ///< at the voxel, or at its probe
        std::uint64_t bits = 0;
    };

    /// Plane within the cone around the normal; texel anywhere.
    [[nodiscard]] Draw draw(VoxelIndex v, std::uint64_t bits) const;
    /// Texel in the solid part, one half of the time in its deeper half.
    [[nodiscard]] Draw draw_solid(VoxelIndex v, std::uint64_t bits) const;

    /// The label that shows the texel at `p`, turned to follow the orientation field.
    [[nodiscard]] Candidate finish(VoxelIndex v, const Draw& draw, const FixedPoint& p) const;

  private:
    [[nodiscard]] PlaneIndex plane_in_cone(VoxelIndex v, std::uint64_t bits) const;
    [[nodiscard]] std::uint32_t rotation(VoxelIndex v, PlaneIndex plane, std::uint64_t bits) const;

    const SynthesisProblem& problem_;
    const ProblemLevel& level_;
    float cone_height_;  // 1 - cos(cone)
    std::vector<float> cosine_, sine_;
};

}  // namespace fretwork
