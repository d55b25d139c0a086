#include "formats/part_facts.h"

#include <Eigen/Geometry>

namespace fretwork {

Facts part_facts(const MeshPart& part) {
    return {{{"name", part.name}, {"triangles", std::int64_t{part.triangle_count}}}};
}

Facts face_facts(const TriangleMesh& mesh, const MeshPart& face) {
    Vec3 weighted = Vec3::Zero(), normal = Vec3::Zero();
    double area = 0.0;
    for (std::uint32_t t = face.first_triangle; t < face.first_triangle + face.triangle_count; ++t) {
        const auto& [a, b, c] = mesh.triangles[t];
        const Vec3 &p = mesh.positions_mm[a], &q = mesh.positions_mm[b], &r = mesh.positions_mm[c];
        const Vec3 cross = (q - p).cross(r - p) / 2.0;
        weighted += cross.norm() * (p + q + r) / 3.0;
        normal += cross;
        area += cross.norm();
    }
    const auto list = [](const Vec3& v) { return std::vector<double>{v[0], v[1], v[2]}; };
    Facts facts = part_facts(face);
    facts.add("area_mm2", area);
    if (area > 0.0) facts.add("center_mm", list(weighted / area));
    if (normal.norm() > 1e-6 * area) facts.add("mean_normal", list(normal.normalized()));
    return facts;
}

}  // namespace fretwork
