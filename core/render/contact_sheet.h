// Several pictures on one sheet.
#pragma once

#include <span>
#include <vector>

#include "core/exemplar/image.h"
#include "core/render/render.h"

namespace fretwork {

/// Pictures side by side, `columns` per row, from the upper left; each column as wide and each row as high as its
/// largest picture, which stand in the middle of their cells.
/// \throws InvalidInput  no picture, an empty one, or fewer than one column
Image contact_sheet(std::span<const Image> pictures, int columns, int gap_px = 8, const Rgb8& paper = {255, 255, 255});

/// The same model from several sides: one view per azimuth, otherwise as `settings` say (size per view).
/// \throws as `render`
Image render_around(const TriangleMesh& mesh, std::span<const Rgb8> triangle_colors,
                    std::span<const double> azimuths_deg, const RenderSettings& settings = {},
                    const RunControl& run = {});

}  // namespace fretwork
