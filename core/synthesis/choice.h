// C of the paper: what each voxel of a level has chosen.
#pragma once

#include <cstdint>
#include <vector>

#include "core/synthesis/plane_transforms.h"
#include "core/synthesis/texel_map.h"

namespace fretwork {

/// A pair (psi, tau): plane and rotation, and the exemplar position of the grid's origin in 1/65536 of
/// the period. Equal labels of two voxels are one continuous piece of the exemplar.
struct Label {
    LinearIndex linear = 0;
    std::uint32_t origin = 0;  ///< u in the upper half, v in the lower

    friend bool operator==(const Label&, const Label&) = default;
    friend auto operator<=>(const Label&, const Label&) = default;
};

/// A label together with what follows from it at one voxel; half a cache line, so that reading a
/// neighbour's choice costs one access.
struct alignas(32) Choice {
    TexelPosition texel;  ///< M(v, psi(v), tau(v))
    LinearPart part;
    std::uint32_t color = 0;  ///< I there
    Label label;
};

using Choices = std::vector<Choice>;

/// Label of the piece that shows `texel` at the surface point p.
[[nodiscard]] inline Label label_through(const TexelMap& map, LinearIndex linear, const LinearPart& part,
                                         const FixedPoint& p, const TexelPosition& texel) {
    const TexelPosition moved = map.project(part, p);
    const std::uint32_t u = (texel.u - moved.u + 0x8000u) >> 16, v = (texel.v - moved.v + 0x8000u) >> 16;
    return {linear, u << 16 | v};
}

/// M(p, label).
[[nodiscard]] inline TexelPosition texel_at(const TexelMap& map, const LinearPart& part, std::uint32_t origin,
                                            const FixedPoint& p) {
    const TexelPosition moved = map.project(part, p);
    return {moved.u + (origin & 0xFFFF0000u), moved.v + (origin << 16)};
}

}  // namespace fretwork
