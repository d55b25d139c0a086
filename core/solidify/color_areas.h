// Areas of one colour on a mesh, with edges along their borders.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/base/run_control.h"
#include "core/exemplar/image.h"
#include "core/mesh/triangle_mesh.h"
#include "core/solidify/mesh_areas.h"

namespace fretwork {

struct ColorAreas {
    TriangleMesh mesh;          ///< the vertices of the input, then those on borders
    std::vector<Rgb8> palette;  ///< per area; empty: colours are not known by area
    MeshAreas areas;
    std::vector<std::uint32_t> parent;  ///< per vertex on a border: an end of the edge it was put on
};

/// The colours that stand for all of `colors`: the most frequent ones, no two of which are alike, moved to the middle
/// of those they stand for. At most twelve, at least one; the same whatever the order of `colors`.
std::vector<Rgb8> choose_palette(const std::vector<Rgb8>& colors);

/// Gives every triangle one colour of the palette and puts vertices on the edges along which the colour changes, so
/// that borders between colours run as they were drawn instead of along whatever triangles there are.
/// \param colors   one per vertex
/// \param between  colour on the edge from one vertex to another, at a share of its length
ColorAreas cut_into_areas(const TriangleMesh& mesh, const std::vector<Rgb8>& colors,
                          const std::function<Rgb8(std::uint32_t, std::uint32_t, double)>& between,
                          const RunControl& run);

}  // namespace fretwork
