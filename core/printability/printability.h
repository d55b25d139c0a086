// Stage 9: what a printer that works in layers will make of a mesh. The paper asks for printability and measures none;
// all of this goes beyond it.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/base/run_control.h"
#include "core/mesh/triangle_mesh.h"

namespace fretwork {

struct PrintabilitySettings {
    double layer_height_mm = 0.2;  ///< range 0.01 to 10
    double overhang_deg = 45.0;    ///< undersides that lean further from the vertical need support; range 0 to 89
    double min_feature_mm = 0.8;   ///< narrower solid is listed as thin; above 0
    double min_hole_mm = 0.8;      ///< narrower gaps are listed as narrow; above 0
    std::size_t bodies = 1;        ///< pieces that are meant to be apart
};

/// Where something was found, and how large it is.
struct PrintPlace {
    Vec3 at_mm = Vec3::Zero();
    double size_mm = 0.0;
};

/// Areas, spans and reaches lie in the planes of the layers, whose heights are their middles, as slicers cut them.
struct PrintabilityReport {
    double layer_height_mm = 0.0;
    std::size_t layers = 0;                ///< from the lowest point up
    std::size_t empty_layers = 0;          ///< that hold nothing, below the last
    double first_layer_contact_mm2 = 0.0;  ///< what stands on the bed
    double material_mm3 = 0.0;

    /// Parts of a layer with nothing below them, above the first layer. Parts less than 0.1 mm apart are one, as
    /// slicers see them.
    std::size_t islands = 0;
    std::vector<std::size_t> islands_per_layer;
    std::vector<PrintPlace> island_places;  ///< the largest, at most kMostPlaces; size is the root of the area
    double overhang_area_mm2 = 0.0;         ///< further out than `overhang_deg` allows, summed over layers
    PrintPlace longest_bridge;              ///< unsupported between two supports; size is the span. Zero: none.
    PrintPlace longest_cantilever;          ///< unsupported beyond one support; size is how far. Zero: none.

    /// Of material between opposite walls, and of gaps between them, wherever they run: not within layers, where a
    /// crotch looks like a gap of no width.
    double thin_share = 0.0, narrow_share = 0.0;        ///< of the surface, with less than was asked for
    std::optional<PrintPlace> least_solid, least_hole;  ///< half a percent of the surface has less; none: all has more

    std::size_t loose_parts = 0;      ///< pieces of surface that bound material, beyond `bodies`
    std::size_t closed_cavities = 0;  ///< pieces of surface that bound a hollow without a way out
};

inline constexpr std::size_t kMostPlaces = 20;

/// The mesh is meant to be closed; loops that its holes leave open are dropped.
/// Spans and reaches to a twentieth of themselves or 0.1 mm; widths from at most 60000 points.
/// Same result for any number of threads. Cost  about 2 ms per layer of a carved figure, on all threads.
/// \throws InvalidInput    no triangle, or a coordinate that is not finite; more than 100000 layers.
/// \throws InvalidSetting  a setting out of range.
/// \throws Cancelled       `run` asked to stop.
PrintabilityReport printability(const TriangleMesh& mesh, const PrintabilitySettings& settings,
                                const RunControl& run = {});

/// How many layers of this height `printability` would look at.
/// \throws InvalidInput  more than 100000, as printability
std::size_t layer_count(const TriangleMesh& mesh, double layer_height_mm);

}  // namespace fretwork
