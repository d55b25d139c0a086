// Small shells and exemplars for the tests of the synthesis.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/exemplar/exemplar.h"
#include "core/pyramid/voxel_pyramid.h"
#include "core/shell/voxelize.h"
#include "core/synthesis/synthesizer.h"
#include "support/make_meshes.h"
#include "support/make_pictures.h"

namespace fretwork::testing {

/// A shell and its pyramid.
struct PyramidCase {
    SurfaceVoxels shell;
    VoxelPyramid pyramid;
};

inline PyramidCase pyramid_of(const TriangleMesh& mesh, int resolution, int levels = 8) {
    PyramidCase c;
    c.shell = voxelize(mesh, {.resolution = resolution});
    c.pyramid = build_pyramid(c.shell, levels);
    return c;
}

inline PyramidCase sphere_case(int resolution) {
    return pyramid_of(make_icosphere(10, 4), resolution);
}

/// Upright, so that "up" runs within it.
inline PyramidCase plate_case(int resolution) {
    TriangleMesh mesh = make_square(10, 2);
    for (Vec3& p : mesh.positions_mm) p = Vec3(p.x(), 0.03, p.y());
    return pyramid_of(mesh, resolution);
}

inline Rgba8 mix(double share, const Rgb8& a, const Rgb8& b) {
    Rgba8 pixel{0, 0, 0, 255};
    for (std::size_t c = 0; c < 3; ++c) pixel[c] = static_cast<std::uint8_t>(a[c] + share * (b[c] - a[c]));
    return pixel;
}

inline Exemplar exemplar_of(const Image& picture, bool tileable) {
    ExemplarSettings settings;
    settings.tileable = tileable;
    return make_exemplar(picture, nullptr, settings);
}

/// Smooth hills of whole periods, so that it tiles; no two places alike.
inline Exemplar hills(int width, int height, bool tileable = true) {
    return exemplar_of(make_picture(width, height,
                                    [&](int x, int y) {
                                        const double a = 2 * std::numbers::pi * (x + 0.5) / width;
                                        const double b = 2 * std::numbers::pi * (y + 0.5) / height;
                                        const double h = std::sin(a) + std::cos(b) + 0.5 * std::sin(2 * a + b);
                                        return mix((h + 2.5) / 5.0, {20, 40, 60}, {230, 200, 180});
                                    }),
                       tileable);
}

/// Dark discs on light ground in an uneven grid; tiles.
inline Exemplar discs(int side, double radius_px, bool tileable = true) {
    return exemplar_of(
        make_picture(side, side,
                     [&](int x, int y) {
                         double nearest = 1e9;
                         for (int j = 0; j < 4; ++j)
                             for (int i = 0; i < 4; ++i) {
                                 const double cx = side * (i + 0.5 + 0.3 * std::sin(3.0 * i + 5.0 * j)) / 4;
                                 const double cy = side * (j + 0.5 + 0.3 * std::cos(2.0 * i + 7.0 * j)) / 4;
                                 const double dx = std::remainder(x + 0.5 - cx, side);
                                 const double dy = std::remainder(y + 0.5 - cy, side);
                                 nearest = std::min(nearest, std::hypot(dx, dy));
                             }
                         return grey(nearest < radius_px ? 30 : 220);
                     }),
        tileable);
}

/// Slanted stripes, half dark; tiles.
inline Exemplar stripes(int side) {
    return exemplar_of(make_picture(side, side,
                                    [&](int x, int y) {
                                        const double t = 2 * std::numbers::pi * (4 * x + y) / side;
                                        return grey(std::sin(t) < 0 ? 30 : 220);
                                    }),
                       true);
}

/// M at distance d from the voxel's point, in pixels.
inline Vec2 texel_of(const TexelFrame& f, const Vec3f& d) {
    return {static_cast<double>(f.u) + f.du.cast<double>().dot(d.cast<double>()),
            static_cast<double>(f.v) + f.dv.cast<double>().dot(d.cast<double>())};
}

/// What is left of a difference of positions after whole periods are taken off.
inline Vec2 modulo_period(const Vec2& difference, const Exemplar& e) {
    return {std::remainder(difference.x(), e.width), std::remainder(difference.y(), e.height)};
}

}  // namespace fretwork::testing
