// Our layers against those that slic3r cuts of the same mesh.
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <regex>
#include <sstream>

#include "core/printability/layers.h"
#include "formats/mesh_file.h"
#include "formats/read_file.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

using namespace testing;

/// One layer of slic3r's drawing: contours, and the area they leave after their holes.
struct DrawnLayer {
    double middle_mm = 0.0;
    double area_mm2 = 0.0;
    std::size_t contours = 0, holes = 0;
};

double area_of(const std::string& points) {
    std::istringstream in(points);
    std::vector<Vec2> corners;
    char comma = 0;
    for (double x = 0, y = 0; in >> x >> comma >> y;) corners.emplace_back(x, y);
    double sum = 0.0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec2 &p = corners[i], &q = corners[(i + 1) % corners.size()];
        sum += 0.5 * (p[0] * q[1] - p[1] * q[0]);
    }
    return std::abs(sum);
}

std::vector<DrawnLayer> drawn_layers(const std::string& svg) {
    constexpr double kUnit = 1e6;  // slic3r scales heights
    std::vector<DrawnLayer> layers;
    const std::regex line("slic3r:z=\"([^\"]*)\"|slic3r:type=\"([a-z]*)\" points=\"([^\"]*)\"");
    for (std::sregex_iterator it(svg.begin(), svg.end(), line), end; it != end; ++it) {
        const std::smatch& found = *it;
        if (found[1].matched) {
            layers.push_back({kUnit * std::stod(found[1]), 0.0, 0, 0});
            continue;
        }
        const bool hole = found[2] == "hole";
        layers.back().area_mm2 += (hole ? -1.0 : 1.0) * area_of(found[3]);
        ++(hole ? layers.back().holes : layers.back().contours);
    }
    return layers;
}

TEST_CASE("layers: those that slic3r cuts", "[printability][programs]") {
    if (std::system("command -v slic3r > /dev/null 2>&1") != 0) {
        WARN("slic3r is not installed: skipped");
        return;
    }
    const auto* const name = GENERATE("tori", "vase", "bracket", "nested");
    CAPTURE(name);
    const std::map<std::string, TriangleMesh> meshes = {{"tori", make_linked_tori(14.0, 4.0)},
                                                        {"vase", make_vase(40.0)},
                                                        {"bracket", make_bracket()},
                                                        {"nested", make_nested_spheres(10.0, 6.0)}};
    const TriangleMesh& mesh = meshes.at(name);
    const auto folder = std::filesystem::temp_directory_path() / ("fretwork-slic3r-" + std::to_string(::getpid()));
    std::filesystem::create_directory(folder);
    const std::string model = (folder / "model.stl").string(), drawing = (folder / "model.svg").string();
    write_mesh(std::filesystem::path(model), {mesh});
    REQUIRE(std::system(("timeout 60 slic3r --export-svg --layer-height 0.25 --first-layer-height 0.25 -o '" + drawing +
                         "' '" + model + "' > /dev/null 2>&1")
                            .c_str()) == 0);
    const std::vector<DrawnLayer> drawn = drawn_layers(read_file(std::filesystem::path(drawing)));
    std::filesystem::remove_all(folder);

    const std::vector<Layer> layers = cut_layers(mesh, 0.25, {});
    REQUIRE(layers.size() > 30);
    // It may end with a layer more, of what rounding leaves.
    REQUIRE(drawn.size() >= layers.size());
    REQUIRE(drawn.size() <= layers.size() + 1);
    const double bottom = layers.front().middle_mm - drawn.front().middle_mm;
    for (std::size_t i = 0; i < layers.size(); ++i) {
        CAPTURE(i);
        CHECK(layers[i].middle_mm - bottom == Approx(drawn[i].middle_mm).margin(1e-6));
        // slic3r leaves points out that stray by less than 0.0125 mm.
        double border = 0.0;
        std::size_t contours = 0;
        for (const Part& part : parts_of(layers[i].outline)) {
            ++contours;
            for (const Polygon& loop : part.borders)
                for (std::size_t k = 0; k < loop.size(); ++k)
                    border += (mm_of(loop[(k + 1) % loop.size()]) - mm_of(loop[k])).norm();
        }
        CHECK(area_mm2(layers[i].outline) == Approx(drawn[i].area_mm2).margin(0.0125 * border));
        CHECK(contours == drawn[i].contours);
    }
}

}  // namespace
}  // namespace fretwork
