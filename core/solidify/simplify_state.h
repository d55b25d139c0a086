// What the steps of simplifying share: the mesh, what stands for the vertices that went, and how it came about.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Geometry>

#include "core/mesh/triangle_math.h"
#include "core/solidify/collapse_mesh.h"
#include "core/solidify/mesh_areas.h"

namespace fretwork {

/// Unit normal, and 4 sqrt 3 area / sum of squared sides: 1 for an equilateral triangle, 0 for a segment.
struct TriangleShape {
    Vec3f normal;
    float quality;
};

inline TriangleShape shape_of(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 n = (b - a).cross(c - a);
    const double length = n.norm();
    const double sides = (b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm();
    return {length > 0.0 ? Vec3f((n / length).cast<float>()) : Vec3f(Vec3f::Zero()),
            sides > 0.0 ? static_cast<float>(2.0 * std::sqrt(3.0) * length / sides) : 0.0F};
}

struct SimplifyState {
    static constexpr std::uint32_t kNone = CollapseMesh::kNone;

    SimplifyState(const TriangleMesh& input, const MeshAreas& mesh_areas)
        : mesh(input),
          areas(mesh_areas),
          first_sample(input.triangles.size(), kNone),
          next_sample(input.positions_mm.size(), kNone),
          locked(input.positions_mm.size(), 0),
          settled(input.positions_mm.size(), 0) {}

    CollapseMesh mesh;
    const MeshAreas& areas;
    std::vector<TriangleShape> shape;  ///< per triangle
    /// The vertices that went, as lists, filed under the triangle that now stands for them.
    std::vector<std::uint32_t> first_sample;  ///< per triangle
    std::vector<std::uint32_t> next_sample;   ///< per vertex
    std::vector<std::uint8_t> locked;         ///< per vertex: must not go
    /// Per vertex: it could not go at the full tolerance, and nothing has changed around it since.
    std::vector<std::uint8_t> settled;

    void measure(std::uint32_t t) {
        const Triangle& k = mesh.triangle(t);
        shape[t] = shape_of(mesh.position(k[0]), mesh.position(k[1]), mesh.position(k[2]));
    }
    void file(std::uint32_t vertex, std::uint32_t triangle) {
        next_sample[vertex] = first_sample[triangle];
        first_sample[triangle] = vertex;
    }
};

}  // namespace fretwork
