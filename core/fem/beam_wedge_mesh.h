// Stage 5b: abstract graph -> fans of wedges at the samples, hexahedral beams along the edges (figure 8).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/vec.h"
#include "core/fem/facing_sheets.h"
#include "core/fem/stiffness_pattern.h"
#include "core/graph/abstract_graph.h"
#include "core/shell/surface_voxels.h"

namespace fretwork {

struct BeamGeometry {
    double thickness_mm = 2.0;
    double merge_angle_deg = 15.0;     ///< neighbours closer than this share a face of the fan
    double widest_wedge_deg = 120.0;   ///< wider gaps between neighbours are split by faces without a beam
    double radius_per_edge = 1.0 / 3;  ///< a fan reaches at most this share of its shortest edge
    double radius_per_width = 0.6;     ///< and of the width of the pattern at the sample
};

struct Wedge {
    std::array<NodeIndex, 6> nodes;  ///< bottom (centre, right, left), then top
    SampleIndex sample = 0;
};

struct Beam {
    /// Corners of the hexahedron: 0 3 7 4 at sample a, 1 2 6 5 at sample b; 0 and 1 right bottom seen from a to b.
    std::array<NodeIndex, 8> nodes;
    double width_mm = 0.0;  ///< mean of the two ends
    bool folds = false;     ///< a Jacobian is not positive, at a Gauss point, a corner or the centre
};

/// Stands for the material between two sheets whose walls have grown together.
struct Tie {
    std::array<NodeIndex, 8> nodes;  ///< as of a beam
    double side_mm = 0.0;            ///< of its square section
};

/// Nodes come in pairs, bottom and top, half a wall below and above the surface point along the sample's normal.
struct BeamWedgeMesh {
    std::vector<Vec3> nodes_mm;
    std::vector<std::uint32_t> first_node;  ///< per sample; its first two nodes are the fan's centre
    std::vector<Wedge> wedges;              ///< grouped by sample
    std::vector<Beam> beams;                ///< beams[e] belongs to edge e of the graph
    std::vector<Tie> ties;
    std::size_t folded_beams = 0;

    [[nodiscard]] std::size_t samples() const { return first_node.size() - 1; }
};

/// Every sample's neighbours are projected into its tangent plane and sorted by angle; half way
/// between two directions stands a node of the fan, so that each direction faces one side. Fans
/// close for any degree, 0 included. Beams whose two ends face apart (an edge over a rim) are joined
/// the other way round when that folds less.
/// \param half_width_voxels  of the pattern around each sample (`pattern_width.h`)
BeamWedgeMesh build_beam_wedge_mesh(const SurfaceVoxels& shell, const AbstractGraph& graph,
                                    std::span<const float> half_width_voxels, const BeamGeometry& geometry);

/// Adds a tie between the fans of two samples, from two corners of one to two of the other, bottom and top.
void add_ties(const std::vector<SheetTie>& ties, BeamWedgeMesh& mesh);

}  // namespace fretwork
