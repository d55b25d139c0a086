#include "core/mesh/components.h"

#include <algorithm>
#include <limits>
#include <string>

#include "core/base/disjoint_sets.h"
#include "core/base/error.h"

namespace fretwork {
namespace {

void check_indices(const TriangleMesh& mesh) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (const std::uint32_t v : mesh.triangles[t])
            if (v >= mesh.positions_mm.size())
                throw InvalidInput("components: triangle " + std::to_string(t) + " names vertex " + std::to_string(v) +
                                   ", but the mesh has " + std::to_string(mesh.positions_mm.size()) + " vertices");
}

void join_over_edges(const EdgeTable& edges, DisjointSets& sets) {
    for (std::size_t e = 0; e < edges.size(); ++e)
        for (const HalfEdge h : edges.half_edges(e)) sets.unite(edges.half_edges(e)[0] / 3, h / 3);
}

void join_over_vertices(const TriangleMesh& mesh, DisjointSets& sets) {
    constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> first_triangle(mesh.positions_mm.size(), none);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        for (const std::uint32_t v : mesh.triangles[t]) {
            if (first_triangle[v] == none) first_triangle[v] = t;
            sets.unite(first_triangle[v], t);
        }
}

MeshComponents number_components(const TriangleMesh& mesh, DisjointSets& sets) {
    MeshComponents components;
    components.of_triangle.resize(mesh.triangles.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const std::uint32_t lowest = sets.find(t);
        components.of_triangle[t] = lowest == t ? components.count++ : components.of_triangle[lowest];
    }
    return components;
}

}  // namespace

MeshComponents find_components(const TriangleMesh& mesh, ConnectedBy by, const RunControl& run) {
    check_indices(mesh);
    if (by == ConnectedBy::kEdge) return find_components(mesh, EdgeTable(mesh, run));
    DisjointSets sets(mesh.triangles.size());
    join_over_vertices(mesh, sets);
    return number_components(mesh, sets);
}

MeshComponents find_components(const TriangleMesh& mesh, const EdgeTable& edges) {
    DisjointSets sets(mesh.triangles.size());
    join_over_edges(edges, sets);
    return number_components(mesh, sets);
}

std::vector<ComponentMesh> split_components(const TriangleMesh& mesh, const MeshComponents& components) {
    std::vector<ComponentMesh> parts(components.count);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        parts[components.of_triangle[t]].source_triangles.push_back(t);
    std::vector<std::uint32_t> moved(mesh.positions_mm.size());
    for (ComponentMesh& part : parts) {
        std::vector<std::uint32_t> used;
        for (const std::uint32_t t : part.source_triangles)
            used.insert(used.end(), mesh.triangles[t].begin(), mesh.triangles[t].end());
        std::sort(used.begin(), used.end());
        used.erase(std::unique(used.begin(), used.end()), used.end());
        for (std::uint32_t i = 0; i < used.size(); ++i) {
            moved[used[i]] = i;
            part.mesh.positions_mm.push_back(mesh.positions_mm[used[i]]);
        }
        for (const std::uint32_t t : part.source_triangles) {
            const Triangle& old = mesh.triangles[t];
            part.mesh.triangles.push_back({moved[old[0]], moved[old[1]], moved[old[2]]});
        }
    }
    return parts;
}

}  // namespace fretwork
