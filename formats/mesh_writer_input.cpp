#include "formats/mesh_writer_input.h"

#include <string>

#include "core/base/error.h"
#include "formats/number_text.h"

namespace fretwork {

void check_mesh_to_write(const MeshToWrite& input) {
    const TriangleMesh& mesh = input.mesh;
    for (std::size_t v = 0; v < mesh.positions_mm.size(); ++v)
        if (!mesh.positions_mm[v].allFinite())
            throw InvalidInput("write mesh: vertex " + std::to_string(v) + ": found a coordinate that is not finite");
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (const std::uint32_t v : mesh.triangles[t])
            if (v >= mesh.positions_mm.size())
                throw InvalidInput("write mesh: triangle " + std::to_string(t) + ": found vertex " + std::to_string(v) +
                                   ", expected an index below " + std::to_string(mesh.positions_mm.size()));
    if (!input.triangle_colors.empty() && input.triangle_colors.size() != mesh.triangles.size())
        throw InvalidInput("write mesh: found " + std::to_string(input.triangle_colors.size()) + " colours, expected " +
                           std::to_string(mesh.triangles.size()) + ", one per triangle");
}

void append_coordinate(std::string& out, double value, CoordinatePrecision precision) {
    if (precision == CoordinatePrecision::kFloat) {
        append_float(out, value);
    } else {
        append_number(out, value);
    }
}

}  // namespace fretwork
