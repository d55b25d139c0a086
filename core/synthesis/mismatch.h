// The inner loops of the transition energy, once for every machine and once for AVX2.
#pragma once

#include <cstdint>

#include "core/pyramid/voxel_pyramid.h"
#include "core/synthesis/choice.h"

namespace fretwork {

/// One level of the exemplar as the inner loops see it.
struct TexelLevel {
    const std::uint32_t* texels = nullptr;
    std::uint32_t width = 1, height = 1;
    int u_shift = 0, v_shift = 0;              ///< of projected offsets
    int u_place_shift = 0, v_place_shift = 0;  ///< of projected points
};

/// What the neighbours of one voxel have chosen and what they expect the voxel to look like.
struct NeighborView {
    static constexpr std::uint32_t kMost = Neighborhoods::kMost;
    alignas(32) std::uint32_t color[kMost];  ///< I(M(w, l_w))
    alignas(32) LinearIndex linear[kMost];
    alignas(32) std::uint32_t origin[kMost];
    alignas(32) std::int32_t u_xy[kMost];  ///< the linear parts
    alignas(32) std::int32_t v_xy[kMost];
    alignas(32) std::int32_t uv_z[kMost];
    std::int32_t expected_sum[4] = {};  ///< sum over w of I(M(v, l_w)), per channel
    std::int32_t expected_squares = 0;  ///< sum over w of |I(M(v, l_w))|^2
};

/// A label that neighbours have chosen.
struct CoherentLabel {
    Label label;
    std::uint32_t votes = 0;
    std::uint32_t first_seen = 0;  ///< position in the voxel's list of neighbours
};

/// Positions in the exemplar and the first half of E_transition there, of several candidates.
struct ScreenedTexels {
    static constexpr std::uint32_t kMost = 256;
    alignas(32) std::uint32_t u[kMost];
    alignas(32) std::uint32_t v[kMost];
    alignas(32) std::int32_t first_half[kMost];
};

/// The two halves of E_transition in section 4.2.2, in squared steps of 8-bit channels. Both sets
/// below give the same integers.
struct MismatchKernels {
    /// Gathers the view of a voxel. Lanes past `count` hold anything.
    void (*view_neighbors)(const TexelLevel& level, const Choice* choices, const NeighborBlock* blocks,
                           std::uint32_t count, NeighborView& view);

    /// The distinct labels of a view in the order in which they are first seen.
    /// \param labels  room for `count` entries
    /// \return how many there are
    std::uint32_t (*distinct_labels)(const NeighborView& view, std::uint32_t count, CoherentLabel* labels);

    /// Where the voxel at `point` would lie under each of the labels: M(v, label).
    void (*project_labels)(const TexelLevel& level, const NeighborView& view, const FixedPoint& point,
                           const CoherentLabel* labels, std::uint32_t labels_count, ScreenedTexels& screened);

    /// For the first `texels` positions: sum over w of |I(M(v, l_w)) - I there|^2. The sum over w does not depend on
    /// the candidate: with N neighbours, S the sum and Q the sum of squares of what they expect it is
    /// N |c|^2 - 2 c.S + Q for a candidate of colour c.
    void (*first_halves)(const TexelLevel& level, const NeighborView& view, std::uint32_t count, std::uint32_t texels,
                         ScreenedTexels& screened);

    /// sum over w of |I(M(w, k)) - I(M(w, l_w))|^2 for the candidate k that shows `texel` at the voxel;
    /// gives up with some value above `limit` once the sum exceeds it.
    std::int32_t (*disagreement)(const TexelLevel& level, const NeighborBlock* blocks, std::uint32_t count,
                                 const NeighborView& view, const TexelPosition& texel, const LinearPart& part,
                                 std::int32_t limit);
};

extern const MismatchKernels kPortableMismatch;
extern const MismatchKernels kAvx2Mismatch;

/// The fastest set this machine can run.
const MismatchKernels& best_mismatch_kernels();

}  // namespace fretwork
