// Everything about one synthesis that stays the same while labels change.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/run_control.h"
#include "core/exemplar/exemplar.h"
#include "core/exemplar/gaussian_stack.h"
#include "core/pyramid/voxel_pyramid.h"
#include "core/synthesis/choice.h"
#include "core/synthesis/mismatch.h"
#include "core/synthesis/orientation_field.h"
#include "core/synthesis/plane_set.h"
#include "core/synthesis/plane_transforms.h"
#include "core/synthesis/subpasses.h"
#include "core/synthesis/synthesizer.h"

namespace fretwork {

/// One level of the pyramid, prepared.
struct ProblemLevel {
    const PyramidLevel* shell = nullptr;
    int index = 0;   ///< in the pyramid, 0 finest
    int rank = 0;    ///< `index` and the finer levels that are left out: how fine the level is for the run
    int height = 0;  ///< counted from the coarsest level of the pyramid, so that a draft and its full run agree
    TexelLevel texels;
    std::vector<FixedPoint> points;
    std::vector<PlaneIndex> best_plane;  ///< nearest to the normal
    OrientationField field;              ///< empty when every rotation is as good as any other
    Subpasses subpasses;

    [[nodiscard]] std::size_t size() const { return points.size(); }

    /// Names a voxel by its place, which is the same in a draft and in the full run: the cell, and how many entries
    /// of this cell come before. For random numbers.
    [[nodiscard]] std::uint64_t place(VoxelIndex v) const;
};

/// Texels of the solid part, in row order, and those of them deeper inside than the median.
struct SolidTexels {
    std::vector<std::uint32_t> all;
    std::vector<std::uint32_t> deep;
};

struct SynthesisProblem {
    SynthesisProblem(const VoxelPyramid& shells, const Exemplar& picture, const SynthesisSettings& chosen);
    SynthesisProblem(const SynthesisProblem&) = delete;
    SynthesisProblem& operator=(const SynthesisProblem&) = delete;

    /// Fills the levels; the costly part of the preparation.
    void prepare(const RunControl& run);

    [[nodiscard]] std::uint32_t color_at(const ProblemLevel& level, const TexelPosition& t) const {
        return level.texels.texels[map.pixel(t)];
    }
    [[nodiscard]] bool solid_at(const TexelPosition& t) const { return exemplar.solid[map.pixel(t)] != 0; }

    /// A choice with all that follows from the label at point p.
    [[nodiscard]] Choice make_choice(const ProblemLevel& level, const Label& label, const LinearPart& part,
                                     const FixedPoint& p) const;

    const VoxelPyramid& pyramid;
    const Exemplar& exemplar;
    SynthesisSettings settings;
    TexelMap map;
    PlaneSet planes;
    PlaneTransforms transforms;
    std::uint32_t border_band;  ///< share of the period, 2^32 = 1
    GaussianStack stack;
    SolidTexels solid_texels;
    const MismatchKernels& kernels;
    std::vector<ProblemLevel> levels;  ///< finest first, up to the start level
};

}  // namespace fretwork
