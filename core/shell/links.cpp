#include "core/shell/links.h"

#include <algorithm>
#include <array>
#include <vector>

#include "core/base/parallel.h"

namespace fretwork {
namespace {

constexpr std::size_t kGrain = 2048;

float distance_between(const VoxelCoord& a, const VoxelCoord& b) {
    constexpr std::array<float, 4> length = {0.0F, 1.0F, 1.41421356F, 1.73205081F};
    return length[static_cast<std::size_t>((a[0] != b[0]) + (a[1] != b[1]) + (a[2] != b[2]))];
}

bool have_common_element(std::span<const std::uint32_t> a, std::span<const std::uint32_t> b) {
    auto i = a.begin();
    auto j = b.begin();
    while (i != a.end() && j != b.end()) {
        if (*i == *j) return true;
        if (*i < *j)
            ++i;
        else
            ++j;
    }
    return false;
}

// Links to later entries, in compressed rows.
struct ForwardLinks {
    std::vector<std::uint32_t> first;
    std::vector<VoxelIndex> neighbor;
};

// Every link seen from both ends, rows ascending.
Adjacency both_ways(std::span<const VoxelCoord> coords, const ForwardLinks& forward) {
    Adjacency links;
    links.first.assign(coords.size() + 1, 0);
    for (std::size_t v = 0; v < coords.size(); ++v) links.first[v + 1] = forward.first[v + 1] - forward.first[v];
    for (const VoxelIndex w : forward.neighbor) ++links.first[w + 1];
    for (std::size_t v = 0; v < coords.size(); ++v) links.first[v + 1] += links.first[v];
    links.neighbor.resize(links.first.back());
    links.length_voxels.resize(links.first.back());
    // Going up through v, the links back to v arrive in each row in ascending order and before its own.
    std::vector<std::uint32_t> next(links.first.begin(), links.first.end() - 1);
    for (VoxelIndex v = 0; v < coords.size(); ++v)
        for (std::uint32_t e = forward.first[v]; e < forward.first[v + 1]; ++e) {
            const VoxelIndex w = forward.neighbor[e];
            links.neighbor[next[w]++] = v;
            links.neighbor[next[v]++] = w;
        }
    parallel_for(coords.size(), kGrain, [&](std::size_t v) {
        for (std::uint32_t e = links.first[v]; e < links.first[v + 1]; ++e)
            links.length_voxels[e] = distance_between(coords[v], coords[links.neighbor[e]]);
    });
    return links;
}

// Keeps the pairs v < w in touching cells for which `linked(v, w, code)` holds. Chunks are filled on their own and
// joined in order.
template <class Linked>
Adjacency keep_links(const CellRows& rows, std::span<const VoxelCoord> coords, const Linked& linked,
                     const RunControl& run) {
    constexpr int kOwnCell = 13;
    std::vector<std::vector<VoxelIndex>> chunks((coords.size() + kGrain - 1) / kGrain);
    ForwardLinks forward;
    forward.first.assign(coords.size() + 1, 0);
    parallel_chunks(coords.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        run.throw_if_stopped();
        std::vector<VoxelIndex>& kept = chunks[begin / kGrain];
        kept.reserve(8 * (end - begin));
        rows.sweep<1>(begin, end, [&](VoxelIndex v, VoxelIndex w, int code) {
            if (code <= kOwnCell || !linked(v, w, code)) return;
            kept.push_back(w);
            ++forward.first[v + 1];
        });
    });
    for (std::size_t v = 0; v < coords.size(); ++v) forward.first[v + 1] += forward.first[v];
    forward.neighbor.resize(forward.first.back());
    parallel_for(chunks.size(), 1, [&](std::size_t c) {
        std::copy(chunks[c].begin(), chunks[c].end(), forward.neighbor.begin() + forward.first[c * kGrain]);
        chunks[c] = {};
    });
    return both_ways(coords, forward);
}

}  // namespace

Adjacency link_shared_triangles(const CellRows& rows, std::span<const VoxelCoord> coords,
                                const EntryTriangles& triangles, const RunControl& run) {
    return keep_links(
        rows, coords,
        [&](VoxelIndex v, VoxelIndex w, int) { return have_common_element(triangles.of(v), triangles.of(w)); }, run);
}

Adjacency link_around_common_neighbors(const CellRows& rows, std::span<const VoxelCoord> coords,
                                       std::span<const Vec3f> normals, const Adjacency& direct, const RunControl& run) {
    // Where each cell around has one entry, sets of cells tell all. Cells with several are kept apart; there the
    // lists must be compared.
    std::vector<CellSet> single(coords.size(), 0);
    std::vector<CellSet> several(coords.size(), 0);
    parallel_for(coords.size(), kGrain, [&](std::size_t v) {
        for (const VoxelIndex w : direct.of(static_cast<VoxelIndex>(v))) {
            std::vector<CellSet>& sets = rows.shares_cell(w) ? several : single;
            sets[v] |= CellSet{1} << touching_code(coords[v], coords[w]);
        }
    });
    const CellSetOverlap overlap;
    return keep_links(
        rows, coords,
        [&](VoxelIndex v, VoxelIndex w, int code) {
            if (single[v] >> code & 1u) return true;
            const auto of_v = direct.of(v);
            if (several[v] >> code & 1u && std::binary_search(of_v.begin(), of_v.end(), w)) return true;
            const int wide = widened_code(code);
            if (overlap.common(single[v], single[w], wide) == 0) {
                if (overlap.common(several[v], several[w], wide) == 0) return false;
                if (!have_common_element(of_v, direct.of(w))) return false;
            }
            return normals[v].dot(normals[w]) >= kOpposingCosine;
        },
        run);
}

}  // namespace fretwork
