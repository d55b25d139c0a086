#include "core/mesh/edge_table.h"

#include <algorithm>
#include <utility>

namespace fretwork {
namespace {

constexpr std::uint32_t kOften = 1u << 18;  // items between two looks at the stop request

}  // namespace

EdgeTable::EdgeTable(const TriangleMesh& mesh, const RunControl& run) {
    const auto count = static_cast<HalfEdge>(3 * mesh.triangles.size());
    // Bucket by lower end, then sort each small bucket by (upper end, half-edge).
    std::vector<std::uint32_t> bucket(mesh.positions_mm.size() + 1, 0);
    for (HalfEdge h = 0; h < count; ++h) {
        if (h % kOften == 0) run.throw_if_stopped();
        const std::uint32_t a = start_of(mesh, h), b = end_of(mesh, h);
        if (a != b) ++bucket[std::min(a, b) + 1];
    }
    for (std::size_t v = 1; v < bucket.size(); ++v) bucket[v] += bucket[v - 1];
    std::vector<std::pair<std::uint32_t, HalfEdge>> entries(bucket.back());
    std::vector<std::uint32_t> fill(bucket.begin(), bucket.end() - 1);
    for (HalfEdge h = 0; h < count; ++h) {
        if (h % kOften == 0) run.throw_if_stopped();
        const std::uint32_t a = start_of(mesh, h), b = end_of(mesh, h);
        if (a != b) entries[fill[std::min(a, b)]++] = {std::max(a, b), h};
    }
    low_.reserve(entries.size() / 2);
    high_.reserve(entries.size() / 2);
    first_.reserve(entries.size() / 2 + 1);
    half_edges_.reserve(entries.size());
    for (std::size_t v = 0; v + 1 < bucket.size(); ++v) {
        if (v % kOften == 0) run.throw_if_stopped();
        const auto begin = entries.begin() + bucket[v], end = entries.begin() + bucket[v + 1];
        std::sort(begin, end);
        for (auto it = begin; it != end; ++it) {
            if (it == begin || it->first != std::prev(it)->first) {
                low_.push_back(static_cast<std::uint32_t>(v));
                high_.push_back(it->first);
                first_.push_back(static_cast<std::uint32_t>(half_edges_.size()));
            }
            half_edges_.push_back(it->second);
        }
    }
    first_.push_back(static_cast<std::uint32_t>(half_edges_.size()));
}

}  // namespace fretwork
