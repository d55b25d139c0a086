#include "core/shell/links.h"

#include <algorithm>
#include <array>
#include <vector>

#include "core/base/parallel.h"

namespace fretwork {
namespace {

constexpr std::size_t kGrain = TouchingEntries::kGrain;
constexpr int kOwnCell = 13;

bool has(CellSet set, int code) {
    return (set >> code & 1u) != 0;
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

// Which of the touching entries are linked, with the question put once per pair.
template <class Linked>
class LinksFound {
  public:
    // \param linked  answers `linked(v, w, code)` for v < w
    LinksFound(const TouchingEntries& touching, const Linked& linked, const RunControl& run)
        : touching_(touching), linked_(linked), after_(touching.rows().size(), 0) {
        parallel_chunks(after_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
            run.throw_if_stopped();
            for (auto v = static_cast<VoxelIndex>(begin); v < end; ++v) {
                CellSet after = 0;
                touching.visit(v, [&](VoxelIndex w, int code) {
                    if (code > kOwnCell && linked(v, w, code)) after |= CellSet{1} << code;
                });
                after_[v] = after;
            }
        });
    }

    [[nodiscard]] const TouchingEntries& touching() const { return touching_; }

    // A cell tells the answer as long as it holds one entry; else the question is put again.
    [[nodiscard]] bool operator()(VoxelIndex v, VoxelIndex w, int code) const {
        const VoxelIndex low = std::min(v, w), high = std::max(v, w);
        const int from_low = code < kOwnCell ? opposite_code(code) : code;
        if (!touching_.rows().shares_cell(high)) return has(after_[low], from_low);
        return has(after_[low], from_low) && linked_(low, high, from_low);
    }

  private:
    const TouchingEntries& touching_;
    const Linked& linked_;
    std::vector<CellSet> after_;  // cells of linked entries that come later
};

// Lists what lies in `several`; most entries have nothing there.
template <class Found>
void list_several(const Found& found, TouchingLinks& links) {
    std::vector<std::vector<VoxelIndex>> chunks((links.several.size() + kGrain - 1) / kGrain);
    parallel_chunks(links.several.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (auto v = static_cast<VoxelIndex>(begin); v < end; ++v) {
            if (links.several[v] == 0) continue;
            std::vector<VoxelIndex>& list = chunks[begin / kGrain];
            const std::size_t before = list.size();
            found.touching().visit(v, [&](VoxelIndex w, int code) {
                if (found.touching().rows().shares_cell(w) && found(v, w, code)) list.push_back(w);
            });
            links.first[v + 1] = static_cast<std::uint32_t>(list.size() - before);
        }
    });
    links.take_lists(chunks);
}

// 1, sqrt 2 or sqrt 3, by code.
std::array<float, 27> lengths_of_steps() {
    constexpr std::array<float, 4> length = {0.0F, 1.0F, 1.41421356F, 1.73205081F};
    std::array<float, 27> lengths{};
    for (std::size_t code = 0; code < 27; ++code)
        lengths[code] = length[static_cast<std::size_t>(code % 3 != 1) + (code / 3 % 3 != 1) + (code / 9 != 1)];
    return lengths;
}

template <class Found>
Adjacency list_all(const Found& found, const RunControl& run) {
    struct Link {
        VoxelIndex neighbor;
        float length;
    };
    const std::size_t count = found.touching().rows().size();
    const std::array<float, 27> lengths = lengths_of_steps();
    std::vector<std::vector<Link>> chunks((count + kGrain - 1) / kGrain);
    Adjacency links;
    links.first.assign(count + 1, 0);
    parallel_chunks(count, kGrain, [&](std::size_t begin, std::size_t end) {
        run.throw_if_stopped();
        std::vector<Link>& kept = chunks[begin / kGrain];
        kept.reserve(10 * (end - begin));
        for (auto v = static_cast<VoxelIndex>(begin); v < end; ++v) {
            const std::size_t before = kept.size();
            found.touching().visit(v, [&](VoxelIndex w, int code) {
                if (found(v, w, code)) kept.push_back({w, lengths[static_cast<std::size_t>(code)]});
            });
            links.first[v + 1] = static_cast<std::uint32_t>(kept.size() - before);
        }
    });
    for (std::size_t v = 0; v < count; ++v) links.first[v + 1] += links.first[v];
    links.neighbor.resize(links.first.back());
    links.length_voxels.resize(links.first.back());
    parallel_for(chunks.size(), 1, [&](std::size_t c) {
        std::size_t at = links.first[c * kGrain];
        for (const Link& link : chunks[c]) {
            links.neighbor[at] = link.neighbor;
            links.length_voxels[at++] = link.length;
        }
        chunks[c] = {};
    });
    return links;
}

}  // namespace

TouchingEntries::TouchingEntries(const CellRows& rows, const RunControl& run)
    : rows_(rows), chunks_((rows.size() + kGrain - 1) / kGrain) {
    parallel_chunks(rows.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        run.throw_if_stopped();
        Chunk& chunk = chunks_[begin / kGrain];
        chunk.around.reserve(12 * (end - begin));
        std::size_t row = 0;
        rows.sweep(begin, end, [&](VoxelIndex v, VoxelIndex w, int code) {
            while (row <= v - begin) chunk.first[row++] = static_cast<std::uint32_t>(chunk.around.size());
            chunk.around.push_back({w, static_cast<std::uint32_t>(code)});
        });
        while (row <= kGrain) chunk.first[row++] = static_cast<std::uint32_t>(chunk.around.size());
    });
}

void TouchingLinks::take_lists(std::span<const std::vector<VoxelIndex>> lists) {
    for (std::size_t v = 0; v + 1 < first.size(); ++v) first[v + 1] += first[v];
    in_several.reserve(first.back());
    for (const std::vector<VoxelIndex>& list : lists) in_several.insert(in_several.end(), list.begin(), list.end());
}

bool TouchingLinks::holds(const CellRows& rows, VoxelIndex v, VoxelIndex w, int code) const {
    if (!rows.shares_cell(w)) return has(single[v], code);
    const auto row = listed(v);
    return has(several[v], code) && std::binary_search(row.begin(), row.end(), w);
}

TouchingLinks link_shared_triangles(const TouchingEntries& touching, const EntryTriangles& triangles,
                                    const RunControl& run) {
    const auto share_triangle = [&](VoxelIndex v, VoxelIndex w, int) {
        return have_common_element(triangles.of(v), triangles.of(w));
    };
    const LinksFound found(touching, share_triangle, run);
    TouchingLinks links(touching.rows().size());
    parallel_chunks(links.single.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (auto v = static_cast<VoxelIndex>(begin); v < end; ++v) {
            CellSet cells = 0, shared = 0;
            touching.visit(v, [&](VoxelIndex w, int code) {
                cells |= CellSet{found(v, w, code)} << code;
                shared |= CellSet{touching.rows().shares_cell(w)} << code;
            });
            links.single[v] = cells & ~shared;
            links.several[v] = cells & shared;
        }
    });
    list_several(found, links);
    return links;
}

Adjacency link_around_common_neighbors(const TouchingEntries& touching, std::span<const Vec3f> normals,
                                       const TouchingLinks& direct, const RunControl& run) {
    // Where each cell around has one entry, sets of cells tell all. Where cells hold several, the lists must be
    // compared.
    const CellSetOverlap overlap;
    const auto around_common_neighbor = [&](VoxelIndex v, VoxelIndex w, int code) {
        if (direct.holds(touching.rows(), v, w, code)) return true;
        const int wide = widened_code(code);
        if (overlap.common(direct.single[v], direct.single[w], wide) == 0) {
            if (overlap.common(direct.several[v], direct.several[w], wide) == 0) return false;
            if (!have_common_element(direct.listed(v), direct.listed(w))) return false;
        }
        return normals[v].dot(normals[w]) >= kOpposingCosine;
    };
    return list_all(LinksFound(touching, around_common_neighbor, run), run);
}

}  // namespace fretwork
