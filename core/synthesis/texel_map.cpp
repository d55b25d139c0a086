#include "core/synthesis/texel_map.h"

#include <cmath>

namespace fretwork {
namespace {

/// Most fractional bits, up to 20, with which `scale` pixels per voxel out of `size` fit 15 bits.
int fitting_bits(int size, double scale) {
    int bits = 20;
    while (bits > 0 && std::ldexp(scale / size, bits) > 32766.0) --bits;
    return bits;
}

}  // namespace

FixedPoint to_fixed(const Vec3f& position_voxels, int skipped_levels) {
    const double unit = std::ldexp(4096.0, skipped_levels);
    const auto convert = [&](float x) { return static_cast<std::int32_t>(std::lrint(static_cast<double>(x) * unit)); };
    return {convert(position_voxels.x()), convert(position_voxels.y()), convert(position_voxels.z())};
}

TexelMap::TexelMap(int width, int height, double pixels_per_voxel, int skipped_levels)
    : width_(width), height_(height), pixels_per_voxel_(pixels_per_voxel), skipped_levels_(skipped_levels) {
    const double per_full_voxel = std::ldexp(pixels_per_voxel, -skipped_levels);
    u_bits_ = fitting_bits(width, per_full_voxel);
    v_bits_ = fitting_bits(height, per_full_voxel);
    u_unit_ = static_cast<float>(std::ldexp(per_full_voxel / width, u_bits_));
    v_unit_ = static_cast<float>(std::ldexp(per_full_voxel / height, v_bits_));
    u_pixels_ = static_cast<float>(std::ldexp(width, skipped_levels - u_bits_));
    v_pixels_ = static_cast<float>(std::ldexp(height, skipped_levels - v_bits_));
}

}  // namespace fretwork
