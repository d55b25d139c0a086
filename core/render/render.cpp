#include "core/render/render.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/exemplar/color_space.h"
#include "core/render/camera.h"
#include "core/render/corner_normals.h"
#include "core/render/light_filter.h"
#include "core/render/lighting.h"
#include "core/render/ray_scene.h"

namespace fretwork {
namespace {

constexpr int kTile = 16;
/// Light samples of a pixel that looks like its neighbours, in quick pictures. The filter of the light sees to the
/// rest.
constexpr int kQuickLight = 2;

void check_range(const char* name, double value, double low, double high) {
    if (!(value >= low && value <= high))
        throw InvalidSetting("render: " + std::string(name) + " is " + std::to_string(value) + "; expected " +
                             std::to_string(low) + " to " + std::to_string(high));
}

void check(const RenderSettings& s) {
    check_range("width", s.width, 16, 8192);
    check_range("height", s.height, 16, 8192);
    check_range("azimuth_deg", s.azimuth_deg, -1e6, 1e6);
    check_range("elevation_deg", s.elevation_deg, -90, 90);
    check_range("zoom", s.zoom, 0.01, 1000);
    check_range("field_of_view_deg", s.field_of_view_deg, 0.1, 120);
    check_range("samples_per_axis", s.samples_per_axis, 1, 16);
    check_range("crease_angle_deg", s.crease_angle_deg, 0, 180);
    if (s.look_at_mm && !s.look_at_mm->allFinite()) throw InvalidSetting("render: look_at_mm is not finite");
}

void check(const TriangleMesh& mesh, std::span<const Rgb8> colors) {
    if (mesh.triangles.empty()) throw InvalidInput("render: the mesh has no triangle");
    if (!colors.empty() && colors.size() != mesh.triangles.size())
        throw InvalidInput("render: " + std::to_string(colors.size()) + " colours for " +
                           std::to_string(mesh.triangles.size()) + " triangles; expected one each or none");
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (const std::uint32_t v : mesh.triangles[t]) {
            if (v >= mesh.positions_mm.size())
                throw InvalidInput("render: triangle " + std::to_string(t) + " names vertex " + std::to_string(v) +
                                   " of " + std::to_string(mesh.positions_mm.size()));
            if (!mesh.positions_mm[v].allFinite())
                throw InvalidInput("render: vertex " + std::to_string(v) + " is not finite");
        }
}

/// Only points of triangles are framed; loose vertices are not seen.
std::vector<Vec3> used_points(const TriangleMesh& mesh) {
    std::vector<std::uint8_t> used(mesh.positions_mm.size(), 0);
    for (const Triangle& t : mesh.triangles)
        for (const std::uint32_t v : t) used[v] = 1;
    std::vector<Vec3> points;
    for (std::size_t v = 0; v < used.size(); ++v)
        if (used[v] != 0) points.push_back(mesh.positions_mm[v]);
    return points;
}

Vec3f linear(const Rgb8& c) {
    return {srgb_to_linear(static_cast<float>(c[0]) / 255.0f), srgb_to_linear(static_cast<float>(c[1]) / 255.0f),
            srgb_to_linear(static_cast<float>(c[2]) / 255.0f)};
}

/// Rolls off what is brighter than paper; all channels by the same factor, which keeps the hue.
Vec3f expose(const Vec3f& radiance) {
    constexpr float kShoulder = 0.8f;
    const float peak = radiance.maxCoeff();
    if (peak <= kShoulder) return radiance;
    const float rolled = 1 - (1 - kShoulder) * std::exp(-(peak - kShoulder) / (1 - kShoulder));
    return radiance * (rolled / peak);
}

/// The model lies within a circle of radius 1 around the origin; its shadow on the floor fades from here to there.
constexpr float kFloorFades = 1.8f, kFloorEnds = 3.0f;

/// What one ray from the eye meets.
struct Surface {
    enum Kind { kNothing, kFloor, kModel };
    Kind kind = kNothing;
    float distance = 0;
    Vec3f facet = Vec3f::UnitZ();
    Vec3f normal = Vec3f::UnitZ();
    Vec3f albedo = Vec3f::Zero();
};

/// Sums over the samples of one pixel.
struct PixelSum {
    Vec3f model = Vec3f::Zero();  ///< light sent to the eye by the model
    Vec3f floor = Vec3f::Zero();  ///< by the floor
    Vec3f open = Vec3f::Zero();   ///< by the background
    Vec3f light = Vec3f::Zero();  ///< incoming, of the samples that met model or floor
    Vec3f normal = Vec3f::Zero();
    float depth = 0;
    int count_model = 0;
    int count_met = 0;  ///< model or floor
    int count = 0;

    void add(const Vec3f& incoming, const Surface& seen) {
        light += incoming;
        normal += seen.normal;
        depth += seen.distance;
        ++count_met;
    }
};

/// Where the samples of a pixel lie in it: a regular grid, its corners first.
std::vector<Vec2> sample_places(int per_axis) {
    std::vector<Vec2> corners, others;
    for (int s = 0; s < per_axis * per_axis; ++s) {
        const int i = s % per_axis, j = s / per_axis;
        const bool corner = (i == 0 || i == per_axis - 1) && (j == 0 || j == per_axis - 1);
        (corner ? corners : others).emplace_back((i + 0.5) / per_axis, (j + 0.5) / per_axis);
    }
    corners.insert(corners.end(), others.begin(), others.end());
    return corners;
}

class Picture {
  public:
    Picture(const TriangleMesh& mesh, std::span<const Rgb8> colors, const RenderSettings& settings,
            const std::vector<Vec3>& points, const RunControl& run)
        : settings_(settings),
          camera_(points, settings),
          scene_(mesh, run),
          normals_(corner_normals(mesh, settings.crease_angle_deg)),
          colors_(colors),
          lighting_(scene_, camera_, settings.shadows),
          places_(sample_places(settings.samples_per_axis)),
          eye_(scene_.to_scene(camera_.eye_mm()).cast<float>()),
          material_(linear(settings.material)),
          top_(linear(settings.background_top)),
          bottom_(linear(settings.background_bottom)) {
        for (std::size_t v = 0; v < 256; ++v) linear_[v] = srgb_to_linear(static_cast<float>(v) / 255.0f);
        double lowest = std::numeric_limits<double>::infinity();
        for (const Vec3& p : points) lowest = std::min(lowest, scene_.to_scene(p).z());
        floor_z_ = static_cast<float>(lowest);
        const Vec2 middle(settings.width / 2.0, settings.height / 2.0);
        pixel_tangent_ =
            static_cast<float>((camera_.direction(middle) - camera_.direction(middle + Vec2::UnitX())).norm());
        pixels_.resize(static_cast<std::size_t>(settings.width) * static_cast<std::size_t>(settings.height));
    }

    void draw_tile(int x0, int y0) {
        if (settings_.quick) return draw_quick_tile(x0, y0);
        for (int y = y0; y < std::min(settings_.height, y0 + kTile); ++y)
            for (int x = x0; x < std::min(settings_.width, x0 + kTile); ++x) draw_pixel(x, y);
    }

    [[nodiscard]] Image finish(const RunControl& run) const;

  private:
    [[nodiscard]] std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(settings_.width) + static_cast<std::size_t>(x);
    }
    void draw_quick_tile(int x0, int y0);
    void draw_pixel(int x, int y);
    [[nodiscard]] Vec3f background_at(double y) const {
        return top_ + static_cast<float>(y) / static_cast<float>(settings_.height) * (bottom_ - top_);
    }
    [[nodiscard]] Surface look(const Vec3f& direction) const;
    void add_light(const Surface& seen, const Vec3f& direction, const Vec3f& background, const SampleSequence& random,
                   int sample, PixelSum& sum) const;
    [[nodiscard]] bool alike(const Surface& a, const Surface& b) const;

    const RenderSettings& settings_;
    Camera camera_;
    RayScene scene_;
    std::vector<std::array<Vec3f, 3>> normals_;
    std::span<const Rgb8> colors_;
    Lighting lighting_;
    std::vector<Vec2> places_;
    Vec3f eye_;
    Vec3f material_, top_, bottom_;
    std::array<float, 256> linear_{};
    float floor_z_ = 0;
    float pixel_tangent_ = 0;  ///< width of a pixel over its distance
    std::vector<PixelSum> pixels_;
};

// Looks through the middle of each pixel first, and closer where that is unlike what is seen through a neighbour.
void Picture::draw_quick_tile(int x0, int y0) {
    constexpr int kSide = kTile + 2;
    std::array<Surface, kSide * kSide> middle;
    const auto at = [&](int x, int y) -> Surface& {
        const int place = (y - y0 + 1) * kSide + (x - x0 + 1);
        return middle[static_cast<std::size_t>(place)];
    };
    const auto direction = [&](int x, int y) -> Vec3f {
        return camera_.direction(Vec2(x + 0.5, y + 0.5)).cast<float>();
    };
    const int x1 = std::min(settings_.width, x0 + kTile), y1 = std::min(settings_.height, y0 + kTile);
    for (int y = y0 - 1; y <= y1; ++y)
        for (int x = x0 - 1; x <= x1; ++x) at(x, y) = look(direction(x, y));
    for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x) {
            const Surface& seen = at(x, y);
            bool plain = true;
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx) plain = plain && alike(seen, at(x + dx, y + dy));
            if (!plain) {
                draw_pixel(x, y);
                continue;
            }
            const SampleSequence random(index(x, y));
            for (int s = 0; s < kQuickLight; ++s)
                add_light(seen, direction(x, y), background_at(y + 0.5), random, s, pixels_[index(x, y)]);
        }
}

void Picture::draw_pixel(int x, int y) {
    const SampleSequence random(index(x, y));
    PixelSum& sum = pixels_[index(x, y)];
    Surface first;
    bool uniform = true;
    for (std::size_t s = 0; s < places_.size(); ++s) {
        // The first four samples lie in the corners; where they agree, the rest would as well.
        constexpr std::size_t kCorners = 4;
        if (s == kCorners && uniform) return;
        const Vec2 at = Vec2(x, y) + places_[s];
        const Vec3f direction = camera_.direction(at).cast<float>();
        const Surface seen = look(direction);
        add_light(seen, direction, background_at(at.y()), random, static_cast<int>(s), sum);
        if (s == 0) first = seen;
        uniform = uniform && alike(first, seen);
    }
}

Surface Picture::look(const Vec3f& direction) const {
    Surface seen;
    if (const auto hit = scene_.first_hit(eye_, direction)) {
        const std::array<Vec3f, 3>& corner = normals_[hit->triangle];
        Vec3f normal = (1 - hit->u - hit->v) * corner[0] + hit->u * corner[1] + hit->v * corner[2];
        if (normal.dot(hit->facet_normal) < 0) normal = -normal;
        const float length = normal.norm();
        seen.kind = Surface::kModel;
        seen.distance = hit->distance;
        seen.facet = hit->facet_normal;
        seen.normal = length > 0 ? Vec3f(normal / length) : hit->facet_normal;
        seen.albedo = material_;
        if (!colors_.empty()) {
            const Rgb8& c = colors_[hit->triangle];
            seen.albedo = Vec3f(linear_[c[0]], linear_[c[1]], linear_[c[2]]);
        }
    } else if (settings_.floor && direction.z() < 0 && eye_.z() > floor_z_) {
        seen.distance = (floor_z_ - eye_.z()) / direction.z();
        const Vec3f point = eye_ + seen.distance * direction;
        if (std::hypot(point.x(), point.y()) < kFloorEnds) seen.kind = Surface::kFloor;
    }
    return seen;
}

void Picture::add_light(const Surface& seen, const Vec3f& direction, const Vec3f& background,
                        const SampleSequence& random, int sample, PixelSum& sum) const {
    const Vec3f point = eye_ + seen.distance * direction;
    ++sum.count;
    if (seen.kind == Surface::kNothing) {
        sum.open += background;
    } else if (seen.kind == Surface::kFloor) {
        const float away = std::hypot(point.x(), point.y());
        const float fade = std::clamp((kFloorEnds - away) / (kFloorEnds - kFloorFades), 0.0f, 1.0f);
        const float light = 1 - fade * (1 - lighting_.on_floor(point, random, sample));
        sum.floor += background * light;
        sum.add(Vec3f::Constant(light), seen);
    } else {
        const Incoming in = lighting_.on_model(point, seen.facet, seen.normal, -direction, random, sample);
        sum.model += seen.albedo.cwiseProduct(in.diffuse) + Vec3f::Constant(in.gloss);
        ++sum.count_model;
        sum.add(in.diffuse, seen);
    }
}

bool Picture::alike(const Surface& a, const Surface& b) const {
    if (a.kind != b.kind) return false;
    if (a.kind != Surface::kModel) return true;
    return a.normal.dot(b.normal) > 0.97f && (a.albedo - b.albedo).cwiseAbs().maxCoeff() < 0.01f &&
           std::abs(a.distance - b.distance) < 6 * pixel_tangent_ * a.distance;
}

Image Picture::finish(const RunControl& run) const {
    std::vector<LightPixel> light(pixels_.size());
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
        const PixelSum& p = pixels_[i];
        if (p.count_met == 0) continue;
        const float share = 1.0f / static_cast<float>(p.count_met);
        light[i] = {p.light * share, p.normal * share, p.depth * share};
    }
    const std::vector<Vec3f> smooth = filter_light(light, settings_.width, settings_.height, pixel_tangent_, run);

    Image out{settings_.width, settings_.height, {}, false};
    out.pixels.resize(pixels_.size());
    parallel_for(pixels_.size(), 4096, [&](std::size_t i) {
        // The picture times the ratio of smooth to grainy light: colours keep their edges.
        const Vec3f ratio = smooth[i].array() / (light[i].light.array() + 1e-6f);
        const PixelSum& p = pixels_[i];
        const auto models = static_cast<float>(std::max(p.count_model, 1));
        const Vec3f model = models * expose(p.model.cwiseProduct(ratio) / models);
        const Vec3f c = (p.open + p.floor.cwiseProduct(ratio) + model) / static_cast<float>(p.count);
        out.pixels[i] = {to_byte(linear_to_srgb(c.x())), to_byte(linear_to_srgb(c.y())), to_byte(linear_to_srgb(c.z())),
                         255};
    });
    return out;
}

}  // namespace

Image render(const TriangleMesh& mesh, std::span<const Rgb8> triangle_colors, const RenderSettings& settings,
             const RunControl& run) {
    check(settings);
    check(mesh, triangle_colors);
    run.checkpoint("render", 0.0);
    Picture picture(mesh, triangle_colors, settings, used_points(mesh), run);
    run.checkpoint("render", 0.2);

    constexpr int kBand = 4 * kTile;
    const int columns = (settings.width + kTile - 1) / kTile;
    for (int y0 = 0; y0 < settings.height; y0 += kBand) {
        const int rows = (std::min(kBand, settings.height - y0) + kTile - 1) / kTile;
        const int tiles = rows * columns;
        parallel_for(static_cast<std::size_t>(tiles), 1, [&](std::size_t tile) {
            run.throw_if_stopped();
            const int t = static_cast<int>(tile);
            picture.draw_tile(t % columns * kTile, y0 + t / columns * kTile);
        });
        run.checkpoint("render", 0.2 + 0.75 * std::min(1.0, static_cast<double>(y0 + kBand) / settings.height));
    }
    Image image = picture.finish(run);
    run.checkpoint("render", 1.0);
    return image;
}

}  // namespace fretwork
