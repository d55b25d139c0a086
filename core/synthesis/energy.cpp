#include "core/synthesis/energy.h"

#include <algorithm>
#include <cmath>

namespace fretwork {

void VoxelEnergy::look_at(VoxelIndex v, const Choices& choices) {
    v_ = v;
    blocks_ = level_.neighbors.blocks.data() + level_.neighbors.first[v];
    count_ = level_.neighbors.count[v];
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
    return static_cast<float>(problem_.settings.distortion_weight) * std::max(0.0F, 1.0F - cosine);
}

float VoxelEnergy::border(const TexelPosition& texel) const {
    if (problem_.exemplar.tileable) return 0.0F;
    // Distance to the nearest border as a share of the period, by the symmetry of the two sides.
    const auto inside = [](std::uint32_t t) { return std::min(t, ~t); };
    const bool near = std::min(inside(texel.u), inside(texel.v)) < problem_.border_band;
    return near ? static_cast<float>(problem_.settings.border_weight) : 0.0F;
}

float VoxelEnergy::misorientation(const LinearPart& part) const {
    if (level_.field.direction.empty() || problem_.settings.orientation_weight <= 0.0) return 0.0F;
    const float cosine = -level_.field.direction[v_].dot(problem_.map.v_vector(part)) /
                         static_cast<float>(problem_.settings.pixels_per_voxel);
    const float agreement = problem_.settings.symmetric ? std::fabs(cosine) : cosine;
    return static_cast<float>(problem_.settings.orientation_weight) * level_.field.certainty[v_] *
           std::max(0.0F, 1.0F - agreement);
}

Energy VoxelEnergy::weigh(float penalty) const {
    const auto steps = static_cast<Energy>(penalty * static_cast<float>(kEnergyUnit) + 0.5F);
    return problem_.settings.normalize_energy ? steps * count_ : steps;
}

Energy VoxelEnergy::of(const Candidate& candidate, Energy limit) const {
    const PlaneIndex plane = problem_.transforms.plane_of(candidate.label.linear);
    const Energy sure = first_half(candidate.texel) +
                        weigh(distortion(plane) + border(candidate.texel) + misorientation(candidate.part));
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
