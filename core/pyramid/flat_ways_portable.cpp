#include <algorithm>
#include <cmath>

#include "core/pyramid/flat_ways.h"

namespace fretwork {
namespace {

// Sums in the order of flat_ways_avx2.cpp, so that both round alike.
float dot(const float* a, const float* b) {
    return a[0] * b[0] + (a[1] * b[1] + a[2] * b[2]);
}

// `step`, of which `along` points along the unit normal, turned into the normal's plane and stretched; in fixed point.
void lay_flat(const float* step, const float* normal, float along, float stretch, float unit, std::int32_t* fixed) {
    float flat[3];
    for (int k = 0; k < 3; ++k) flat[k] = step[k] - normal[k] * along;
    const float squared = dot(flat, flat);
    const float keep_length = squared > 0.0F ? std::sqrt(dot(step, step) / squared) : 0.0F;
    for (int k = 0; k < 3; ++k) fixed[k] = offset_to_fixed(stretch * (flat[k] * keep_length), unit);
}

}  // namespace

std::int32_t offset_to_fixed(float coordinate, float unit) {
    return round_to_int(std::clamp(coordinate * unit, -32767.0F, 32767.0F));
}

std::uint32_t lay_flat_portable(const SurfaceFrame* frames, VoxelIndex v, float unit, NeighborBlock& block) {
    const SurfaceFrame& a = frames[v];
    std::uint32_t bent = 0;
    for (std::uint32_t lane = 0; lane < 8; ++lane) {
        const SurfaceFrame& b = frames[block.neighbor[lane]];
        float step[3];
        for (int k = 0; k < 3; ++k) step[k] = b.position[k] - a.position[k];
        const float cosine = dot(a.normal, b.normal);
        if (cosine < kSmoothCosine) bent |= 1u << lane;
        // Chord 2 sin(a / 2) against arc a, where the normals turn by a: their ratio is 1 + (1 - cos a) / 12
        // up to a^4.
        const float stretch = 1.0F + (1.0F - cosine) / 12.0F;
        std::int32_t out[3], back[3];
        lay_flat(step, a.normal, dot(a.normal, step), stretch, unit, out);
        lay_flat(step, b.normal, dot(b.normal, step), -stretch, unit, back);
        block.out_xy[lane] = pack16(out[0], out[1]);
        block.back_xy[lane] = pack16(back[0], back[1]);
        block.z[lane] = pack16(out[2], back[2]);
    }
    return bent;
}

}  // namespace fretwork
