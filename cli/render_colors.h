// Colours of a carved 3MF by what its voxel data say.
#pragma once

#include <string>
#include <vector>

#include "core/exemplar/image.h"
#include "core/pipeline/stress_scale.h"
#include "formats/volumetric_reader.h"

namespace fretwork::cli {

enum class RenderColor { kPattern, kStress, kBridges, kLabels, kSolid };

/// \throws InvalidSetting  not a colouring.
RenderColor render_color_named(const std::string& name);

/// One colour per triangle: stress on a logarithmic scale of three decades up to the highest, bridges in orange, labels
/// as patches in colours of their own. The inside of the wall shows what the nearest of the outside does.
/// \throws InvalidInput  not one object with voxel data; data that the colouring does not find.
std::vector<Rgb8> render_colors(const VolumetricFile& file, RenderColor color, const std::string& source);

struct StressColors {
    StressScale scale;
    std::vector<Rgb8> colors;
};

/// One colour per value, on the scale that ends above the highest; 0 and less is not known.
StressColors stress_colors(const std::vector<double>& mpa);

}  // namespace fretwork::cli
