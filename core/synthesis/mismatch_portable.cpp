#include "core/base/avx2.h"
#include "core/synthesis/mismatch.h"

namespace fretwork {
namespace {

std::uint32_t fetch(const TexelLevel& level, const TexelPosition& t) {
    const std::uint32_t column = ((t.u >> 16) * level.width) >> 16, row = ((t.v >> 16) * level.height) >> 16;
    return level.texels[column + row * level.width];
}

TexelPosition moved(const TexelLevel& level, const TexelPosition& texel, const LinearPart& part, std::int32_t xy,
                    std::int32_t z) {
    const std::int32_t x = low16(xy), y = high16(xy);
    const std::int32_t u = low16(part.u_xy) * x + high16(part.u_xy) * y + low16(part.uv_z) * z;
    const std::int32_t v = low16(part.v_xy) * x + high16(part.v_xy) * y + high16(part.uv_z) * z;
    return {texel.u + (static_cast<std::uint32_t>(u) << level.u_shift),
            texel.v + (static_cast<std::uint32_t>(v) << level.v_shift)};
}

void view_neighbors(const TexelLevel& level, const Choice* choices, const NeighborBlock* blocks, std::uint32_t count,
                    NeighborView& view) {
    std::int32_t sum[4] = {}, squares = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        const NeighborBlock& b = blocks[i / 8];
        const Choice& c = choices[b.neighbor[i % 8]];
        view.color[i] = c.color;
        view.linear[i] = c.label.linear;
        view.origin[i] = c.label.origin;
        view.u_xy[i] = c.part.u_xy;
        view.v_xy[i] = c.part.v_xy;
        view.uv_z[i] = c.part.uv_z;
        const std::uint32_t expected =
            fetch(level, moved(level, c.texel, c.part, b.back_xy[i % 8], high16(b.z[i % 8])));
        for (int channel = 0; channel < 4; ++channel) {
            const auto value = static_cast<std::int32_t>(expected >> (8 * channel) & 0xFFu);
            sum[channel] += value;
            squares += value * value;
        }
    }
    for (int channel = 0; channel < 4; ++channel) view.expected_sum[channel] = sum[channel];
    view.expected_squares = squares;
}

std::uint32_t distinct_labels(const NeighborView& view, std::uint32_t count, CoherentLabel* labels) {
    std::uint32_t distinct = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        const Label label{view.linear[i], view.origin[i]};
        std::uint32_t d = 0;
        while (d < distinct && labels[d].label != label) ++d;
        if (d == distinct) labels[distinct++] = {label, 0, i};
        ++labels[d].votes;
    }
    return distinct;
}

// Modulo 2^32 on purpose: whole periods drop out.
std::uint32_t project(std::int32_t x, std::int32_t y, std::int32_t z, const FixedPoint& p, int shift) {
    return (static_cast<std::uint32_t>(x) * static_cast<std::uint32_t>(p.x) +
            static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(p.y) +
            static_cast<std::uint32_t>(z) * static_cast<std::uint32_t>(p.z))
           << shift;
}

void project_labels(const TexelLevel& level, const NeighborView& view, const FixedPoint& point,
                    const CoherentLabel* labels, std::uint32_t labels_count, ScreenedTexels& screened) {
    for (std::uint32_t i = 0; i < labels_count; ++i) {
        const std::uint32_t w = labels[i].first_seen, origin = view.origin[w];
        screened.u[i] = (origin & 0xFFFF0000u) + project(low16(view.u_xy[w]), high16(view.u_xy[w]), low16(view.uv_z[w]),
                                                         point, level.u_place_shift);
        screened.v[i] = (origin << 16) + project(low16(view.v_xy[w]), high16(view.v_xy[w]), high16(view.uv_z[w]), point,
                                                 level.v_place_shift);
    }
}

void first_halves(const TexelLevel& level, const NeighborView& view, std::uint32_t count, std::uint32_t texels,
                  ScreenedTexels& screened) {
    for (std::uint32_t i = 0; i < texels; ++i) {
        const std::uint32_t color = fetch(level, {screened.u[i], screened.v[i]});
        std::int32_t square = 0, product = 0;
        for (int c = 0; c < 4; ++c) {
            const auto value = static_cast<std::int32_t>(color >> (8 * c) & 0xFFu);
            square += value * value;
            product += value * view.expected_sum[c];
        }
        screened.first_half[i] = static_cast<std::int32_t>(count) * square - 2 * product + view.expected_squares;
    }
}

std::int32_t disagreement(const TexelLevel& level, const NeighborBlock* blocks, std::uint32_t count,
                          const NeighborView& view, const TexelPosition& texel, const LinearPart& part,
                          std::int32_t limit) {
    std::int32_t sum = 0;
    for (std::uint32_t i = 0; i < count && sum <= limit; ++i) {
        const NeighborBlock& b = blocks[i / 8];
        const std::uint32_t seen = fetch(level, moved(level, texel, part, b.out_xy[i % 8], low16(b.z[i % 8])));
        for (int channel = 0; channel < 4; ++channel) {
            const std::int32_t difference = static_cast<std::int32_t>(seen >> (8 * channel) & 0xFFu) -
                                            static_cast<std::int32_t>(view.color[i] >> (8 * channel) & 0xFFu);
            sum += difference * difference;
        }
    }
    return sum;
}

}  // namespace

const MismatchKernels kPortableMismatch{view_neighbors, distinct_labels, project_labels, first_halves, disagreement};

const MismatchKernels& best_mismatch_kernels() {
    return machine_has_avx2() ? kAvx2Mismatch : kPortableMismatch;
}

}  // namespace fretwork
