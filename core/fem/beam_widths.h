// Stage 5b: how wide the material is that each beam stands for.
#pragma once

#include <cstdint>
#include <vector>

#include "core/graph/abstract_graph.h"
#include "core/shell/surface_voxels.h"

namespace fretwork {

struct BeamWidths {
    std::vector<float> half_width_voxels;  ///< per voxel (`pattern_width.h`)
    std::vector<float> at_sample_voxels;   ///< half of the width of the pattern around each sample
    std::vector<double> along_edge_mm;     ///< width of the material along each edge
    std::vector<std::uint8_t> is_sliver;   ///< per edge: stands for no section of its own, see below
};

/// A solid edge is as wide as the pattern along its path (harmonic mean, as flexibility sees it), but
/// no wider than 1.5 times the border between the regions of its two samples: where the pattern is
/// wider than the samples are apart, the edges form a net that shares it. An empty edge is as wide as the bridge that
/// would be built there.
///
/// Slivers: in a wide place, regions of two samples may meet in next to a point. The edge between them is not a strand
/// but an accident of the sampling. It is one where its width is under half of the narrowest place along its path and
/// under a quarter of its length.
/// Cost: one pass over the links.
/// \param half_width_voxels  of `beam_half_widths`
BeamWidths beam_widths(const SurfaceVoxels& shell, const SolidStates& solid, const AbstractGraph& graph,
                       std::vector<float> half_width_voxels, double bridge_half_width_voxels);

/// `pattern_half_width` with a bound that does not matter here. Does not need the graph: the two can be made at once.
std::vector<float> beam_half_widths(const SurfaceVoxels& shell, const SolidStates& solid);

}  // namespace fretwork
