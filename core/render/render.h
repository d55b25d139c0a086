// A shaded picture of a model, drawn without a display.
#pragma once

#include <span>

#include "core/base/run_control.h"
#include "core/exemplar/image.h"
#include "core/mesh/triangle_mesh.h"

namespace fretwork {

struct RenderSettings {
    int width = 1200;
    int height = 1200;
    double azimuth_deg = 30.0;    ///< of the eye around z, 0 looks along +y
    double elevation_deg = 20.0;  ///< of the eye above the horizon
    double zoom = 1.0;
    int samples_per_axis = 3;  ///< anti-aliasing: squared rays per pixel
    bool shadows = true;       ///< soft key light and ambient occlusion
    Rgb8 background_top = {236, 240, 244};
    Rgb8 background_bottom = {190, 198, 208};
    Rgb8 material = {214, 205, 190};  ///< where no colour is given
    bool floor = true;                ///< a plane that receives the shadow
};

/// \param triangle_colors  sRGB, one per triangle, or empty
/// \throws InvalidInput  no triangle; InvalidSetting  a size outside [16, 8192] px.
Image render(const TriangleMesh& mesh, std::span<const Rgb8> triangle_colors, const RenderSettings& settings = {},
             const RunControl& run = {});

}  // namespace fretwork
