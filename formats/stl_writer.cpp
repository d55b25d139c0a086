#include "formats/stl_writer.h"

#include <Eigen/Geometry>
#include <array>

#include "formats/byte_order.h"

namespace fretwork {

std::string write_stl(const MeshToWrite& input) {
    check_mesh_to_write(input);
    const TriangleMesh& mesh = input.mesh;
    std::string out;
    out.reserve(84 + 50 * mesh.triangles.size());
    out = "Fretwork binary STL, millimetres";
    out.resize(80, ' ');
    append_little(out, static_cast<std::uint32_t>(mesh.triangles.size()));
    for (const Triangle& t : mesh.triangles) {
        std::array<Vec3f, 3> corners;
        for (std::size_t k = 0; k < 3; ++k) corners[k] = mesh.positions_mm[t[k]].cast<float>();
        const Vec3 a = corners[0].cast<double>();
        Vec3 normal = (corners[1].cast<double>() - a).cross(corners[2].cast<double>() - a);
        const double size = normal.norm();
        normal = size > 0.0 ? Vec3(normal / size) : Vec3::UnitZ();
        for (int k = 0; k < 3; ++k) append_little(out, static_cast<float>(normal[k]));
        for (const Vec3f& corner : corners)
            for (int k = 0; k < 3; ++k) append_little(out, corner[k]);
        append_little(out, std::uint16_t{0});
    }
    return out;
}

}  // namespace fretwork
