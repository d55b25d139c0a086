#include "core/render/render.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <string>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/render/camera.h"
#include "core/render/contact_sheet.h"
#include "core/render/corner_normals.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

using testing::make_box;
using testing::make_icosphere;

/// Pure green behind the model, which nothing that is tested has.
RenderSettings on_green(int side_px) {
    RenderSettings s;
    s.width = side_px;
    s.height = side_px;
    s.background_top = s.background_bottom = {0, 255, 0};
    s.floor = false;
    return s;
}

/// Share of the pixels that are not wholly background.
double model_share(const Image& image) {
    double covered = 0;
    for (const Rgba8& p : image.pixels) covered += p == Rgba8{0, 255, 0, 255} ? 0.0 : 1.0;
    return covered / static_cast<double>(image.pixels.size());
}

void append(TriangleMesh& mesh, const TriangleMesh& part) {
    const auto offset = static_cast<std::uint32_t>(mesh.positions_mm.size());
    mesh.positions_mm.insert(mesh.positions_mm.end(), part.positions_mm.begin(), part.positions_mm.end());
    for (const Triangle& t : part.triangles) mesh.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
}

TEST_CASE("render: a sphere's outline is the disc of perspective", "[render]") {
    const TriangleMesh sphere = make_icosphere(1.0, 5);
    RenderSettings settings = on_green(300);
    settings.field_of_view_deg = GENERATE(10.0, 24.0, 60.0);
    settings.zoom = GENERATE(1.0, 0.6);
    settings.azimuth_deg = 77;
    CAPTURE(settings.field_of_view_deg, settings.zoom);

    // An eye at distance d sees a unit sphere under the half angle asin(1 / d). The size of a pixel on the image plane
    // follows from where the centre and a point one to the right of it appear.
    const Camera camera(sphere.positions_mm, settings);
    const double d = camera.eye_mm().norm();
    const double px_per_tangent = d * (camera.project(camera.right()) - camera.project(Vec3::Zero())).norm();
    const double radius_px = px_per_tangent * std::tan(std::asin(1 / d));
    const double disc = std::numbers::pi * radius_px * radius_px / (300.0 * 300.0);

    // Every pixel the outline touches counts as covered: half a pixel more on each side.
    const double touched = disc * std::pow((radius_px + 0.5) / radius_px, 2);
    CHECK(model_share(render(sphere, {}, settings)) == Approx(touched).epsilon(0.01));
    if (settings.zoom == 1.0) CHECK(2 * radius_px == Approx(300 / 1.05).epsilon(0.002));  // it fills the frame
}

TEST_CASE("render: a surface in full light shows about its own colour", "[render]") {
    const TriangleMesh sphere = make_icosphere(1.0, 3);
    RenderSettings settings = on_green(64);
    for (const Rgb8& color : {Rgb8{200, 40, 40}, Rgb8{40, 60, 200}, Rgb8{210, 210, 210}, Rgb8{30, 30, 30}}) {
        CAPTURE(color);
        const std::vector<Rgb8> colors(sphere.triangles.size(), color);
        const Image image = render(sphere, colors, settings);
        // Up and to the left of the middle, half-way to the light.
        const Rgba8& lit = image.at(27, 25);
        for (std::size_t k = 0; k < 3; ++k) CHECK(std::abs(lit[k] - color[k]) <= 35);
        // Down on the right lies shade of the same hue.
        const Rgba8& shade = image.at(44, 50);
        CHECK(shade[0] + shade[1] + shade[2] < lit[0] + lit[1] + lit[2]);
    }
}

TEST_CASE("render: +x appears on the right of a viewer who looks along +y", "[render]") {
    struct View {
        double azimuth_deg, elevation_deg;
        Vec3 marked;      // where a red ball sits
        int side, above;  // -1, 0, +1: where it must appear
    };
    const View view =
        GENERATE(View{0, 0, Vec3(1, 0, 0), 1, 0}, View{0, 0, Vec3(0, 0, 1), 0, 1}, View{90, 0, Vec3(0, 1, 0), 1, 0},
                 View{180, 0, Vec3(1, 0, 0), -1, 0}, View{0, 90, Vec3(1, 0, 0), 1, 0}, View{0, 90, Vec3(0, 1, 0), 0, 1},
                 View{0, -90, Vec3(0, 1, 0), 0, -1});
    CAPTURE(view.azimuth_deg, view.elevation_deg, view.marked);
    TriangleMesh mesh;
    for (int axis = 0; axis < 3; ++axis)
        for (const double end : {-1.0, 1.0}) append(mesh, make_icosphere(0.1, 2, end * Vec3::Unit(axis)));
    std::vector<Rgb8> colors(mesh.triangles.size(), Rgb8{40, 40, 40});
    for (std::size_t t = 0; t < colors.size(); ++t)
        if ((mesh.positions_mm[mesh.triangles[t][0]] - view.marked).norm() < 0.2) colors[t] = {255, 0, 0};

    RenderSettings settings = on_green(120);
    settings.azimuth_deg = view.azimuth_deg;
    settings.elevation_deg = view.elevation_deg;
    const Image image = render(mesh, colors, settings);
    double x = 0, y = 0, count = 0;
    for (int py = 0; py < image.height; ++py)
        for (int px = 0; px < image.width; ++px) {
            const Rgba8& p = image.at(px, py);
            if (p[0] < 120 || p[1] > 100) continue;
            x += px + 0.5;
            y += py + 0.5;
            ++count;
        }
    REQUIRE(count > 20);
    CHECK(x / count - 60 == Approx(50.0 * view.side).margin(7));
    CHECK(60 - y / count == Approx(50.0 * view.above).margin(7));
    // The camera's own account agrees with what was drawn.
    const Vec2 told = Camera(mesh.positions_mm, settings).project(view.marked);
    CHECK((told - Vec2(x, y) / count).norm() < 1.0);
}

TEST_CASE("render: look-at and zoom crop the same view", "[render]") {
    const TriangleMesh box = make_box(Vec3(0, 0, 0), Vec3(4, 2, 1));
    RenderSettings whole = on_green(200), part = on_green(200);
    part.look_at_mm = Vec3(4, 0, 1);
    part.zoom = 3;
    const Camera a(box.positions_mm, whole), b(box.positions_mm, part);
    CHECK((b.project(*part.look_at_mm) - Vec2(100, 100)).norm() < 1e-9);
    // Same eye, same plane: places differ by a shift and the zoom only.
    CHECK((a.eye_mm() - b.eye_mm()).norm() == 0.0);
    for (const Vec3& p : box.positions_mm) {
        const Vec2 expected = Vec2(100, 100) + 3 * (a.project(p) - a.project(*part.look_at_mm));
        CHECK((b.project(p) - expected).norm() < 1e-9);
    }
}

TEST_CASE("render: pixel directions and projection are inverse", "[render]") {
    const TriangleMesh box = make_box(Vec3(-1, 5, 2), Vec3(4, 9, 3));
    RenderSettings settings;
    settings.width = 320;
    settings.height = 200;
    settings.azimuth_deg = -40;
    settings.elevation_deg = 35;
    const Camera camera(box.positions_mm, settings);
    for (const Vec2& pixel : {Vec2(0, 0), Vec2(320, 200), Vec2(17.5, 140.25)})
        CHECK((camera.project(camera.eye_mm() + 7.5 * camera.direction(pixel)) - pixel).norm() < 1e-9);
    for (const Vec3& p : box.positions_mm) {  // all in the frame, and the frame is used
        const Vec2 at = camera.project(p);
        CHECK((at.x() > 0 && at.x() < 320 && at.y() > 0 && at.y() < 200));
    }
}

TEST_CASE("render: a roof throws a shadow on what lies under it, and on the floor", "[render]") {
    TriangleMesh table = make_box(Vec3(-2, -2, 2), Vec3(2, 2, 2.2));
    append(table, make_box(Vec3(-0.2, -0.2, 0), Vec3(0.2, 0.2, 2)));
    RenderSettings settings;
    settings.width = settings.height = 150;
    settings.elevation_deg = 15;
    settings.azimuth_deg = 0;
    settings.background_top = settings.background_bottom = {200, 200, 200};
    const Camera camera(table.positions_mm, settings);
    const auto brightness = [&](const RenderSettings& s, const Vec3& at) {
        const Image image = render(table, {}, s);
        const Vec2 p = camera.project(at);
        return static_cast<int>(image.at(static_cast<int>(p.x()), static_cast<int>(p.y()))[1]);
    };
    RenderSettings unshadowed = settings, floorless = settings;
    unshadowed.shadows = false;
    floorless.floor = false;
    const Vec3 leg(0, -0.2, 1.2), floor(0.8, -0.6, 0);
    CHECK(brightness(settings, leg) < brightness(unshadowed, leg) - 20);
    CHECK(brightness(settings, floor) < 170);
    CHECK(brightness(floorless, floor) == 200);
    CHECK(brightness(unshadowed, floor) == 200);
}

TEST_CASE("corner normals: smooth over small turns, sharp over large ones", "[render]") {
    const TriangleMesh sphere = make_icosphere(3.0, 3);
    const auto smooth = corner_normals(sphere, 40);
    const auto faceted = corner_normals(sphere, 0);
    for (std::size_t t = 0; t < sphere.triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3f outward = sphere.positions_mm[sphere.triangles[t][k]].normalized().cast<float>();
            REQUIRE((smooth[t][k] - outward).norm() < 0.02f);
            REQUIRE((faceted[t][k] - faceted[t][0]).norm() < 1e-6f);
        }

    const TriangleMesh box = make_box(Vec3(0, 0, 0), Vec3(1, 2, 3), {2, 2, 2});
    const auto normals = corner_normals(box, 40);
    for (const auto& corner : normals)
        for (const Vec3f& n : corner) REQUIRE(n.cwiseAbs().maxCoeff() == Approx(1.0));
    const auto rounded = corner_normals(box, 100);
    // Weighted by angle, a corner of the box points along its diagonal, whichever way its faces are split.
    const Vec3f diagonal = Vec3f::Constant(1 / std::sqrt(3.0f));
    for (std::size_t t = 0; t < box.triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k)
            if (box.positions_mm[box.triangles[t][k]] == Vec3(1, 2, 3))
                CHECK((rounded[t][k] - diagonal).norm() < 1e-5f);
}

TEST_CASE("corner normals: equal positions count as one vertex", "[render]") {
    const TriangleMesh sphere = make_icosphere(1.0, 2);
    TriangleMesh soup;
    for (const Triangle& t : sphere.triangles) {
        const auto n = static_cast<std::uint32_t>(soup.positions_mm.size());
        for (const std::uint32_t v : t) soup.positions_mm.push_back(sphere.positions_mm[v]);
        soup.triangles.push_back({n, n + 1, n + 2});
    }
    const auto a = corner_normals(sphere, 40), b = corner_normals(soup, 40);
    for (std::size_t t = 0; t < a.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) REQUIRE((a[t][k] - b[t][k]).norm() < 1e-6f);
}

TEST_CASE("render: gives the same bytes for any number of threads", "[render][determinism]") {
    TriangleMesh mesh = testing::make_torus(5, 2, 60, 30);
    append(mesh, make_icosphere(2.5, 4, Vec3(0, 0, 4)));
    RenderSettings settings;
    settings.width = 160;
    settings.height = 120;
    settings.quick = GENERATE(false, true);
    const auto with = [&](int threads) {
        const ThreadLimit limit(threads);
        return render(mesh, {}, settings).pixels;
    };
    const std::vector<Rgba8> one = with(1);
    CHECK(with(1) == one);
    CHECK(with(2) == one);
    CHECK(with(4) == one);
}

TEST_CASE("render: a quick picture has the same edges and light as a full one", "[render]") {
    TriangleMesh mesh = testing::make_torus(5, 2, 60, 30);
    append(mesh, make_icosphere(2.5, 4, Vec3(0, 0, 4)));
    std::vector<Rgb8> colors(mesh.triangles.size(), Rgb8{230, 60, 40});
    for (std::size_t t = 0; t < colors.size(); t += 7) colors[t] = {40, 60, 230};
    RenderSettings settings;
    settings.width = settings.height = 240;
    const Image full = render(mesh, colors, settings);
    settings.quick = true;
    const Image quick = render(mesh, colors, settings);
    double sum = 0.0;
    std::size_t far = 0;
    for (std::size_t i = 0; i < full.pixels.size(); ++i) {
        int worst = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const int off = std::abs(int{full.pixels[i][k]} - int{quick.pixels[i][k]});
            worst = std::max(worst, off);
            sum += off;
        }
        far += worst > 24 ? 1 : 0;
    }
    // Grain of the light, of a few steps of 255; an edge that was overlooked would be off by a colour.
    CHECK(sum / static_cast<double>(3 * full.pixels.size()) < 1.5);
    CHECK(far < full.pixels.size() / 1000);
}

TEST_CASE("render: rejects what it cannot draw", "[render]") {
    const TriangleMesh box = make_box(Vec3(0, 0, 0), Vec3(1, 1, 1));
    CHECK_THROWS_AS(render({}, {}), InvalidInput);
    CHECK_THROWS_AS(render(box, std::vector<Rgb8>(3)), InvalidInput);
    TriangleMesh dangling = box;
    dangling.triangles[3][1] = 99;
    CHECK_THROWS_AS(render(dangling, {}), InvalidInput);
    TriangleMesh not_finite = box;
    not_finite.positions_mm[2].y() = std::numeric_limits<double>::infinity();
    CHECK_THROWS_AS(render(not_finite, {}), InvalidInput);

    const auto reject = [&](auto change) {
        RenderSettings s = on_green(32);
        change(s);
        CHECK_THROWS_AS(render(box, {}, s), InvalidSetting);
    };
    reject([](RenderSettings& s) { s.width = 15; });
    reject([](RenderSettings& s) { s.height = 8193; });
    reject([](RenderSettings& s) { s.zoom = 0; });
    reject([](RenderSettings& s) { s.elevation_deg = 91; });
    reject([](RenderSettings& s) { s.azimuth_deg = std::nan(""); });
    reject([](RenderSettings& s) { s.field_of_view_deg = 170; });
    reject([](RenderSettings& s) { s.samples_per_axis = 0; });
    reject([](RenderSettings& s) { s.look_at_mm = Vec3(0, 0, std::nan("")); });
}

TEST_CASE("render: draws flat, tiny, huge and far-off models", "[render]") {
    RenderSettings settings = on_green(48);
    CHECK(model_share(render(testing::make_square(10.0), {}, settings)) > 0.1);
    for (const double size : {1e-6, 1e6}) {
        CAPTURE(size);
        CHECK(model_share(render(make_box(Vec3(1, 1, 1) * 3 * size, Vec3(4, 5, 6) * size), {}, settings)) > 0.2);
    }
    TriangleMesh point;
    point.positions_mm.assign(3, Vec3(5, 5, 5));
    point.triangles.push_back({0, 1, 2});
    CHECK(render(point, {}, settings).pixels.size() == 48u * 48u);
}

TEST_CASE("render: stops when asked and reports progress in order", "[render]") {
    const TriangleMesh sphere = make_icosphere(1.0, 3);
    double last = -1;
    int reports = 0;
    const RunControl watch([&](std::string_view, double fraction) {
        CHECK(fraction >= last);
        last = fraction;
        ++reports;
    });
    (void)render(sphere, {}, on_green(200), watch);
    CHECK(last == 1.0);
    CHECK(reports >= 4);

    std::stop_source source;
    const RunControl stop_midway(
        [&](std::string_view, double fraction) {
            if (fraction > 0.3) source.request_stop();
        },
        source.get_token());
    CHECK_THROWS_AS(render(sphere, {}, on_green(200), stop_midway), Cancelled);
}

TEST_CASE("contact sheet: places pictures in rows, centred in their cells", "[render]") {
    const auto plain = [](int width, int height, std::uint8_t v) {
        Image image{width, height, {}, false};
        image.pixels.assign(static_cast<std::size_t>(width * height), Rgba8{v, v, v, 255});
        return image;
    };
    const std::vector<Image> pictures = {plain(4, 4, 10), plain(2, 2, 20), plain(3, 1, 30)};
    const Image sheet = contact_sheet(pictures, 2, 1, {255, 255, 255});
    CHECK(sheet.width == 4 + 1 + 2);
    CHECK(sheet.height == 4 + 1 + 1);
    CHECK(sheet.at(0, 0)[0] == 10);
    CHECK(sheet.at(4, 0)[0] == 255);
    CHECK(sheet.at(5, 0)[0] == 255);
    CHECK(sheet.at(5, 1)[0] == 20);
    CHECK(sheet.at(6, 2)[0] == 20);
    CHECK(sheet.at(0, 5)[0] == 30);
    CHECK(sheet.at(2, 5)[0] == 30);
    CHECK(sheet.at(3, 5)[0] == 255);
    CHECK_THROWS_AS(contact_sheet({}, 2), InvalidInput);
    CHECK_THROWS_AS(contact_sheet(pictures, 0), InvalidInput);
}

TEST_CASE("contact sheet: shows a model from several sides", "[render]") {
    const TriangleMesh box = make_box(Vec3(0, 0, 0), Vec3(3, 2, 1));
    const std::vector<double> azimuths = {0, 120, 240};
    RenderSettings settings = on_green(40);
    const Image sheet = render_around(box, {}, azimuths, settings);
    CHECK(sheet.width == 3 * 40 + 2 * 8);
    settings.azimuth_deg = 120;
    const Image second = render(box, {}, settings);
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 40; ++x) REQUIRE(sheet.at(48 + x, y) == second.at(x, y));
}

}  // namespace
}  // namespace fretwork
