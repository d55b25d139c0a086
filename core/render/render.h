// A shaded picture of a model, drawn without a display.
#pragma once

#include <optional>
#include <span>

#include "core/base/run_control.h"
#include "core/exemplar/image.h"
#include "core/mesh/triangle_mesh.h"

namespace fretwork {

struct RenderSettings {
    int width = 1200;             ///< px, [16, 8192]
    int height = 1200;            ///< px, [16, 8192]
    double azimuth_deg = 30.0;    ///< of the eye around z: 0 looks along +y with +x to the right, 90 along -x
    double elevation_deg = 20.0;  ///< of the eye above the horizon, [-90, 90]
    double zoom = 1.0;            ///< 1 frames the whole model, 2 shows half of that width; [0.01, 1000]
    std::optional<Vec3> look_at_mm = std::nullopt;  ///< in the middle of the picture; empty: the middle of the model
    double field_of_view_deg = 24.0;                ///< (0, 120]; small values flatten perspective
    int samples_per_axis = 3;  ///< anti-aliasing: squared rays per pixel where it shows an edge, [1, 16]
    bool quick = false;        ///< pixels that look like all their neighbours get one ray from the eye; for drafts
    bool shadows = true;       ///< soft key light and ambient occlusion
    double crease_angle_deg = 40.0;  ///< facets that meet at less look smooth; 0 shows every facet
    Rgb8 background_top = {236, 240, 244};
    Rgb8 background_bottom = {190, 198, 208};
    Rgb8 material = {214, 205, 190};  ///< where no colour is given
    bool floor = true;                ///< a plane under the model that receives its shadow
};

/// Draws `mesh` with z up. The frame is chosen so that the model fills it; a key light from the upper left and a
/// bright sky shade it, both with soft shadows, so that the inside of a carved wall is seen through its holes.
/// Both sides of a triangle are drawn.
///
/// Colour   a surface that faces the light shows about its own colour; highlights roll off without a shift of hue.
/// Repeats  the same arguments give the same bytes for any number of threads.
/// Cost     about 4 s of CPU for 1200 x 1200 px of a million triangles, half of it if quick; 200 bytes per triangle, 80
/// per pixel.
///
/// \param triangle_colors  sRGB, one per triangle, or empty
/// \throws InvalidInput    no triangle, an index past the end, a coordinate that is not finite, a number of colours
///                         other than the number of triangles
/// \throws InvalidSetting  a setting out of range
/// \throws Cancelled       `run` asked to stop
Image render(const TriangleMesh& mesh, std::span<const Rgb8> triangle_colors, const RenderSettings& settings = {},
             const RunControl& run = {});

}  // namespace fretwork
