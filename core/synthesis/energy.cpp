#include "core/synthesis/energy.h"

#include <algorithm>
#include <cmath>

namespace fretwork {

VoxelEnergy::VoxelEnergy(const SynthesisProblem& problem, const ProblemLevel& level)
    : problem_(problem),
      level_(level),
      distortion_weight_(static_cast<float>(problem.settings.distortion_weight)),
      border_weight_(problem.exemplar.tileable ? 0.0F : static_cast<float>(problem.settings.border_weight)),
      orientation_weight_(level.field.direction.empty() ? 0.0F
                                                        : static_cast<float>(problem.settings.orientation_weight)),
      pixels_per_voxel_(static_cast<float>(problem.settings.pixels_per_voxel)) {}

void VoxelEnergy::look_at(VoxelIndex v, const Choices& choices) {
    v_ = v;
    blocks_ = level_.shell->neighborhoods.of(v);
    count_ = level_.shell->neighborhoods.count[v];
    unit_of_penalty_ = problem_.settings.normalize_energy ? count_ : 1;
    problem_.kernels.view_neighbors(level_.texels, choices.data(), blocks_, count_, view_);
}

Energy VoxelEnergy::first_half(const TexelPosition& texel) const {
    const std::uint32_t color = problem_.color_at(level_, texel);
    std::int32_t square = 0, product = 0;
    for (int c = 0; c < 4; ++c) {
        const auto value = static_cast<std::int32_t>(color >> (8 * c) & 0xFFu);
        square += value * value;
        product += value * view_.expected_sum[c];
    }
    return static_cast<std::int32_t>(count_) * square - 2 * product + view_.expected_squares;
}

float VoxelEnergy::distortion(PlaneIndex plane) const {
    const float cosine = level_.shell->normals[v_].dot(problem_.planes.normal(plane));
    return distortion_weight_ * std::max(0.0F, 1.0F - cosine);
}

float VoxelEnergy::border(const TexelPosition& texel) const {
    if (border_weight_ <= 0.0F) return 0.0F;
    // Distance to the nearest border as a share of the period, by the symmetry of the two sides.
    const auto inside = [](std::uint32_t t) { return std::min(t, ~t); };
    const bool near = std::min(inside(texel.u), inside(texel.v)) < problem_.border_band;
    return near ? border_weight_ : 0.0F;
}

float VoxelEnergy::misorientation(const LinearPart& part) const {
    if (orientation_weight_ <= 0.0F) return 0.0F;
    const float cosine = -level_.field.direction[v_].dot(problem_.map.v_vector(part)) / pixels_per_voxel_;
    const float agreement = problem_.settings.symmetric ? std::fabs(cosine) : cosine;
    return orientation_weight_ * level_.field.certainty[v_] * std::max(0.0F, 1.0F - agreement);
}

Energy VoxelEnergy::weigh(float penalty) const {
    // NOLINTNEXTLINE(bugprone-incorrect-roundings): never below zero, and in the innermost loop
    return static_cast<Energy>(penalty * static_cast<float>(kEnergyUnit) + 0.5F) * unit_of_penalty_;
}

Energy VoxelEnergy::of(const Candidate& candidate, Energy first_half, Energy limit) const {
    const PlaneIndex plane = problem_.transforms.plane_of(candidate.label.linear);
    const Energy sure =
        first_half + weigh(distortion(plane) + border(candidate.texel) + misorientation(candidate.part));
    if (sure > limit) return sure;
    const Energy rest = std::min<Energy>(limit - sure, std::numeric_limits<std::int32_t>::max() / 2);
    return sure + problem_.kernels.disagreement(level_.texels, blocks_, count_, view_, candidate.texel, candidate.part,
                                                static_cast<std::int32_t>(rest));
}

double VoxelEnergy::scale() const {
    const bool per_neighbor = problem_.settings.normalize_energy && count_ > 0;
    return static_cast<double>(kEnergyUnit) * (per_neighbor ? count_ : 1.0);
}

}  // namespace fretwork
