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

/// Sums over the samples of one pixel.
struct PixelSum {
    Vec3f met = Vec3f::Zero();    ///< shown colour of samples that met model or floor
    Vec3f open = Vec3f::Zero();   ///< of those that met nothing
    Vec3f light = Vec3f::Zero();  ///< incoming light of those that met something
    Vec3f normal = Vec3f::Zero();
    float depth = 0;
    int count_met = 0;

    void add(const Vec3f& shown, const Vec3f& incoming, const Vec3f& n, float distance) {
        met += shown;
        light += incoming;
        normal += n;
        depth += distance;
        ++count_met;
    }
};

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
        for (int y = y0; y < std::min(settings_.height, y0 + kTile); ++y)
            for (int x = x0; x < std::min(settings_.width, x0 + kTile); ++x) draw_pixel(x, y);
    }

    [[nodiscard]] Image finish() const;

  private:
    [[nodiscard]] std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(settings_.width) + static_cast<std::size_t>(x);
    }
    /// The light found by the previous sample of a pixel, for the next one to use if it meets the same surface.
    struct Found {
        Incoming in;
        Vec3f normal = Vec3f::Zero();
        float distance = -1;
    };

    void draw_pixel(int x, int y);
    void shade_model(const RayScene::Hit& hit, const Vec3f& direction, const SampleSequence& random, int sample,
                     Found& last, PixelSum& sum) const;
    bool shade_floor(const Vec3f& direction, const Vec3f& background, const SampleSequence& random, int sample,
                     Found& last, PixelSum& sum) const;

    const RenderSettings& settings_;
    Camera camera_;
    RayScene scene_;
    std::vector<std::array<Vec3f, 3>> normals_;
    std::span<const Rgb8> colors_;
    Lighting lighting_;
    Vec3f eye_;
    Vec3f material_, top_, bottom_;
    std::array<float, 256> linear_{};
    float floor_z_ = 0;
    float pixel_tangent_ = 0;  ///< width of a pixel over its distance
    std::vector<PixelSum> pixels_;
};

void Picture::draw_pixel(int x, int y) {
    const int n = settings_.samples_per_axis;
    const SampleSequence random(index(x, y));
    PixelSum& sum = pixels_[index(x, y)];
    Found on_model, on_floor;
    for (int s = 0; s < n * n; ++s) {
        const Vec2 at(x + (s % n + 0.5) / n, y + (s / n + 0.5) / n);
        const Vec3f direction = camera_.direction(at).cast<float>();
        const float down = static_cast<float>(at.y()) / static_cast<float>(settings_.height);
        const Vec3f background = top_ + down * (bottom_ - top_);
        if (const auto hit = scene_.first_hit(eye_, direction))
            shade_model(*hit, direction, random, s, on_model, sum);
        else if (!shade_floor(direction, background, random, s, on_floor, sum))
            sum.open += background;
    }
}

void Picture::shade_model(const RayScene::Hit& hit, const Vec3f& direction, const SampleSequence& random, int sample,
                          Found& last, PixelSum& sum) const {
    const std::array<Vec3f, 3>& corner = normals_[hit.triangle];
    Vec3f normal = (1 - hit.u - hit.v) * corner[0] + hit.u * corner[1] + hit.v * corner[2];
    if (normal.dot(hit.facet_normal) < 0) normal = -normal;
    const float length = normal.norm();
    normal = length > 0 ? Vec3f(normal / length) : hit.facet_normal;
    Vec3f albedo = material_;
    if (!colors_.empty()) {
        const Rgb8& c = colors_[hit.triangle];
        albedo = Vec3f(linear_[c[0]], linear_[c[1]], linear_[c[2]]);
    }
    // Light changes little within a pixel on one surface, and rays to the lights cost most: every second sample reuses
    // what the one before found.
    const bool same_surface =
        std::abs(hit.distance - last.distance) < 4 * pixel_tangent_ * hit.distance && normal.dot(last.normal) > 0.98f;
    if (sample % 2 == 0 || !same_surface)
        last = {
            lighting_.on_model(eye_ + hit.distance * direction, hit.facet_normal, normal, -direction, random, sample),
            normal, hit.distance};
    const Vec3f shown = expose(albedo.cwiseProduct(last.in.diffuse) + Vec3f::Constant(last.in.gloss));
    sum.add(shown, last.in.diffuse, normal, hit.distance);
}

bool Picture::shade_floor(const Vec3f& direction, const Vec3f& background, const SampleSequence& random, int sample,
                          Found& last, PixelSum& sum) const {
    if (!settings_.floor || direction.z() >= 0 || eye_.z() <= floor_z_) return false;
    const float distance = (floor_z_ - eye_.z()) / direction.z();
    const Vec3f point = eye_ + distance * direction;
    // The model lies within a circle of radius 1; its shadow fades out where it would be too faint to see.
    constexpr float kFadeFrom = 1.8f, kFadeTo = 3.0f;
    const float away = std::hypot(point.x(), point.y());
    if (away >= kFadeTo) return false;
    const float fade = std::clamp((kFadeTo - away) / (kFadeTo - kFadeFrom), 0.0f, 1.0f);
    if (sample % 2 == 0 || last.distance < 0)
        last = {{Vec3f::Constant(lighting_.on_floor(point, random, sample)), 0.0f}, Vec3f::UnitZ(), distance};
    const float light = 1 - fade * (1 - last.in.diffuse.x());
    sum.add(background * light, Vec3f::Constant(light), Vec3f::UnitZ(), distance);
    return true;
}

Image Picture::finish() const {
    std::vector<LightPixel> light(pixels_.size());
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
        const PixelSum& p = pixels_[i];
        if (p.count_met == 0) continue;
        const float share = 1.0f / static_cast<float>(p.count_met);
        light[i] = {p.light * share, p.normal * share, p.depth * share};
    }
    const std::vector<Vec3f> smooth = filter_light(light, settings_.width, settings_.height, pixel_tangent_);

    Image out{settings_.width, settings_.height, {}, false};
    out.pixels.resize(pixels_.size());
    const float share = 1.0f / static_cast<float>(settings_.samples_per_axis * settings_.samples_per_axis);
    parallel_for(pixels_.size(), 4096, [&](std::size_t i) {
        // The picture times the ratio of smooth to grainy light: colours keep their edges.
        const Vec3f ratio = smooth[i].array() / (light[i].light.array() + 1e-6f);
        const Vec3f c = share * (pixels_[i].open + pixels_[i].met.cwiseProduct(ratio));
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
        parallel_for(static_cast<std::size_t>(rows * columns), 1, [&](std::size_t tile) {
            run.throw_if_stopped();
            const int t = static_cast<int>(tile);
            picture.draw_tile(t % columns * kTile, y0 + t / columns * kTile);
        });
        run.checkpoint("render", 0.2 + 0.75 * std::min(1.0, static_cast<double>(y0 + kBand) / settings.height));
    }
    Image image = picture.finish();
    run.checkpoint("render", 1.0);
    return image;
}

}  // namespace fretwork
